// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_raises.h"
#include "lane_reach.h"
#include "lane_square_raises.h"
#include "lane_system.h"
#include "lane_weights.h"

namespace erkpa::lanes
{

/** \brief FieldFit in lanes: the sums over the nodes, the solution, and what it says at the evaluation points.
 *
 * Sums are taken in x_i - x, unscaled, and brought to u = (x_i - x) / ε by the degree of their terms afterwards.
 */
template <typename B, Basis BASIS, Constraint CONSTRAINT, template <typename> class KernelT>
class LaneFit
{
public:
  using Mask = decltype (B () < B ());
  static constexpr int SIZE = Terms<B, BASIS>::SIZE;
  static constexpr bool IS_ENRICHED = false;

  /** \param[in,out] sums M and b as LaneMoments says them; the decomposition of M when the fit is made */
  LaneFit (const Settings &settings, const LaneSupport<B> &support, const LaneReach<B> &reach,
           LaneSystem<Terms<B, BASIS>, B> &sums)
      : support_ (support), weights_ (settings, support), scale_ (support.inverse ()), reach_ (reach), system_ (sums)
  {
    scaleMoments ();
    for (int a = 0; a < (SIZE > 1 ? 3 : 0); ++a)
      centroid_[a] = system_.M[at (1 + a, 0)] / system_.M[0];
    B spread (0.0f);
    if constexpr (SIZE > 1)
      for (int a = 0; a < 3; ++a)
        spread += fnma (centroid_[a], system_.M[at (1 + a, 0)], system_.M[at (1 + a, 1 + a)]);
    spread_ = spread;
    weight_ = system_.M[0];
    if constexpr (CONSTRAINT == Constraint::HERMITE)
      TermsT::addGradientMoments (system_.M);
    system_.factorize (CONSTRAINT, spread);
    for (int j = 0; j < SIZE; ++j)
      c_[j] = system_.b[j];
    system_.solve (c_);
    if constexpr (IS_REFINED)
      if (settings.gradients)
        refine ();
  }

  Mask
  isDefined () const
  {
    return reach_.isDefined () && weight_ > B (0.0f);
  }

  /** \brief f(x): R(x) = (1, 0, ...). */
  B
  value () const
  {
    return support_.radius () * c_[0];
  }

  const LaneReach<B> &
  reach () const
  {
    return reach_;
  }

  /** \brief |centroid of the weighted nodes - x|, in ε; zero for the constant basis, which does not sum it up. */
  B
  aside () const
  {
    return SIZE > 1 ? xsimd::sqrt (dot (centroid_, centroid_)) : B (0.0f);
  }

  /** \brief Of term j in the combination that fits the nodes, times ε. */
  B
  coefficient (int j) const
  {
    return support_.radius () * c_[j];
  }

  /** \brief ∇f(x); see FieldFit::gradient (). */
  void
  gradient (const B *growth_of_points, B *gradient)
  {
    B growth[3]; // 2 ∇ε
    for (int a = 0; a < 3; ++a)
      growth[a] = B (2.0f) * growth_of_points[a];
    for (int j = 0; j < SIZE; ++j)
      a_[j] = B (j == 0 ? 1.0f : 0.0f);
    system_.solve (a_);
    B by_u[3] = {B (0.0f), B (0.0f), B (0.0f)}, by_radius (0.0f), direct[3] = {by_radius, by_radius, by_radius};
    if constexpr (SIZE == 1)
      centroid_[0] = centroid_[1] = centroid_[2] = B (0.0f);
    weights_.visitNodes ([&] (std::size_t i, B, B t, const B *u) { addResidual (i, t, u, by_u, by_radius, direct); });
    for (int a = 0; a < 3; ++a)
    {
      gradient[a] = xsimd::fma (growth[a], by_radius, direct[a] - by_u[a]);
      if constexpr (SIZE > 1)
        gradient[a] += c_[1 + a];
    }
    if constexpr (RAISES_MATTER)
      subtractRaises<B, TermsT> (
          gradient, system_, a_, c_, growth_of_points, spread_,
          NodeChanges<B, TermsT, LaneWeights<B, KernelT>> (weights_, centroid_, growth_of_points));
    if constexpr (IS_REFINED)
      LaneSquareRaises<B, CONSTRAINT, LaneWeights<B, KernelT>> (weights_, growth_of_points)
          .subtractFrom (gradient, system_, a_, c_, weight_);
  }

