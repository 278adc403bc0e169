// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_enriched_sums.h"
#include "lane_enriched_system.h"
#include "lane_kinks.h"
#include "lane_moments.h"
#include "lane_raises.h"
#include "lane_reach.h"
#include "lane_support.h"
#include "lane_term_views.h"
#include "lane_terms.h"
#include "lane_weights.h"

namespace erkpa::lanes
{

/** \brief FieldFit with kinks in lanes, for gradients or functional values: the terms of LaneKinks follow the
 * polynomials. A lane where a term does not count has zeros for it. All sums are taken in u = (x_i - x) / ε.
 * \tparam COUNT of the sharp surfaces: see LaneKinks
 */
template <typename B, Basis BASIS, Constraint CONSTRAINT, template <typename> class KernelT, LaneEnrichment FORM,
          int COUNT>
class LaneEnrichedFit
{
public:
  static constexpr bool IS_HERMITE = CONSTRAINT == Constraint::HERMITE;
  static_assert (IS_HERMITE ? FORM == LaneEnrichment::KINKS_AND_SQUARES : CONSTRAINT == Constraint::FUNCTIONAL);

  using Mask = decltype (B () < B ());
  using KinksT = LaneKinks<B, COUNT, FORM>;
  using MomentsT = LaneMoments<B, BASIS, CONSTRAINT, KernelT>;
  static constexpr int SIZE = Terms<B, BASIS>::SIZE;
  static constexpr bool IS_ENRICHED = true;

  /** \param[in] first place of the evaluation point in the first lane
   * \param moments with memory for sums
   */
  LaneEnrichedFit (const Settings &settings, const LaneSurfaces<B> &near, std::size_t first,
                   const LaneSupport<B> &support, MomentsT &moments)
      : support_ (support), weights_ (settings, support), scale_ (support.inverse ()),
        reach_ (settings, support.radius (), support.squaredRadius ()), kinks_ (near, first, scale_),
        system_ (SIZE + kinks_.terms ())
  {
    LaneEnrichedSums<B, BASIS, CONSTRAINT, KernelT, KinksT, SystemT> (support_, weights_, kinks_, system_, reach_)
        .sum (moments);
    weight_ = system_.M[0];
    spread_ = B (0.0f);
    for (int a = 0; a < 3; ++a)
    {
      centroid_[a] = system_.M[at (1 + a, 0)] / weight_;
      spread_ += fnma (centroid_[a], system_.M[at (1 + a, 0)], system_.M[at (1 + a, 1 + a)]);
    }
    if constexpr (IS_HERMITE)
      TermsT::addGradientMoments (system_.M);
    kinks_.activate (weight_);
    for (int j = 0; j < SIZE; ++j)
      at_x_[j] = B (j == 0 ? 1.0f : 0.0f);
    for (int j = SIZE; j < size (); ++j)
    {
      const auto counts = kinks_.counts (j - SIZE) > B (0.5f);
      system_.keepWhere (counts, j);
      at_x_[j] = xsimd::select (counts, kinks_.atPoint (j - SIZE), B (0.0f));
    }
    system_.factorize ([this] (int j, B moment) { return floorOf (j, moment); }, SIZE + kinks_.firstFading (),
                       [this] (int j) { return kinks_.fadeOf (j - SIZE); });
    for (int j = 0; j < size (); ++j)
      c_[j] = system_.b[j];
    system_.solve (c_);
  }

  Mask
  isDefined () const
  {
    return reach_.isDefined () && weight_ > B (0.0f);
  }

  B
  value () const
  {
    B sum = c_[0];
    for (int j = SIZE; j < size (); ++j)
      sum = xsimd::fma (c_[j], at_x_[j], sum);
    return support_.radius () * sum;
  }

  /** \brief Value and slope of the smooth piece of the fit that holds at x, as coefficients of polynomials, times ε; of
   * terms of a higher degree their own. */
  B
  coefficient (int j) const
  {
    if (j == 0)
      return value ();
    B sum = c_[j];
    for (int e = 0; e < (j <= 3 ? kinks_.terms () : 0); ++e)
      sum = xsimd::fma (c_[SIZE + e], kinks_.slopeAtPoint (e, j - 1), sum);
    return support_.radius () * sum;
  }

  const LaneReach<B> &
  reach () const
  {
    return reach_;
  }

