// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lanes.h"

#include <xsimd/xsimd.hpp>

namespace erkpa::lanes
{

/** \brief The terms that sharp surfaces add, in lanes: for each a kink θH(θ), and after all of these each one's θ².
 *
 * See Enrichment: a kink is seen from the side on which it is zero at x, where it may be; it counts where the support
 * holds nodes on either side of its surface; its square fades where few lie on one of them. A term's value at a node
 * and its slope are in coordinates u = (y - x) / ε, as θ / ε.
 */
template <typename B>
class LaneKinks
{
public:
  static constexpr int MAX_TERMS = 2 * static_cast<int> (MAX_SURFACES);

  /** \param[in] first place of the evaluation point in the first lane
   * \param[in] scale 1 / ε
   */
  LaneKinks (const SharpSurfaces &sharp, std::size_t first, B scale)
      : sharp_ (sharp), scale_ (scale), count_ (static_cast<int> (sharp.count))
  {
    for (int s = 0; s < count_; ++s)
    {
      below_[s] = above_[s] = B (0.0f);
      seeFrom (first, s);
    }
  }

  /** \brief Number of sharp surfaces; there are twice as many terms. */
  int
  surfaces () const
  {
    return count_;
  }

  /** \brief Values and slopes of the terms at a node. */
  void
  evaluate (std::size_t node, B *R, B (*G)[3]) const
  {
    for (int s = 0; s < count_; ++s)
    {
      const Surface &surface = sharp_.surfaces[s];
      const B theta = B (surface.theta[node]) * scale_, height = sign_[s] * theta, on = isOn (height, s);
      R[s] = on * height;
      R[count_ + s] = theta * theta;
      for (int a = 0; a < 3; ++a)
      {
        const B g (surface.gradient[a][node]);
        G[s][a] = on * sign_[s] * g;
        G[count_ + s][a] = B (2.0f) * theta * g;
      }
    }
  }

  /** \brief Calls visit (surface, whether it is below) for the surfaces that a node is not on. */
  template <typename VisitT>
  void
  visitSides (std::size_t node, VisitT visit) const
  {
    for (int s = 0; s < count_; ++s)
      if (const float theta = sharp_.surfaces[s].theta[node]; theta < 0.0f || theta > 0.0f)
        visit (s, theta < 0.0f);
  }

  /** \brief Weigh a node on its sides. */
  void
  weigh (std::size_t node, B weight)
  {
    visitSides (node, [&] (int s, bool is_below) { (is_below ? below_ : above_)[s] += weight; });
  }

  /** \brief Once all nodes are weighed: what counts. */
  void
  activate (B total_weight)
  {
    const B zero (0.0f), one (1.0f);
    weight_ = total_weight;
    for (int s = 0; s < count_; ++s)
    {
      active_[s] = xsimd::select (below_[s] > zero && above_[s] > zero, one, zero);
      const B share = xsimd::min (balance (s) * B (1.0f / LEAST_BALANCE), one);
      presence_[s] = share * share * (B (3.0f) - B (2.0f) * share);
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
    if (term < count_)
      return active_[term];
    const int s = term - count_;
    const B zero (0.0f);
    return sharp_.surfaces[s].squared ? xsimd::select (presence_[s] > B (MIN_PRESENCE), active_[s], zero) : zero;
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

  /** \brief How much the pivot of a surface's square is raised since it fades: see FieldFit::setFades (). */
  B
  fadeOf (int s) const
  {
    const B p = leastPresence (s), left = B (1.0f) - p;
    return B (FADE) * weight_ * left * left / (p * p);
  }

  /** \brief ε∇ of it, and of the scale of the term: FieldFit::gradientOfFade ().
   * \param[in] of_all,of_below,of_above ε∇ of the weights of all nodes and of those on either side, along an axis
   * \param[in] radius_gradient ∇ε along it
   */
  B
  fadeGradient (int s, B of_all, B of_below, B of_above, B radius_gradient) const
  {
    const B p = leastPresence (s), left = B (1.0f) - p, fade = fadeOf (s);
    const B of_side = xsimd::select (below_[s] < above_[s], of_below, of_above);
    const B share = balance (s) * B (1.0f / LEAST_BALANCE);
    const B rise = xsimd::select (share < B (1.0f), B (6.0f / LEAST_BALANCE) * share * (B (1.0f) - share), B (0.0f));
    const B by_balance = B (-2.0f * FADE) * left / (p * p * p) * rise;
    return fade / weight_ * of_all + by_balance * xsimd::fnma (balance (s), of_all, of_side) +
           B (4.0f) * fade * radius_gradient;
  }

  /** \brief Where three surfaces meet and count. */
  auto
  isAtCorner () const
  {
    auto corner = B (0.0f) > B (1.0f);
    for (std::size_t p = 0; p < sharp_.pencil_count; ++p)
    {
      const int *of = sharp_.pencils[p];
      corner = corner || active_[of[0]] * active_[of[1]] * active_[of[2]] > B (0.5f);
    }
    return corner;
  }

private:
  static constexpr float LEAST_BALANCE = 0.2f, FADE = 0.1f, MIN_PRESENCE = 1e-6f; // see Enrichment and FieldFit

  void
  seeFrom (std::size_t first, int s)
  {
    const Surface &surface = sharp_.surfaces[s];
    const B theta = B::load_unaligned (surface.theta_at + first), one (1.0f), zero (0.0f);
    const auto holds_x = theta >= zero;
    sign_[s] = surface.reversible ? xsimd::select (holds_x, -one, one) : one;
    open_[s] = surface.reversible ? xsimd::select (holds_x, one, zero) : zero;
    const B height = sign_[s] * theta * scale_, on = isOn (height, s);
    at_x_[s] = on * height;
    at_x_[count_ + s] = theta * theta * scale_ * scale_;
    for (int a = 0; a < 3; ++a)
    {
      const B g = B::load_unaligned (surface.gradient_at[a] + first);
      slope_at_x_[s][a] = on * sign_[s] * g;
      slope_at_x_[count_ + s][a] = B (2.0f) * theta * scale_ * g;
    }
  }

  /** \brief 1 where a kink of this height is not zero. */
  B
  isOn (B height, int s) const
  {
    const B one (1.0f), zero (0.0f);
    return xsimd::select (height > zero, one, xsimd::select (height < zero, zero, one - open_[s]));
  }

  /** \brief The share of the nodes on the side of a surface where there are fewer. */
  B
  balance (int s) const
  {
    return xsimd::min (below_[s], above_[s]) / weight_;
  }

  B
  leastPresence (int s) const
  {
    return xsimd::max (presence_[s], B (MIN_PRESENCE));
  }

  const SharpSurfaces &sharp_;
  B scale_;
  int count_;
  B sign_[MAX_SURFACES], open_[MAX_SURFACES]; // of θ; 1 where the kink is zero on the surface itself
  B below_[MAX_SURFACES], above_[MAX_SURFACES], presence_[MAX_SURFACES], active_[MAX_SURFACES];
  B at_x_[MAX_TERMS], slope_at_x_[MAX_TERMS][3];
  B weight_;
};

} // namespace erkpa::lanes