  /** \brief Where the gradient needs more than is computed here, or more digits: functional values of ten terms do. */
  Mask
  isUnsettled () const
  {
    Mask unsettled = SIZE == 10 && !IS_REFINED ? B (0.0f) < B (1.0f) : B (0.0f) > B (1.0f);
    // Where pivots are raised, this reckons with the change of linear ones among themselves, and of ten terms' squares.
    constexpr int FIRST = RAISES_MATTER && SIZE == 4 ? 4 : 1, LAST = IS_REFINED ? 4 : SIZE;
    for (int j = FIRST; j < LAST; ++j)
      unsettled = unsettled || system_.pivot (j).raise > B (0.0f);
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
  // With other constraints pivots that are raised are a rare thing.
  static constexpr bool RAISES_MATTER = CONSTRAINT == Constraint::FUNCTIONAL;
  static constexpr bool IS_REFINED = BASIS == Basis::QUADRATIC && CONSTRAINT != Constraint::FUNCTIONAL;

  /** \brief Fit what is left over at the nodes, too: floats leave few digits of ten terms, but these are small. */
  void
  refine ()
  {
    B rest[SIZE];
    for (B &of_term : rest)
      of_term = B (0.0f);
    weights_.visitNodes (
        [&] (std::size_t i, B, B t, const B *u)
        {
          B R[SIZE], n[3], of_fit[3];
          const B weight = weights_.weightAt (i, t);
          TermsT::evaluate (u, weights_.squaredLength (t, u), R);
          const B height = weight * (weights_.lambda (i) * scale_ - combine<TermsT> (c_, R));
          for (int j = 0; j < SIZE; ++j)
            rest[j] = xsimd::fma (height, R[j], rest[j]);
          if constexpr (CONSTRAINT == Constraint::HERMITE)
          {
            weights_.normal (i, n);
            TermsT::slopes (c_, u, of_fit);
            for (int a = 0; a < 3; ++a)
              n[a] -= of_fit[a];
            TermsT::addNormal (weight, u, n, rest);
          }
        });
    for (int j = 0; j < SIZE; ++j)
      rest[j] = fnma (system_.pivot (j).raise, c_[j], rest[j]);
    system_.solve (rest);
    for (int j = 0; j < SIZE; ++j)
      c_[j] += rest[j];
  }

  /** \brief From x_i - x to u: a term of degree p goes with ε^-p. */
  void
  scaleMoments ()
  {
    B power[5] = {B (1.0f), scale_, scale_ * scale_, scale_ * scale_ * scale_, scale_ * scale_ * scale_ * scale_};
    for (int i = 0; i < SIZE; ++i)
    {
      for (int j = 0; j <= i; ++j)
        if (TermsT::degree (i) + TermsT::degree (j) > 0)
          system_.M[at (i, j)] *= power[TermsT::degree (i) + TermsT::degree (j)];
      if constexpr (CONSTRAINT == Constraint::HERMITE)
        system_.b[i] *= TermsT::degree (i) == 0 ? support_.radius () : power[TermsT::degree (i) - 1];
      else
        system_.b[i] *= power[TermsT::degree (i) + 1];
    }
  }

  /** \brief The residual of the fit at a node, by which the change of its weight moves f. */
  void
  addResidual (std::size_t i, B t, const B *d, B *by_u, B &by_radius, B *direct)
  {
    B n[3], R[SIZE];
    const B weight = weights_.weightAt (i, t);
    if constexpr (SIZE == 1)
      for (int a = 0; a < 3; ++a)
        centroid_[a] = xsimd::fma (weight / weight_, d[a], centroid_[a]);
    weights_.normal (i, n);
    TermsT::evaluate (d, weights_.squaredLength (t, d), R);
    const B share = combine<TermsT> (a_, R);
    B height = weights_.lambda (i) * scale_;
    if constexpr (CONSTRAINT == Constraint::FUNCTIONAL)
      height -= dot (d, n);
    B residual = share * (height - combine<TermsT> (c_, R));
    if constexpr (CONSTRAINT == Constraint::HERMITE)
    {
      B of_shape[3], of_fit[3];
      TermsT::slopes (a_, d, of_shape);
      TermsT::slopes (c_, d, of_fit);
      for (int a = 0; a < 3; ++a)
        n[a] -= of_fit[a];
      const B of_gradients = dot (of_shape, n);
      residual += of_gradients;
      by_radius = xsimd::fma (weight, of_gradients, by_radius);
    }
    const B force = weights_.slope (i, t) * residual;
    by_radius = fnma (B (0.5f) * t * t, force, by_radius);
    B way[3];
    weights_.steepest (i, d, way);
    for (int a = 0; a < 3; ++a)
      by_u[a] = xsimd::fma (force, way[a], by_u[a]);
    if constexpr (CONSTRAINT == Constraint::FUNCTIONAL)
      for (int a = 0; a < 3; ++a)
        direct[a] = xsimd::fma (weight * share, n[a], direct[a]);
  }

  const LaneSupport<B> &support_;
  LaneWeights<B, KernelT> weights_;
  B scale_;
  const LaneReach<B> &reach_;
  LaneSystem<TermsT, B> &system_;
  B centroid_[3], spread_, weight_;
  B c_[SIZE]; // M^-1 b
  B a_[SIZE]; // M^-1 R(x)
};

} // namespace erkpa::lanes