  const KinksT &
  kinks () const
  {
    return kinks_;
  }

  B
  aside () const
  {
    return xsimd::sqrt (dot (centroid_, centroid_));
  }

  /** \brief ∇f(x); see FieldFit::gradient (). */
  void
  gradient (const B *radius_gradient, B *gradient)
  {
    for (int a = 0; a < 3; ++a)
      growth_[a] = B (2.0f) * radius_gradient[a];
    for (int j = 0; j < size (); ++j)
      a_[j] = at_x_[j];
    system_.solve (a_);
    WeightChange<B> all, below[KinksT::MAX_COUNT], above[KinksT::MAX_COUNT];
    B by_u[3] = {B (0.0f), B (0.0f), B (0.0f)}, by_radius (0.0f);
    B direct[3] = {by_radius, by_radius, by_radius}; // of eq. (2)
    if constexpr (IS_HERMITE)
      weights_.visitNodes ([&] (std::size_t i, B, B t, const B *u)
                           { addResidual (i, t, u, by_u, by_radius, all, below, above); });
    else
      weights_.visitNodes (
          [&, views = ViewsT (kinks_, a_ + SIZE, c_ + SIZE, scale_)] (std::size_t i, B, B t, const B *u)
          { addResidual (views, i, t, u, by_u, by_radius, direct, all); });
    for (int a = 0; a < 3; ++a)
    {
      gradient[a] = xsimd::fma (growth_[a], by_radius, c_[1 + a] + direct[a] - by_u[a]);
      for (int j = SIZE; j < size (); ++j)
        gradient[a] = xsimd::fma (c_[j], kinks_.slopeAtPoint (j - SIZE, a), gradient[a]);
      B of_below[KinksT::MAX_COUNT], of_above[KinksT::MAX_COUNT];
      const B of_all = all.along (a, growth_);
      for (int s = 0; s < kinks_.surfaces (); ++s)
      {
        of_below[s] = below[s].along (a, growth_);
        of_above[s] = above[s].along (a, growth_);
      }
      for (int e = kinks_.firstFading (); e < kinks_.terms (); ++e)
      {
        const B of_fade = kinks_.fadeGradient (e, a, of_all, of_below, of_above, radius_gradient[a]);
        const B part = a_[SIZE + e] * c_[SIZE + e];
        gradient[a] =
            xsimd::select (part > B (0.0f) || part < B (0.0f), fnma (part, of_fade, gradient[a]), gradient[a]);
      }
    }
    if constexpr (!IS_HERMITE)
      subtractRaises<B, TermsT> (
          gradient, system_, a_, c_, radius_gradient, spread_,
          NodeChanges<B, TermsT, LaneWeights<B, KernelT>> (weights_, centroid_, radius_gradient));
  }

  /** \brief Where a pivot that is raised moves the gradient by more than is computed here: of functional values, those
   * of the linear terms are, unless there are squares into which they turn. */
  Mask
  isUnsettled () const
  {
    constexpr float NEGLIGIBLE = IS_HERMITE ? 1e-5f : 1e-6f; // floors by moments are higher, and raises change faster
    Mask unsettled = B (0.0f) > B (1.0f);
    if constexpr (!IS_HERMITE && SIZE > 4)
      for (int j = 1; j < SIZE; ++j)
        unsettled = unsettled || system_.pivot (j).raise > B (0.0f);
    for (int j = IS_HERMITE ? 1 : SIZE; j < size (); ++j)
      unsettled = unsettled || xsimd::abs (a_[j] * c_[j] * system_.pivot (j).raise) > B (NEGLIGIBLE);
    return unsettled;
  }

  B
  borderOffset (const B *gradient) const
  {
    return offsetAcross (centroid_, gradient);
  }

  /** \brief Weighted mean of an attribute. */
  B
  blend (const float *attribute) const
  {
    return weights_.sum (attribute) / weight_;
  }

private:
  using TermsT = Terms<B, BASIS>;
  using ViewsT = LaneTermViews<B, KinksT>;
  static constexpr int MAX_SIZE = SIZE + KinksT::MAX_TERMS;
  using SystemT = LaneEnrichedSystem<B, SIZE, MAX_SIZE>;

  /** \brief Number of terms. */
  int
  size () const
  {
    return system_.size ();
  }

