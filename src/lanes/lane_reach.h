// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_vector.h"
#include "lanes.h"

namespace erkpa::lanes
{

/** \brief Counts the nodes of the supports: whether the data defines a value, and supports a surface. */
template <typename B>
class LaneReach
{
public:
  using Mask = decltype (B () < B ());

  /** \brief Left to be assigned to. */
  LaneReach () = default;

  /** \param[in] radius ε */
  LaneReach (const Settings &settings, B radius, B squared_radius)
      : min_nodes_ (static_cast<float> (settings.min_nodes)),
        near_enough_ (settings.near_enough * settings.near_enough), squared_radius_ (squared_radius)
  {
    const B reach = xsimd::fma (radius, B (settings.reach), B (settings.offset));
    // At most ε, though a node at ε itself is beyond the support.
    squared_reach_ = xsimd::min (reach * reach, squared_radius * B (1.0f - 1e-7f));
  }

  /** \param[in] squared distance of a node */
  void
  count (B squared)
  {
    countOffSurface (squared);
    in_quarter_.add (squared <= squared_reach_);
    nearest_ = xsimd::min (nearest_, squared);
  }

  /** \brief The same where the support is flattened. \param[in] stretched the square by which the node is weighed */
  void
  count (B squared, B stretched)
  {
    countOffSurface (stretched);
    in_quarter_.add (squared <= squared_reach_ && stretched < squared_radius_);
    nearest_ = xsimd::min (nearest_, squared);
  }

  void
  countOffSurface (B stretched)
  {
    in_support_.add (stretched < squared_radius_);
  }

  /** \brief The nodes counted so far were all of those on the surface. */
  void
  endOnSurface ()
  {
    on_surface_ = in_support_;
  }

  /** \brief Number of nodes in the support. */
  B
  supportNodes () const
  {
    return in_support_.count ();
  }

  /** \brief Of those the ones on the surface. */
  B
  nodesOnSurface () const
  {
    return on_surface_.count ();
  }

  /** \brief Of these the ones that count for Settings::reach. */
  B
  nodesInReach () const
  {
    return in_quarter_.count ();
  }

  Mask
  isDefined () const
  {
    return in_support_.count () >= B (min_nodes_);
  }

  /** \brief Whether the data supports a surface here: see Settings::reach. */
  Mask
  isInReach () const
  {
    const B quarter = xsimd::floor (on_surface_.count () * B (0.25f));
    return in_quarter_.count () > quarter || nearest_ <= B (near_enough_);
  }

  B
  squaredNearest () const
  {
    return nearest_;
  }

private:
  float min_nodes_, near_enough_;
  B squared_radius_, squared_reach_;
  LaneCount<B> in_support_, on_surface_, in_quarter_;
  B nearest_ = B (3e38f);
};

/** \brief |centroid of the weighted nodes - x| across the gradient, in ε. */
template <typename B>
B
offsetAcross (const B *centroid, const B *gradient)
{
  const B squared = dot (gradient, gradient), along = dot (centroid, gradient) / squared;
  B across[3];
  for (int a = 0; a < 3; ++a)
    across[a] = fnma (along, gradient[a], centroid[a]);
  return xsimd::select (squared > B (0.0f), xsimd::sqrt (dot (across, across)), B (3e38f));
}

} // namespace erkpa::lanes
