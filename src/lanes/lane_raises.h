// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_pivot.h"
#include "lane_terms.h"
#include "lane_vector.h"

namespace erkpa::lanes
{

/** \brief What the change of raised pivots does to ∇f: FieldFit::gradientOfRaises () for the linear terms, which come
 * first and do not know of those that follow them.
 * \param[in,out] gradient ∇f
 * \param[in] system pivot (j) and residualOfTerm (j, v) of the fit: see LaneSystem
 * \param[in] a,c M^-1 R(x) and M^-1 b
 * \param[in] radius_gradient ∇ε
 * \param[in] spread Σ w |u - centroid|²
 * \param[in] sum_changes sum_changes (v, of_pivot, of_spread) sums up Σ ∇w (v·R)² and Σ ∇w |u - centroid|²
 */
template <typename B, typename TermsT, typename SystemT, typename SumChangesT>
void
subtractRaises (B *gradient, const SystemT &system, const B *a, const B *c, const B *radius_gradient, B spread,
                SumChangesT sum_changes)
{
  constexpr int LINEAR = TermsT::SIZE > 1 ? 3 : 0;
  B v[1 + LINEAR][TermsT::SIZE], of_pivot[1 + LINEAR][3], of_spread[3];
  bool is_none_raised = true;
  for (int j = 1; j <= LINEAR; ++j)
  {
    system.residualOfTerm (j, v[j]);
    of_pivot[j][0] = of_pivot[j][1] = of_pivot[j][2] = B (0.0f);
    if (!xsimd::any (system.pivot (j).raise > B (0.0f)))
      continue; // mostly all but the term across the surface
    sum_changes (v[j], of_pivot[j], of_spread);
    is_none_raised = false;
  }
  if (is_none_raised)
    return;
  B of_raise[1 + LINEAR][3];
  for (int j = 1; j <= LINEAR; ++j)
  {
    const LanePivot<B> &p = system.pivot (j);
    const auto is_raised = p.raise > B (0.0f);
    const B floor = xsimd::select (is_raised, p.floor, B (1.0f)), by_floor = (p.raise - p.slope * p.pivot) / floor;
    for (int axis = 0; axis < 3; ++axis)
    {
      B of_this = fnma (B (2.0f) * p.pivot, radius_gradient[axis], of_pivot[j][axis]);
      for (int k = 1; k < j; ++k)
        of_this = xsimd::fma (v[j][k] * v[j][k], of_raise[k][axis], of_this);
      const B of_floor = floor * (of_spread[axis] / spread - B (2.0f) * radius_gradient[axis]);
      of_this = p.slope * of_this + by_floor * of_floor + B (2.0f) * p.raise * radius_gradient[axis];
      of_raise[j][axis] = xsimd::select (is_raised, of_this, B (0.0f));
      gradient[axis] = fnma (a[j] * c[j], of_raise[j][axis], gradient[axis]);
    }
  }
}

/** \brief These changes, summed up over the nodes. */
template <typename B, typename TermsT, typename WeightsT>
class NodeChanges
{
public:
  /** \param[in] centroid of the weighted nodes, in u */
  NodeChanges (const WeightsT &weights, const B *centroid, const B *radius_gradient)
      : weights_ (weights), centroid_ (centroid), radius_gradient_ (radius_gradient)
  {
  }

  void
  operator() (const B *v, B *of_pivot, B *of_spread) const
  {
    B by_pivot[3], by_spread[3];
    for (int a = 0; a < 3; ++a)
      by_pivot[a] = by_spread[a] = B (0.0f);
    const auto add = [&] (std::size_t i, B, B t, const B *d)
    {
      B R[TermsT::SIZE], away (0.0f);
      const B slope = weights_.slope (i, t), squared = t * t;
      B way[3];
      weights_.steepest (i, d, way);
      TermsT::evaluate (d, weights_.squaredLength (t, d), R);
      const B height = combine<TermsT> (v, R), squared_height = height * height;
      for (int a = 0; a < 3; ++a)
      {
        const B from = d[a] - centroid_[a];
        away = xsimd::fma (from, from, away);
      }
      for (int a = 0; a < 3; ++a)
      {
        const B change = slope * xsimd::fma (squared, radius_gradient_[a], way[a]);
        by_pivot[a] = fnma (change, squared_height, by_pivot[a]);
        by_spread[a] = fnma (change, away, by_spread[a]);
      }
    };
    weights_.visitNodes (add);
    for (int a = 0; a < 3; ++a)
    {
      of_pivot[a] = by_pivot[a];
      of_spread[a] = by_spread[a];
    }
  }

private:
  const WeightsT &weights_;
  const B *centroid_, *radius_gradient_;
};

} // namespace erkpa::lanes
