// SPDX-License-Identifier: BSD-3-Clause
#include "support.h"

#include "noise.h"

#include <algorithm>
#include <cmath>

namespace erkpa
{

namespace
{

// Neighbours of a part's support where there is no noise: one-sided supports reach farther, and a curved face is
// followed better by fewer nodes.
constexpr int CLEAN_PART = 14;
constexpr double ROUNDING = 1e-5; // searches measure in float: this share of a length is left for it

} // namespace

Support::Support (const ImplicitField &field, const NeighborSearch &search)
    : field_ (field), search_ (search), size_ (field.supportSize ()),
      has_shapes_ (!field.points ().shapes.empty () || field.options ().flatten < 1.0)
{
}

void
Support::gather (const Eigen::Vector3d &center, double extent, bool for_parts)
{
  center_ = center;
  switch (size_.kind ())
  {
    case SupportSize::Kind::NEAREST:
      searchNearest (center, extent);
      if (for_parts && center_radius_ > 0.0)
        search (center, PART_REACH * (center_radius_ + extent) + extent);
      break;
    case SupportSize::Kind::CONSTANT:
      center_radius_ = size_.radiusAt (center);
      search (center, center_radius_ + extent);
      break;
    case SupportSize::Kind::FUNCTION:
      // Steeper functions than one in one outgrow this, see covers ().
      center_radius_ = std::max (size_.radiusAt (center), 0.0);
      search (center, center_radius_ + 2.0 * extent);
      break;
    case SupportSize::Kind::PER_NODE:
      size_.nodesReaching (center, extent + field_.largestOffset (), candidates_);
      break;
  }
  if (size_.kind () == SupportSize::Kind::PER_NODE || !search_.hasOrder ())
    std::sort (candidates_.begin (), candidates_.end ());
  makeValuePoints ();
}

bool
Support::covers (const Eigen::Vector3d &x) const
{
  return size_.kind () != SupportSize::Kind::FUNCTION || !((x - center_).norm () + size_.radiusAt (x) > reach_);
}

/** \brief All nodes whose value points may lie within \a reach. */
void
Support::search (const Eigen::Vector3d &center, double reach)
{
  reach_ = reach;
  const double all = reach + field_.largestOffset ();
  const double rounding = ROUNDING * (all + center.norm ());
  search_.withinRadius (center.cast<float> (), all + rounding, candidates_, found_);
}

/** \brief Search as far as points of the ball reach to their k-th nodes.
 *
 * ε is 1-Lipschitz: a point at a distance d <= extent reaches at most ε(center) + d around itself. The radius at the
 * last ball is the first guess, since balls follow each other in space; one search is much cheaper than two.
 */
void
Support::searchNearest (const Eigen::Vector3d &center, double extent)
{
  const std::size_t k = std::min (static_cast<std::size_t> (size_.k ()), field_.points ().size ());
  const double typical = size_.typical ();
  double guess = 1.2 * (center_radius_ > 0.0 ? std::min (center_radius_, 2.0 * typical) : typical);
  candidates_.clear ();
  constexpr double FARTHEST = 1e18; // its square is still a float
  for (; center.norm () < FARTHEST && guess > 0.0 && guess < FARTHEST; guess *= 2.0)
  {
    search (center, guess + 2.0 * extent);
    if (found_.size () < k)
      continue;
    const auto kth = found_.begin () + static_cast<std::ptrdiff_t> (k - 1);
    std::nth_element (found_.begin (), kth, found_.end ());
    center_radius_ = std::sqrt (*kth);
    if (center_radius_ <= guess)
      return;
  }
  candidates_.clear ();
  center_radius_ = 0.0;
}

void
Support::makeValuePoints ()
{
  const OrientedPoints &points = field_.points ();
  const bool off_surface = field_.valuesPerNode () > 1;
  const std::size_t n = candidates_.size () * static_cast<std::size_t> (field_.valuesPerNode ());
  points_.clear ();
  px_.resize (n);
  py_.resize (n);
  pz_.resize (n);
  squared_.resize (n);
  const auto add = [&] (int node, int side, const Eigen::Vector3d &position)
  {
    const std::size_t slot = points_.size ();
    points_.push_back ({node, side, field_.nodeValue (node, side)});
    px_[slot] = position[0];
    py_[slot] = position[1];
    pz_[slot] = position[2];
  };
  for (const int node : candidates_)
  {
    const Eigen::Vector3d position = points.positions[static_cast<std::size_t> (node)].cast<double> ();
    add (node, 0, position);
    if (!off_surface)
      continue;
    const Eigen::Vector3d normal = points.normals[static_cast<std::size_t> (node)].cast<double> ();
    for (const int side : {1, -1})
      add (node, side, position + side * field_.offsetOf (node) * normal);
  }
}

void
Support::measureDistances (const Eigen::Vector3d &x)
{
  const std::size_t n = points_.size ();
  for (std::size_t i = 0; i < n; ++i)
  {
    const double dx = px_[i] - x[0], dy = py_[i] - x[1], dz = pz_[i] - x[2];
    squared_[i] = dx * dx + dy * dy + dz * dz;
  }
}

void
Support::measureRadius (const Eigen::Vector3d &x)
{
  radius_ = 0.0;
  radius_gradient_.setZero ();
  if (size_.kind () == SupportSize::Kind::NEAREST)
    measureNearestRadius (x);
  else
  {
    radius_ = size_.radiusAt (x);
    radius_gradient_ = size_.radiusGradientAt (x);
  }
  growth_ = 2.0 * radius_gradient_;
}

void
Support::measureNearestRadius (const Eigen::Vector3d &x)
{
  // ε is 1-Lipschitz: only candidates within the centre's radius and the way to x can be among the k nearest.
  const double bound = (center_radius_ + (x - center_).norm ()) + ROUNDING * (center_radius_ + x.norm ());
  listDistances ([&] (std::size_t i) { return squared_[i] <= bound * bound; });
  const std::size_t k = std::min (static_cast<std::size_t> (size_.k ()), scratch_.size ());
  if (k == 0)
    return;
  std::nth_element (scratch_.begin (), scratch_.begin () + static_cast<std::ptrdiff_t> (k - 1), scratch_.end ());
  const double kth = scratch_[k - 1];
  radius_ = std::sqrt (kth);
  const auto i = static_cast<std::size_t> (std::find (squared_.begin (), squared_.end (), kth) - squared_.begin ());
  if (radius_ > 0.0)
    radius_gradient_ = (x - position (i)) / radius_;
}

/** \brief The k-th nearest node of the part, up to a limit; radius_ is that of all nodes before. */
void
Support::measurePartRadius (const Eigen::Vector3d &x)
{
  const double limit = PART_REACH * whole_radius_;
  listDistances ([&] (std::size_t i) { return both (squared_[i] < limit * limit, isMember (i)); });
  const auto k = static_cast<std::size_t> (neighborsOfPart (size_.k ()));
  radius_ = limit;
  radius_gradient_ = PART_REACH * whole_radius_gradient_;
  if (scratch_.size () >= k)
  {
    std::nth_element (scratch_.begin (), scratch_.begin () + static_cast<std::ptrdiff_t> (k - 1), scratch_.end ());
    const double kth = scratch_[k - 1];
    radius_ = std::sqrt (kth);
    const auto i = static_cast<std::size_t> (std::find (squared_.begin (), squared_.end (), kth) - squared_.begin ());
    radius_gradient_ = radius_ > 0.0 ? Eigen::Vector3d ((x - position (i)) / radius_) : Eigen::Vector3d::Zero ();
  }
  growth_ = 2.0 * radius_gradient_;
}

int
Support::neighborsOfPart (int k)
{
  return k <= CLEAN_SUPPORT ? std::min (k, CLEAN_PART) : k;
}

void
Support::listWithin (double reach, std::vector<int> &slots) const
{
  listSlots ([&] (std::size_t i) { return squared_[i] <= reach * reach; }, slots);
}

double
Support::quartileDistance () const
{
  scratch_.clear ();
  for (const SupportNode &node : nodes_)
    if (isOnSurface (static_cast<std::size_t> (node.slot)))
      scratch_.push_back (node.u.squaredNorm ());
  if (scratch_.empty ())
    return HUGE_VAL;
  const auto quartile = scratch_.begin () + static_cast<std::ptrdiff_t> (scratch_.size () / 4);
  std::nth_element (scratch_.begin (), quartile, scratch_.end ());
  return std::sqrt (*quartile) * radius_;
}

double
Support::nearestDistance () const
{
  double nearest = HUGE_VAL;
  for (std::size_t i = 0; i < squared_.size (); ++i)
    if (squared_[i] < nearest && isOnSurface (i))
      nearest = squared_[i];
  return std::sqrt (nearest);
}

bool
Support::select (const Eigen::Vector3d &x)
{
  measureDistances (x);
  parts_ = nullptr;
  if (size_.kind () != SupportSize::Kind::PER_NODE)
    measureRadius (x);
  whole_radius_ = radius_;
  whole_radius_gradient_ = radius_gradient_;
  return weighNodes (x);
}

bool
Support::selectPart (const Eigen::Vector3d &x, const std::vector<int> &parts, int part)
{
  parts_ = &parts;
  part_ = part;
  if (size_.kind () == SupportSize::Kind::NEAREST)
    measurePartRadius (x);
  return weighNodes (x);
}

} // namespace erkpa
