// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lanes.h"

#include <xsimd/xsimd.hpp>

namespace erkpa::lanes
{

template <typename B>
B
dot (const B *a, const B *b)
{
  return xsimd::fma (a[2], b[2], xsimd::fma (a[1], b[1], a[0] * b[0]));
}

/** \brief Counts the nodes of the supports: whether the data defines a value, and supports a surface. */
template <typename B>
class LaneReach
{
public:
  using Mask = decltype (B () < B ());

  /** \param[in] radius ε */
  LaneReach (const Settings &settings, B radius, B squared_radius)
      : min_nodes_ (static_cast<float> (settings.min_nodes)),
        near_enough_ (settings.near_enough * settings.near_enough), squared_radius_ (squared_radius)
  {
    const B reach = xsimd::fma (radius, B (settings.reach), B (settings.offset));
    squared_reach_ = reach * reach;
  }

  /** \param[in] squared distance of the node */
  void
  count (std::size_t node, bool is_on_surface, B squared)
  {
    const B one (1.0f), zero (0.0f);
    const auto inside = squared < squared_radius_;
    in_support_ += xsimd::select (inside, one, zero);
    if (!is_on_surface)
      return;
    on_surface_ += xsimd::select (inside, one, zero);
    in_quarter_ += xsimd::select (inside && squared <= squared_reach_, one, zero);
    const auto is_nearer = squared < nearest_;
    nearest_node_ = xsimd::select (is_nearer, B (static_cast<float> (node)), nearest_node_);
    nearest_ = xsimd::select (is_nearer, squared, nearest_);
  }

  /** \brief Number of nodes in the support. */
  B
  supportNodes () const
  {
    return in_support_;
  }

  Mask
  isDefined () const
  {
    return in_support_ >= B (min_nodes_);
  }

  /** \brief Whether the data supports a surface here: see Settings::reach. */
  Mask
  isInReach () const
  {
    const B quarter = xsimd::floor (on_surface_ * B (0.25f));
    return in_quarter_ > quarter || nearest_ <= B (near_enough_);
  }

  B
  nearestNode () const
  {
    return nearest_node_;
  }

  B
  nearestDistance () const
  {
    return xsimd::sqrt (nearest_);
  }

private:
  float min_nodes_, near_enough_;
  B squared_radius_, squared_reach_;
  B in_support_ = B (0.0f), on_surface_ = B (0.0f), in_quarter_ = B (0.0f);
  B nearest_ = B (3e38f), nearest_node_ = B (0.0f);
};

/** \brief |centroid of the weighted nodes - x| across the gradient, in ε. */
template <typename B>
B
offsetAcross (const B *centroid, const B *gradient)
{
  const B squared = dot (gradient, gradient), along = dot (centroid, gradient) / squared;
  B across[3];
  for (int a = 0; a < 3; ++a)
    across[a] = xsimd::fnma (along, gradient[a], centroid[a]);
  return xsimd::select (squared > B (0.0f), xsimd::sqrt (dot (across, across)), B (3e38f));
}

} // namespace erkpa::lanes
