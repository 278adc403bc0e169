// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_balance.h"
#include "lane_extent.h"
#include "lane_term_values.h"

namespace erkpa::lanes
{

/** \brief The terms that sharp surfaces add, and how much of them is in force.
 *
 * See Enrichment: a term counts where the support holds nodes on either side of its surface; its square fades where few
 * lie on one of them, and all terms of a limited surface fade with it.
 */
template <typename B, int COUNT, LaneEnrichment FORM>
class LaneKinks : public LaneTermValues<B, COUNT, FORM>
{
  using Base = LaneTermValues<B, COUNT, FORM>;
  using Base::extents_;
  using Base::first_;
  using Base::near_;
  using Base::scale_;

public:
  using Base::degree;
  using Base::MAX_COUNT;
  using Base::squareOf;
  using Base::surfaces;

  /** \param[in] first place of the evaluation point in the first lane
   * \param[in] scale 1 / ε
   */
  LaneKinks (const LaneSurfaces<B> &near, std::size_t first, B scale) : Base (near, first, scale) {}

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

private:
  static constexpr float FADE = 0.1f, MIN_PRESENCE = 1e-6f; // see Enrichment and FieldFit

  using Corner = typename LaneSurfaces<B>::Corner;

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

  /** \brief How much of a term is in force. */
  B
  presence (int term) const
  {
    if (term >= squareOf (0))
      return extents_[term - squareOf (0)] * balanced_[term - squareOf (0)];
    return this->extentOf (term);
  }

  B
  leastPresence (int term) const
  {
    return xsimd::max (presence (term), B (MIN_PRESENCE));
  }

  LaneBalance<B> balances_[MAX_COUNT];
  B active_[MAX_COUNT];
  B balanced_[MAX_COUNT]; // the balance of a surface's square
  B weight_;
};

} // namespace erkpa::lanes
