// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_support.h"

#include <xsimd/xsimd.hpp>

namespace erkpa::lanes
{

/** \brief What sharp surfaces add. */
enum class LaneEnrichment
{
  KINKS_AND_SQUARES, ///< θH(θ) and θ²
  KINKS,
  JUMPS ///< H(θ)
};

/** \brief Of the sharp surfaces near a ball those that may pass between the nodes of a lane's support. */
template <typename B>
struct LaneSurfaces
{
  /** \brief Of jumps; half as many of kinks. */
  static constexpr int MAX_CORNERS = 2 * static_cast<int> (MAX_PENCILS);

  /** \brief A term of three surfaces that meet: min (scale_a a, scale_b b), where that is positive; jumps have two. */
  struct Corner
  {
    int a, b, c;
    float scale_a, scale_b;
  };

  int count = 0, corner_count = 0;
  bool is_limited = false; ///< whether any of them is
  bool has_all = true;     ///< whether there are no more of them than are kept
  const Surface *surfaces[MAX_SURFACES];
  int numbers[MAX_SURFACES]; ///< places among those that were given
  Corner corners[MAX_CORNERS];

  /** \param[in] first place of the evaluation point in the first lane
   * \param[in] support of the points
   */
  LaneSurfaces (const SharpSurfaces &sharp, std::size_t first, const LaneSupport<B> &support)
  {
    int place[SharpSurfaces::MOST]; // of a surface among those kept
    for (std::size_t s = 0; s < sharp.count; ++s)
    {
      place[s] = -1;
      if (!passesSupport (sharp.surfaces[s], first, support))
        continue;
      has_all = count < static_cast<int> (MAX_SURFACES);
      if (!has_all)
        return;
      place[s] = count;
      surfaces[count] = &sharp.surfaces[s];
      numbers[count++] = static_cast<int> (s);
      is_limited = is_limited || sharp.surfaces[s].distance_at != nullptr;
    }
    for (std::size_t p = 0; p < sharp.pencil_count; ++p)
    {
      const Pencil &pencil = sharp.pencils[p];
      const int a = place[pencil.surfaces[0]], b = place[pencil.surfaces[1]], c = place[pencil.surfaces[2]];
      if (a >= 0 && b >= 0 && c >= 0)
      {
        has_all = corner_count < static_cast<int> (sharp.jumps ? 2 * MAX_PENCILS : MAX_PENCILS);
        if (!has_all)
          return;
        corners[corner_count++] = {a, b, c, pencil.scale_a, pencil.scale_b};
        if (sharp.jumps)
          corners[corner_count++] = {b, c, a, 1.0f, 1.0f};
      }
    }
  }

  /** \brief A corner's term at a node, and its slope; which of its surfaces is lower is for the third to say: see
   * Enrichment::isSecondLower ().
   * \param[in] sign -1: seen from behind
   */
  void
  evaluateCorner (int k, std::size_t node, float sign, float &height, float *slope) const
  {
    const Corner &corner = corners[k];
    const Surface &a = *surfaces[corner.a], &b = *surfaces[corner.b], &c = *surfaces[corner.c];
    float turn = 0.0f;
    for (int i = 0; i < 3; ++i)
      turn += (corner.scale_a * a.gradient[i][node] - corner.scale_b * b.gradient[i][node]) * c.gradient[i][node];
    const bool is_above = c.theta[node] >= 0.0f, is_b = sign * turn > 0.0f ? is_above : !is_above;
    const Surface &lower = is_b ? b : a;
    const float scale = sign * (is_b ? corner.scale_b : corner.scale_a);
    height = scale * lower.theta[node];
    const bool is_on = height > 0.0f || (height >= 0.0f && scale > 0.0f);
    height = is_on ? height : 0.0f;
    for (int i = 0; i < 3; ++i)
      slope[i] = is_on ? scale * lower.gradient[i][node] : 0.0f;
  }

  /** \brief Where a corner's term is a jump, it at a node. */
  float
  jumpOfCorner (int k, std::size_t node, float sign) const
  {
    const Corner &corner = corners[k];
    const float a = sign * corner.scale_a * surfaces[corner.a]->theta[node],
                b = sign * corner.scale_b * surfaces[corner.b]->theta[node], height = a < b ? a : b;
    return height > 0.0f || (height >= 0.0f && sign > 0.0f) ? 1.0f : 0.0f;
  }

private:
  /** \brief θ of a plane is a distance. One that is limited is gone at a distance. */
  static bool
  passesSupport (const Surface &surface, std::size_t first, const LaneSupport<B> &support)
  {
    const B radius = support.radius ();
    if (surface.distance_at != nullptr)
    {
      const B gone = surface.fade > 0.0f ? B (surface.fade) : radius;
      if (!xsimd::any (B::load_unaligned (surface.distance_at + first) < gone))
        return false;
    }
    if (!surface.is_plane)
      return hasBothSides (surface, support);
    const B theta = B::load_unaligned (surface.theta_at + first);
    return xsimd::any (xsimd::abs (theta) <= B (1.00001f) * radius);
  }

  /** \brief Whether nodes to visit lie on either side. */
  static bool
  hasBothSides (const Surface &surface, const LaneSupport<B> &support)
  {
    bool is_below = false, is_above = false;
    for (std::size_t i = 0; i < support.size () && !(is_below && is_above); ++i)
    {
      const float theta = surface.theta[support.node (i)];
      is_below = is_below || theta < 0.0f;
      is_above = is_above || theta > 0.0f;
    }
    return is_below && is_above;
  }
};

} // namespace erkpa::lanes
