// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_extent.h"
#include "lane_surfaces.h"

namespace erkpa::lanes
{

/** \brief A number of sharp surfaces that is not known beforehand. */
constexpr int ANY_COUNT = -1;

/** \brief The terms that sharp surfaces add, in lanes: for each a kink θH(θ), then for each three that meet in a corner
 * min (a⁺, b⁺), and after all of these, where gradients are fitted, each surface's θ².
 *
 * See Enrichment: a kink is seen from the side on which it is zero at x, where it may be. A term's value at a node and
 * its slope are in coordinates u = (y - x) / ε, as θ / ε.
 * \tparam COUNT so many surfaces, without corners: loops over them can be unrolled; or ANY_COUNT
 * \tparam FORM what the terms are; jumps are H(θ), and H(a)H(b) and H(b)H(c) at a corner, in the place of kinks
 */
template <typename B, int COUNT, LaneEnrichment FORM>
class LaneTermValues
{
public:
  using Mask = decltype (B () < B ());
  static constexpr bool HAS_SQUARES = FORM == LaneEnrichment::KINKS_AND_SQUARES,
                        ARE_JUMPS = FORM == LaneEnrichment::JUMPS;
  static constexpr int MAX_COUNT = COUNT == ANY_COUNT ? static_cast<int> (MAX_SURFACES) : COUNT;
  static constexpr int MAX_CORNERS = COUNT == ANY_COUNT ? LaneSurfaces<B>::MAX_CORNERS / (ARE_JUMPS ? 1 : 2) : 0;
  static constexpr int MAX_TERMS = (HAS_SQUARES ? 2 : 1) * MAX_COUNT + MAX_CORNERS;

  /** \param[in] first place of the evaluation point in the first lane
   * \param[in] scale 1 / ε
   */
  LaneTermValues (const LaneSurfaces<B> &near, std::size_t first, B scale)
      : near_ (near), first_ (first), scale_ (scale)
  {
    for (int s = 0; s < surfaces (); ++s)
    {
      const Surface &surface = *near_.surfaces[s];
      extents_[s] = surface.distance_at == nullptr ? B (1.0f) : LaneExtent<B> (surface, first, scale).presence ();
      seeFrom (s);
    }
    for (int k = 0; k < corners (); ++k)
      seeCornerFrom (k);
  }

  /** \brief Number of sharp surfaces. */
  int
  surfaces () const
  {
    return COUNT == ANY_COUNT ? near_.count : COUNT;
  }

  /** \brief Place of a surface among those that were given. */
  int
  number (int surface) const
  {
    return near_.numbers[surface];
  }

  int
  terms () const
  {
    return (HAS_SQUARES ? 2 : 1) * surfaces () + corners ();
  }

  /** \brief Place of a surface's θ² among the terms, which may end before it. */
  int
  squareOf (int surface) const
  {
    return surfaces () + corners () + surface;
  }

  /** \brief Values and slopes of the terms at a node.
   * \return a bit for each term that is not zero in all lanes
   */
  unsigned
  evaluate (std::size_t node, B *R, B (*G)[3]) const
  {
    unsigned there = ~0u;
    for (int s = 0; s < surfaces (); ++s)
    {
      const Surface &surface = *near_.surfaces[s];
      const B theta = B (surface.theta[node]) * scale_, height = sign_[s] * theta, on = isOn (height, s);
      there &= xsimd::any (on > B (0.5f)) ? ~0u : ~(1u << s);
      R[s] = ARE_JUMPS ? on : on * height;
      for (int a = 0; a < 3; ++a)
        G[s][a] = ARE_JUMPS ? B (0.0f) : on * sign_[s] * B (surface.gradient[a][node]);
      if constexpr (HAS_SQUARES)
      {
        R[squareOf (s)] = theta * theta;
        for (int a = 0; a < 3; ++a)
          G[squareOf (s)][a] = B (2.0f) * theta * B (surface.gradient[a][node]);
      }
    }
    for (int k = 0; k < corners (); ++k)
      evaluateCorner (node, k, R[surfaces () + k], G[surfaces () + k]);
    return there;
  }

