// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_pivot.h"
#include "lane_terms.h"
#include "lane_vector.h"

namespace erkpa::lanes
{

/** \brief What the change of raised pivots does to ∇f: FieldFit::gradientOfRaises () for the squares of the quadratic
 * basis, whose floors are a share of the nodes' weight. */
template <typename B, Constraint CONSTRAINT, typename WeightsT>
class LaneSquareRaises
{
public:
  using TermsT = Terms<B, Basis::QUADRATIC>;
  static constexpr int FIRST = 4; ///< of the squares

  /** \param[in] radius_gradient ∇ε */
  LaneSquareRaises (const WeightsT &weights, const B *radius_gradient)
      : weights_ (weights), radius_gradient_ (radius_gradient)
  {
  }

  /** \param[in,out] gradient ∇f
   * \param[in] system pivot (j) and residualOfTerm (j, v) of the fit: see LaneSystem
   * \param[in] a,c M^-1 R(x) and M^-1 b
   * \param[in] weight of all nodes
   */
  template <typename SystemT>
  void
  subtractFrom (B *gradient, const SystemT &system, const B *a, const B *c, B weight) const
  {
    B of_raise[TermsT::SIZE][3];
    for (int j = FIRST; j < TermsT::SIZE; ++j)
    {
      const LanePivot<B> &pivot = system.pivot (j);
      const auto is_raised = pivot.raise > B (0.0f);
      for (B &along : of_raise[j])
        along = B (0.0f);
      if (!xsimd::any (is_raised))
        continue;
      B v[TermsT::SIZE], of_pivot[3], of_weight[3];
      system.residualOfTerm (j, v);
      sumChanges (v, of_pivot, of_weight);
      const B floor = xsimd::select (is_raised, pivot.floor, B (1.0f));
      const B by_floor = (pivot.raise - pivot.slope * pivot.pivot) / floor, share = floor / weight;
      for (int axis = 0; axis < 3; ++axis)
      {
        const B growth = B (4.0f) * radius_gradient_[axis]; // a square goes with ε², its pivot with ε⁴
        B of_this = fnma (growth, pivot.pivot, of_pivot[axis]);
        for (int k = FIRST; k < j; ++k)
          of_this = xsimd::fma (v[k] * v[k], of_raise[k][axis], of_this);
        of_this = pivot.slope * of_this + by_floor * share * of_weight[axis] + growth * pivot.raise;
        of_raise[j][axis] = xsimd::select (is_raised, of_this, B (0.0f));
        gradient[axis] = fnma (a[j] * c[j], of_raise[j][axis], gradient[axis]);
      }
    }
  }

private:
  /** \brief ∇ of v^T M v and of the weight, but for what the frame does. */
  void
  sumChanges (const B *v, B *of_pivot, B *of_weight) const
  {
    for (int a = 0; a < 3; ++a)
      of_pivot[a] = of_weight[a] = B (0.0f);
    B by_radius (0.0f);
    weights_.visitNodes (
        [&] (std::size_t i, B, B t, const B *u)
        {
          B R[TermsT::SIZE], slopes[3], way[3];
          const B squared = t * t;
          weights_.steepest (i, u, way);
          TermsT::evaluate (u, weights_.squaredLength (t, u), R);
          B held = combine<TermsT> (v, R); // of v^T M v by the node's weight
          held *= held;
          if constexpr (CONSTRAINT == Constraint::HERMITE)
          {
            TermsT::slopes (v, u, slopes);
            const B of_slopes = dot (slopes, slopes);
            held += of_slopes;
            by_radius = xsimd::fma (weights_.weightAt (i, t), of_slopes, by_radius);
          }
          const B slope = weights_.slope (i, t);
          for (int a = 0; a < 3; ++a)
          {
            const B change = slope * xsimd::fma (squared, radius_gradient_[a], way[a]);
            of_pivot[a] = fnma (change, held, of_pivot[a]);
            of_weight[a] -= change;
          }
        });
    for (int a = 0; a < 3; ++a)
      of_pivot[a] = xsimd::fma (B (2.0f) * radius_gradient_[a], by_radius, of_pivot[a]);
  }

  const WeightsT &weights_;
  const B *radius_gradient_;
};

} // namespace erkpa::lanes
