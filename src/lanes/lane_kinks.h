// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_balance.h"
#include "lane_extent.h"
#include "lane_surfaces.h"

namespace erkpa::lanes
{

/** \brief A number of sharp surfaces that is not known beforehand. */
constexpr int ANY_COUNT = -1;

/** \brief The terms that sharp surfaces add, in lanes: for each a kink θH(θ), then for each three that meet in a corner
 * min (a⁺, b⁺), and after all of these, where gradients are fitted, each surface's θ².
 *
 * See Enrichment: a kink is seen from the side on which it is zero at x, where it may be; it counts where the support
 * holds nodes on either side of its surface; its square fades where few lie on one of them, and all terms of a limited
 * surface fade with it. A term's value at a node and its slope are in coordinates u = (y - x) / ε, as θ / ε.
 * \tparam COUNT so many surfaces, without corners: loops over them can be unrolled; or ANY_COUNT
 * \tparam FORM what the terms are; jumps are H(θ), and H(a)H(b) and H(b)H(c) at a corner, in the place of kinks
 */
template <typename B, int COUNT, LaneEnrichment FORM>
class LaneKinks
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
  LaneKinks (const LaneSurfaces<B> &near, std::size_t first, B scale) : near_ (near), first_ (first), scale_ (scale)
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

  /** \brief Calls visit (surface, whether it is below) for the surfaces that a node is not on. */
  template <typename VisitT>
  void
  visitSides (std::size_t node, VisitT visit) const
  {
    for (int s = 0; s < surfaces (); ++s)
      if (const float theta = near_.surfaces[s]->theta[node]; theta < 0.0f || theta > 0.0f)
        visit (s, theta < 0.0f);
  }

  /** \brief Weigh a node on its sides. */
  void
  weigh (std::size_t node, B weight)
  {
    visitSides (node, [&] (int s, bool is_below) { balances_[s].add (is_below, weight); });
  }

  /** \brief The same of all nodes at once. */
  void
  weighSides (int surface, B below, B above)
  {
    balances_[surface] = LaneBalance<B> (below, above);
  }

  /** \brief Once all nodes are weighed: what counts. */
  void
  activate (B total_weight)
  {
    const B zero (0.0f), one (1.0f);
    weight_ = total_weight;
    for (int s = 0; s < surfaces (); ++s)
    {
      active_[s] = xsimd::select (balances_[s].hasBoth () && extents_[s] > B (MIN_PRESENCE), one, zero);
      balanced_[s] = balances_[s].presence (weight_);
    }
  }

  /** \brief 1 where a surface passes between the nodes of the support. */
  B
  isActive (int surface) const
  {
    return active_[surface];
  }

  /** \brief 1 where a term counts. */
  B
  counts (int term) const
  {
    if (term < surfaces ())
      return active_[term];
    if (term < squareOf (0))
    {
      const Corner &corner = near_.corners[term - surfaces ()];
      const B all = active_[corner.a] * active_[corner.b] * active_[corner.c];
      return xsimd::select (presence (term) > B (MIN_PRESENCE), all, B (0.0f));
    }
    const int s = term - squareOf (0);
    return xsimd::select (presence (term) > B (MIN_PRESENCE), active_[s], B (0.0f));
  }