  /** \brief Whether some lane sees a term from the front, or from behind: there it has another value at nodes. */
  bool
  isSeen (int term, bool from_behind) const
  {
    return from_behind ? xsimd::any (isBehind (term)) : xsimd::any (!isBehind (term));
  }

  /** \brief Calls visit (term, whether from behind) for the ways in which lanes see terms. */
  template <typename VisitT>
  void
  visitViews (VisitT visit) const
  {
    for (int term = 0; term < terms (); ++term)
      for (const bool from_behind : {false, true})
        if (isSeen (term, from_behind))
          visit (term, from_behind);
  }

  Mask
  isBehind (int term) const
  {
    return term < surfaces () ? sign_[term] < B (0.0f) : is_behind_[term - surfaces ()];
  }

  /** \brief A term at a node as it is seen from one side: a length, but for jumps. */
  float
  valueAtNode (int term, bool from_behind, std::size_t node) const
  {
    if (term < surfaces ())
    {
      const float height = from_behind ? -thetaAtNode (term, node) : thetaAtNode (term, node);
      const bool is_on = height > 0.0f || (ARE_JUMPS && height >= 0.0f && !from_behind);
      return is_on ? (ARE_JUMPS ? 1.0f : height) : 0.0f;
    }
    const float sign = from_behind ? -1.0f : 1.0f;
    if constexpr (ARE_JUMPS)
      return near_.jumpOfCorner (term - surfaces (), node, sign);
    float height = 0.0f, slope[3] = {};
    near_.evaluateCorner (term - surfaces (), node, sign, height, slope);
    return height;
  }

  /** \brief The same of a surface's term where θ is known. */
  static B
  valueAt (B theta, bool from_behind)
  {
    const B height = from_behind ? -theta : theta, zero (0.0f);
    if constexpr (ARE_JUMPS)
      return xsimd::select (from_behind ? height > zero : height >= zero, B (1.0f), zero);
    return xsimd::max (height, zero);
  }

  float
  thetaAtNode (int surface, std::size_t node) const
  {
    return near_.surfaces[surface]->theta[node];
  }

  /** \brief A term's value at x. */
  B
  atPoint (int term) const
  {
    return at_x_[term];
  }

  /** \brief A component of its slope there. */
  B
  slopeAtPoint (int term, int axis) const
  {
    return slope_at_x_[term][axis];
  }

  /** \brief The power of the length scale that a term goes with. */
  float
  degree (int term) const
  {
    return term >= squareOf (0) ? 2.0f : ARE_JUMPS ? 0.0f : 1.0f;
  }

protected:
  using Corner = typename LaneSurfaces<B>::Corner;

  int
  corners () const
  {
    return COUNT == ANY_COUNT ? near_.corner_count : 0;
  }

  /** \brief What the extents of its surfaces leave of a kink or a corner. */
  B
  extentOf (int term) const
  {
    if (term < surfaces ())
      return extents_[term];
    const Corner &corner = near_.corners[term - surfaces ()];
    return extents_[corner.a] * extents_[corner.b] * extents_[corner.c];
  }

  const LaneSurfaces<B> &near_;
  std::size_t first_; // place of the evaluation point in the first lane
  B scale_;
  B extents_[MAX_COUNT]; // what a surface's extent leaves of it

private:
  void
  seeFrom (int s)
  {
    const Surface &surface = *near_.surfaces[s];
    const B theta = B::load_unaligned (surface.theta_at + first_), one (1.0f), zero (0.0f);
    const auto holds_x = theta >= zero;
    const bool is_reversible = ARE_JUMPS || surface.is_plane;
    sign_[s] = is_reversible ? xsimd::select (holds_x, -one, one) : one;
    open_[s] = is_reversible ? xsimd::select (holds_x, one, zero) : zero;
    const B height = sign_[s] * theta * scale_,
            on = isSeenFromElsewhere (s) ? isBeyond (sign_[s] * seen (s)) : isOn (height, s);
    at_x_[s] = ARE_JUMPS ? on : on * height;
    if constexpr (HAS_SQUARES)
      at_x_[squareOf (s)] = theta * theta * scale_ * scale_;
    for (int a = 0; a < 3; ++a)
    {
      const B g = B::load_unaligned (surface.gradient_at[a] + first_);
      slope_at_x_[s][a] = ARE_JUMPS ? zero : on * sign_[s] * g;
      if constexpr (HAS_SQUARES)
        slope_at_x_[squareOf (s)][a] = B (2.0f) * theta * scale_ * g;
    }
  }

