// SPDX-License-Identifier: BSD-3-Clause
#include "support.h"

#include <erkpa/kernel.h>

#include <algorithm>
#include <cmath>

namespace erkpa
{

Support::Support (const ImplicitField &field) : field_ (field) {}

void
Support::gather (const Eigen::Vector3d &center, double extent)
{
  const FieldOptions &options = field_.options ();
  const Eigen::Vector3f x = center.cast<float> ();
  double reach = options.radius + extent;
  if (options.radius == 0.0)
  {
    // ε is 1-Lipschitz: a point |y - x| <= extent away reaches at most ε(x) + extent around itself.
    field_.search ().nearestK (x, options.k, candidates_, found_);
    const double kth = found_.empty () ? 0.0 : *std::max_element (found_.begin (), found_.end ());
    reach = std::sqrt (kth) + 2.0 * extent;
  }
  const double rounding = 1e-5 * (reach + center.norm ());
  field_.search ().withinRadius (x, reach + rounding, candidates_, found_);
  std::sort (candidates_.begin (), candidates_.end ());

  const std::size_t n = candidates_.size ();
  px_.resize (n);
  py_.resize (n);
  pz_.resize (n);
  squared_.resize (n);
  for (std::size_t i = 0; i < n; ++i)
  {
    const Eigen::Vector3f &p = field_.points ().positions[static_cast<std::size_t> (candidates_[i])];
    px_[i] = p.x ();
    py_[i] = p.y ();
    pz_[i] = p.z ();
  }
}

void
Support::measureDistances (const Eigen::Vector3d &x)
{
  const std::size_t n = candidates_.size ();
  double nearest = HUGE_VAL;
  for (std::size_t i = 0; i < n; ++i)
  {
    const double dx = px_[i] - x[0], dy = py_[i] - x[1], dz = pz_[i] - x[2];
    squared_[i] = dx * dx + dy * dy + dz * dz;
  }
  for (std::size_t i = 0; i < n; ++i)
    nearest = std::min (nearest, squared_[i]);
  nearest_ = std::sqrt (nearest);
}

void
Support::measureRadius (const Eigen::Vector3d &x)
{
  radius_ = field_.options ().radius;
  radius_gradient_.setZero ();
  if (radius_ > 0.0 || squared_.empty ())
    return;
  scratch_ = squared_;
  const std::size_t k = std::min (static_cast<std::size_t> (field_.options ().k), scratch_.size ());
  std::nth_element (scratch_.begin (), scratch_.begin () + static_cast<std::ptrdiff_t> (k - 1), scratch_.end ());
  const double kth = scratch_[k - 1];
  radius_ = std::sqrt (kth);
  const auto i = static_cast<std::size_t> (std::find (squared_.begin (), squared_.end (), kth) - squared_.begin ());
  if (radius_ > 0.0)
    radius_gradient_ = (x - Eigen::Vector3d (px_[i], py_[i], pz_[i])) / radius_;
}

bool
Support::select (const Eigen::Vector3d &x)
{
  measureDistances (x);
  measureRadius (x);
  nodes_.clear ();
  const double limit = radius_ * radius_;
  if (!(limit > 0.0))
    return false;
  const double scale = 1.0 / radius_;
  for (std::size_t i = 0; i < squared_.size (); ++i)
  {
    if (squared_[i] >= limit)
      continue;
    const double t = std::sqrt (squared_[i]) * scale;
    const double weight = PaperKernel::weight (t);
    if (weight > 0.0)
      nodes_.push_back ({ static_cast<int> (i),
                          Eigen::Vector3d (px_[i] - x[0], py_[i] - x[1], pz_[i] - x[2]) * scale, t, weight });
  }
  return nodes_.size () >= std::min (MIN_NODES, field_.points ().size ());
}

} // namespace erkpa