  /** \brief The first term that may fade; those after it may, too. */
  int
  firstFading () const
  {
    return near_.is_limited ? 0 : squareOf (0);
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

  /** \brief How much the pivot of a term is raised since it fades: see FieldFit::setFades (). */
  B
  fadeOf (int term) const
  {
    const B p = leastPresence (term), left = B (1.0f) - p;
    return B (FADE) * weight_ * left * left / (p * p);
  }

  /** \brief ε∇ of it, and of the scale of the term: FieldFit::gradientOfFade ().
   * \param[in] axis along which
   * \param[in] of_all,of_below,of_above ε∇ of the weights of all nodes and, per surface, of those on either side
   * \param[in] radius_gradient ∇ε
   */
  B
  fadeGradient (int term, int axis, B of_all, const B *of_below, const B *of_above, B radius_gradient) const
  {
    const bool is_square = term >= squareOf (0);
    const B p = leastPresence (term), left = B (1.0f) - p, fade = fadeOf (term);
    const B change = is_square ? ofSquare (term - squareOf (0), axis, of_all, of_below, of_above, radius_gradient)
                               : weight_ * extentChange (term, axis, radius_gradient);
    return fade / weight_ * of_all - B (2.0f * FADE) * left / (p * p * p) * change +
           B (2.0f * degree (term)) * fade * radius_gradient;
  }

  /** \brief The power of the length scale that a term goes with. */
  float
  degree (int term) const
  {
    return term >= squareOf (0) ? 2.0f : ARE_JUMPS ? 0.0f : 1.0f;
  }

private:
  static constexpr float FADE = 0.1f, MIN_PRESENCE = 1e-6f; // see Enrichment and FieldFit

  using Corner = typename LaneSurfaces<B>::Corner;

  int
  corners () const
  {
    return COUNT == ANY_COUNT ? near_.corner_count : 0;
  }

  /** \brief ε∇ of what a surface's extent leaves of it. */
  B
  changeOfExtent (int s, int axis, B radius_gradient) const
  {
    const Surface &surface = *near_.surfaces[s];
    return surface.distance_at == nullptr ? B (0.0f)
                                          : LaneExtent<B> (surface, first_, scale_).change (axis, radius_gradient);
  }

  /** \brief ε∇ of what the extents of its surfaces leave of a kink or a corner. */
  B
  extentChange (int term, int axis, B radius_gradient) const
  {
    if (term < surfaces ())
      return changeOfExtent (term, axis, radius_gradient);
    const Corner &corner = near_.corners[term - surfaces ()];
    const auto change = [&] (int s) { return changeOfExtent (s, axis, radius_gradient); };
    return change (corner.a) * extents_[corner.b] * extents_[corner.c] +
           extents_[corner.a] * (change (corner.b) * extents_[corner.c] + extents_[corner.b] * change (corner.c));
  }

  /** \brief W ε∇ of the presence of a surface's square: of its extent and of the balance. */
  B
  ofSquare (int s, int axis, B of_all, const B *of_below, const B *of_above, B radius_gradient) const
  {
    const B of_balance = extents_[s] * balances_[s].change (weight_, of_all, of_below[s], of_above[s]);
    return near_.is_limited ? xsimd::fma (weight_ * balanced_[s], changeOfExtent (s, axis, radius_gradient), of_balance)
                            : of_balance;
  }

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
    const auto holds_x = height_a >= zero && height_b >= zero && presence (surfaces () + k) >= one;
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

  /** \brief How much of a term is in force. */
  B
  presence (int term) const
  {
    if (term >= squareOf (0))
      return extents_[term - squareOf (0)] * balanced_[term - squareOf (0)];
    if (term < surfaces ())
      return extents_[term];
    const Corner &corner = near_.corners[term - surfaces ()];
    return extents_[corner.a] * extents_[corner.b] * extents_[corner.c];
  }

  B
  leastPresence (int term) const
  {
    return xsimd::max (presence (term), B (MIN_PRESENCE));
  }

  const LaneSurfaces<B> &near_;
  std::size_t first_; // place of the evaluation point in the first lane
  B scale_;
  B sign_[MAX_COUNT], open_[MAX_COUNT]; // of θ; 1 where the kink is zero on the surface itself
  LaneBalance<B> balances_[MAX_COUNT];
  B active_[MAX_COUNT];
  B extents_[MAX_COUNT], balanced_[MAX_COUNT]; // what a surface's extent leaves of it, and the balance of its square
  Mask is_behind_[MAX_CORNERS + 1];            // where a corner is seen from
  B at_x_[MAX_TERMS], slope_at_x_[MAX_TERMS][3];
  B weight_;
};

} // namespace erkpa::lanes