  /** \brief θ where the points are seen from: of the smooth pieces of f that one is meant which holds there. */
  B
  seen (int s) const
  {
    const Surface &surface = *near_.surfaces[s];
    return B::load_unaligned ((isSeenFromElsewhere (s) ? surface.theta_seen : surface.theta_at) + first_);
  }

  bool
  isSeenFromElsewhere (int s) const
  {
    return near_.surfaces[s]->theta_seen != nullptr;
  }

  static B
  isBeyond (B height)
  {
    return xsimd::select (height > B (0.0f), B (1.0f), B (0.0f));
  }

  void
  seeCornerFrom (int k)
  {
    const Corner &corner = near_.corners[k];
    const Surface &a = *near_.surfaces[corner.a], &b = *near_.surfaces[corner.b];
    const B zero (0.0f), one (1.0f), height_a = B (corner.scale_a) * B::load_unaligned (a.theta_at + first_),
                                     height_b = B (corner.scale_b) * B::load_unaligned (b.theta_at + first_);
    // One that fades is always seen from the same side: see Enrichment::addTerm ().
    const auto holds_x = height_a >= zero && height_b >= zero && extentOf (surfaces () + k) >= one;
    const B sign = ARE_JUMPS || (a.is_plane && b.is_plane) ? xsimd::select (holds_x, -one, one) : one;
    is_behind_[k] = sign < zero;
    const B seen_a = B (corner.scale_a) * seen (corner.a), seen_b = B (corner.scale_b) * seen (corner.b);
    const auto is_b = sign * seen_b < sign * seen_a;
    const B scale = sign * xsimd::select (is_b, B (corner.scale_b), B (corner.scale_a));
    const B height = sign * xsimd::select (is_b, height_b, height_a) * scale_;
    const bool is_elsewhere = isSeenFromElsewhere (corner.a);
    const auto is_on = is_elsewhere ? sign * xsimd::select (is_b, seen_b, seen_a) > zero
                                    : height > zero || (height >= zero && (ARE_JUMPS ? sign : scale) > zero);
    at_x_[surfaces () + k] = xsimd::select (is_on, ARE_JUMPS ? one : height, zero);
    for (int i = 0; i < 3; ++i)
    {
      const B slope = xsimd::select (is_b, B::load_unaligned (b.gradient_at[i] + first_),
                                     B::load_unaligned (a.gradient_at[i] + first_));
      slope_at_x_[surfaces () + k][i] = ARE_JUMPS ? zero : xsimd::select (is_on, scale * slope, zero);
    }
  }

  void
  evaluateCorner (std::size_t node, int k, B &value, B *gradient) const
  {
    float height = 0.0f, slope[3] = {}, height_behind = 0.0f, slope_behind[3] = {};
    if constexpr (ARE_JUMPS)
    {
      value = xsimd::select (is_behind_[k], B (near_.jumpOfCorner (k, node, -1.0f)),
                             B (near_.jumpOfCorner (k, node, 1.0f)));
      return; // slopes are not asked for
    }
    near_.evaluateCorner (k, node, 1.0f, height, slope);
    near_.evaluateCorner (k, node, -1.0f, height_behind, slope_behind);
    value = xsimd::select (is_behind_[k], B (height_behind), B (height)) * scale_;
    for (int i = 0; i < 3; ++i)
      gradient[i] = xsimd::select (is_behind_[k], B (slope_behind[i]), B (slope[i]));
  }

  /** \brief 1 where a kink of this height is not zero. */
  B
  isOn (B height, int s) const
  {
    const B one (1.0f), zero (0.0f);
    return xsimd::select (height > zero, one, xsimd::select (height < zero, zero, one - open_[s]));
  }

  B sign_[MAX_COUNT], open_[MAX_COUNT]; // of θ; 1 where the kink is zero on the surface itself
  Mask is_behind_[MAX_CORNERS + 1];     // where a corner is seen from
  B at_x_[MAX_TERMS], slope_at_x_[MAX_TERMS][3];
};

} // namespace erkpa::lanes
