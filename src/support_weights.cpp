// SPDX-License-Identifier: BSD-3-Clause
//
// What the nodes in a support weigh.
#include "support.h"

#include <cmath>

namespace erkpa
{

Eigen::Vector3d
Support::stretched (int node, const Eigen::Vector3d &d) const
{
  const auto i = static_cast<std::size_t> (node);
  if (!field_.points ().shapes.empty ())
  {
    const Eigen::Matrix3d shape = field_.points ().shapes[i].cast<double> ();
    return shape.transpose () * (shape * d);
  }
  const double flatten = field_.options ().flatten;
  const Eigen::Vector3d normal = field_.points ().normals[i].cast<double> ();
  return d + (1.0 / (flatten * flatten) - 1.0) * normal.dot (d) * normal;
}

double
Support::weightOf (std::size_t slot, double t) const
{
  const double weight = field_.kernel ().weight (t);
  const auto &confidences = field_.points ().confidences;
  return confidences.empty ()
             ? weight
             : weight * static_cast<double> (confidences[static_cast<std::size_t> (points_[slot].node)]);
}

Eigen::Vector3d
Support::weightGradient (const SupportNode &node) const
{
  const int i = pointOf (node).node;
  double slope = field_.kernel ().derivativeOverT (node.t);
  if (!field_.points ().confidences.empty ())
    slope *= static_cast<double> (field_.points ().confidences[static_cast<std::size_t> (i)]);
  const Eigen::Vector3d d = has_shapes_ ? stretched (i, node.u) : node.u;
  return slope * (-node.ratio * d - 0.5 * node.t * node.t * growth_);
}

bool
Support::weighNodes (const Eigen::Vector3d &x)
{
  nodes_.clear ();
  if (size_.kind () == SupportSize::Kind::PER_NODE)
  {
    weighByOwnRadii (x);
    return nodes_.size () >= MIN_NODES;
  }
  const double limit = radius_ * radius_;
  if (!(radius_ > 0.0) || !std::isfinite (limit))
    return false;
  const double scale = 1.0 / radius_;
  listSlots ([&] (std::size_t i) { return both (squared_[i] < limit, isMember (i)); }, slots_);
  for (const int slot : slots_)
  {
    const auto i = static_cast<std::size_t> (slot);
    const Eigen::Vector3d u = Eigen::Vector3d (px_[i] - x[0], py_[i] - x[1], pz_[i] - x[2]) * scale;
    const double t = std::sqrt (has_shapes_ ? u.dot (stretched (points_[i].node, u)) : squared_[i] * scale * scale);
    const double weight = t < 1.0 ? weightOf (i, t) : 0.0;
    if (weight > 0.0)
      nodes_.push_back ({slot, u, t, weight, 1.0});
  }
  return nodes_.size () >= std::min (MIN_NODES, field_.points ().size ());
}

/** \brief Nodes with radii ε_i; ε is their weighted mean. */
void
Support::weighByOwnRadii (const Eigen::Vector3d &x)
{
  growth_.setZero ();
  double total = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < squared_.size (); ++i)
  {
    const auto own = static_cast<double> (field_.points ().radii[static_cast<std::size_t> (points_[i].node)]);
    if (squared_[i] >= own * own || !isMember (i))
      continue;
    const Eigen::Vector3d d = position (i) - x;
    const double t = std::sqrt (has_shapes_ ? d.dot (stretched (points_[i].node, d)) : squared_[i]) / own;
    const double weight = t < 1.0 ? weightOf (i, t) : 0.0;
    if (!(weight > 0.0))
      continue;
    nodes_.push_back ({static_cast<int> (i), d, t, weight, 1.0 / (own * own)});
    total += weight;
    sum += weight * own;
  }
  radius_ = total > 0.0 ? sum / total : 0.0;
  radius_gradient_.setZero ();
  for (SupportNode &node : nodes_)
  {
    const double own = std::sqrt (1.0 / node.ratio);
    node.u /= radius_;
    node.ratio *= radius_ * radius_;
    radius_gradient_ += weightGradient (node) * (own - radius_) / (total * radius_);
  }
}

} // namespace erkpa