  /** \brief Place of a surface's θ² among the terms. */
  int
  squareOf (int s) const
  {
    return SIZE + kinks_.squareOf (s);
  }

  B
  floorOf (int j, B moment) const
  {
    if (j >= SIZE && j < squareOf (0))
      return floorOfKink (CONSTRAINT, weight_, moment);
    return floorOfPolynomial (CONSTRAINT, j < SIZE ? TermsT::degree (j) : 2, weight_, spread_);
  }

  /** \brief The residual of the fit at a node, by which the change of its weight moves f. */
  void
  addResidual (const ViewsT &views, std::size_t i, B t, const B *u, B *by_u, B &by_radius, B *direct,
               WeightChange<B> &all) const
  {
    const std::size_t node = support_.node (i);
    B n[3], R[SIZE];
    const B weight = weights_.weightAt (i, t);
    weights_.normal (i, n);
    TermsT::evaluate (u, t * t, R);
    B share = combine<TermsT> (a_, R),
      residual = heightOf<CONSTRAINT> (weights_, i, scale_, u, n) - combine<TermsT> (c_, R);
    views.addTo (node, share, residual);
    residual *= share;
    for (int a = 0; a < 3; ++a)
      direct[a] = xsimd::fma (weight * share, n[a], direct[a]);
    const B slope = weights_.slope (i, t);
    addForce (slope * residual, t, u, by_u, by_radius);
    if (kinks_.firstFading () < kinks_.terms ())
      all.add (slope, u, t);
  }

  /** \brief The same with gradients, and what the change of the weight is by itself. */
  void
  addResidual (std::size_t i, B t, const B *u, B *by_u, B &by_radius, WeightChange<B> &all, WeightChange<B> *below,
               WeightChange<B> *above) const
  {
    const std::size_t node = support_.node (i);
    B n[3], R[MAX_SIZE], G[KinksT::MAX_TERMS][3];
    const B weight = weights_.weightAt (i, t);
    weights_.normal (i, n);
    TermsT::evaluate (u, t * t, R);
    kinks_.evaluate (node, R + SIZE, G);
    B share (0.0f), residual = heightOf<CONSTRAINT> (weights_, i, scale_, u, n);
    for (int j = 0; j < size (); ++j)
    {
      share = xsimd::fma (a_[j], R[j], share);
      residual = fnma (c_[j], R[j], residual);
    }
    const B of_gradients = residualOfGradient (u, n, G);
    residual = xsimd::fma (share, residual, of_gradients);
    by_radius = xsimd::fma (weight, of_gradients, by_radius);
    const B slope = weights_.slope (i, t);
    addForce (slope * residual, t, u, by_u, by_radius);
    all.add (slope, u, t);
    kinks_.visitSides (node, [&] (int s, bool is_below) { (is_below ? below : above)[s].add (slope, u, t); });
  }

  static void
  addForce (B force, B t, const B *u, B *by_u, B &by_radius)
  {
    by_radius = fnma (B (0.5f) * t * t, force, by_radius);
    for (int a = 0; a < 3; ++a)
      by_u[a] = xsimd::fma (force, u[a], by_u[a]);
  }

  B
  residualOfGradient (const B *u, const B *n, const B (*G)[3]) const
  {
    B of_shape[3], of_fit[3], left[3];
    TermsT::slopes (a_, u, of_shape);
    TermsT::slopes (c_, u, of_fit);
    for (int a = 0; a < 3; ++a)
    {
      for (int e = 0; e < size () - SIZE; ++e)
      {
        of_shape[a] = xsimd::fma (a_[SIZE + e], G[e][a], of_shape[a]);
        of_fit[a] = xsimd::fma (c_[SIZE + e], G[e][a], of_fit[a]);
      }
      left[a] = n[a] - of_fit[a];
    }
    return dot (of_shape, left);
  }

  const LaneSupport<B> &support_;
  LaneWeights<B, KernelT> weights_;
  B scale_;
  LaneReach<B> reach_;
  KinksT kinks_;
  B at_x_[MAX_SIZE]; // R(x)
  SystemT system_;
  B c_[MAX_SIZE], a_[MAX_SIZE]; // M^-1 b, M^-1 R(x)
  B weight_, spread_, centroid_[3], growth_[3];
};

} // namespace erkpa::lanes
