// SPDX-License-Identifier: BSD-3-Clause
#include "support.h"

#include <erkpa/kernel.h>

#include <algorithm>
#include <cmath>

namespace erkpa
{

namespace
{

constexpr double ROUNDING = 1e-5; // searches measure in float: this share of a length is left for it

} // namespace

Support::Support (const ImplicitField &field) : field_ (field) {}

void
Support::gather (const Eigen::Vector3d &center, double extent)
{
  center_ = center;
  if (field_.options ().radius > 0.0)
  {
    center_radius_ = field_.options ().radius;
    search (center, center_radius_ + extent);
  }
  else
    searchNearest (center, extent);
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
Support::search (const Eigen::Vector3d &center, double reach)
{
  const double rounding = ROUNDING * (reach + center.norm ());
  field_.search ().withinRadius (center.cast<float> (), reach + rounding, candidates_, found_);
}

/** \brief Search as far as points of the ball reach to their k-th nodes.
 *
 * ε is 1-Lipschitz: a point at a distance d <= extent reaches at most ε(center) + d around itself. The radius at the
 * last ball is the first guess, since balls follow each other in space; one search is much cheaper than two.
 */
void
Support::searchNearest (const Eigen::Vector3d &center, double extent)
{
  const std::size_t k = std::min (static_cast<std::size_t> (field_.options ().k), field_.points ().size ());
  double guess =
      1.2 * (center_radius_ > 0.0 ? std::min (center_radius_, 2.0 * field_.typicalRadius ()) : field_.typicalRadius ());
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
Support::measureDistances (const Eigen::Vector3d &x)
{
  const std::size_t n = candidates_.size ();
  for (std::size_t i = 0; i < n; ++i)
  {
    const double dx = px_[i] - x[0], dy = py_[i] - x[1], dz = pz_[i] - x[2];
    squared_[i] = dx * dx + dy * dy + dz * dz;
  }
}

void
Support::measureRadius (const Eigen::Vector3d &x)
{
  radius_ = field_.options ().radius;
  radius_gradient_.setZero ();
  if (radius_ > 0.0 || squared_.empty ())
    return;
  // ε is 1-Lipschitz: only candidates within the centre's radius and the way to x can be among the k nearest.
  const double bound = (center_radius_ + (x - center_).norm ()) + ROUNDING * (center_radius_ + x.norm ());
  scratch_.clear ();
  for (const double squared : squared_)
    if (squared <= bound * bound)
      scratch_.push_back (squared);
  const std::size_t k = std::min (static_cast<std::size_t> (field_.options ().k), scratch_.size ());
  if (k == 0)
    return;
  std::nth_element (scratch_.begin (), scratch_.begin () + static_cast<std::ptrdiff_t> (k - 1), scratch_.end ());
  const double kth = scratch_[k - 1];
  radius_ = std::sqrt (kth);
  const auto i = static_cast<std::size_t> (std::find (squared_.begin (), squared_.end (), kth) - squared_.begin ());
  if (radius_ > 0.0)
    radius_gradient_ = (x - Eigen::Vector3d (px_[i], py_[i], pz_[i])) / radius_;
}

double
Support::quartileDistance () const
{
  if (nodes_.empty ())
    return HUGE_VAL;
  scratch_.clear ();
  for (const SupportNode &node : nodes_)
    scratch_.push_back (node.t);
  const auto quartile = scratch_.begin () + static_cast<std::ptrdiff_t> (scratch_.size () / 4);
  std::nth_element (scratch_.begin (), quartile, scratch_.end ());
  return *quartile * radius_;
}

double
Support::nearestDistance () const
{
  return squared_.empty () ? HUGE_VAL : std::sqrt (*std::min_element (squared_.begin (), squared_.end ()));
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
      nodes_.push_back (
          {static_cast<int> (i), Eigen::Vector3d (px_[i] - x[0], py_[i] - x[1], pz_[i] - x[2]) * scale, t, weight});
  }
  return nodes_.size () >= std::min (MIN_NODES, field_.points ().size ());
}

} // namespace erkpa
