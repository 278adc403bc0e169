// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_terms.h"

namespace erkpa::lanes
{

/** \brief The moment matrix M of eq. (17) and its solution in lanes: see MomentSystem and PivotFloor. */
template <typename TermsT, typename B>
class LaneSystem
{
public:
  static constexpr int SIZE = TermsT::SIZE;
  static constexpr int MOMENTS = SIZE * (SIZE + 1) / 2;

  /** \brief M, then L and D, row after row of its lower triangle. */
  B M[MOMENTS];
  B b[SIZE];

  /** \brief M = L D L^T; pivots below their floors are raised.
   * \param[in] spread Σ w |u - centroid|²
   */
  void
  factorize (Constraint constraint, B spread)
  {
    const B weight = M[0], one (1.0f);
#pragma GCC unroll 10
    for (int j = 0; j < SIZE; ++j)
    {
      floors_[j] = floorOf (constraint, TermsT::degree (j), weight, spread);
      raisePivot (j);
      inverses_[j] = one / M[at (j, j)];
      B factors[SIZE];
      for (int i = j + 1; i < SIZE; ++i)
      {
        factors[i] = M[at (i, j)] * inverses_[j];
        for (int k = j + 1; k <= i; ++k)
          M[at (i, k)] = fnma (M[at (i, j)], factors[k], M[at (i, k)]);
      }
      for (int i = j + 1; i < SIZE; ++i)
        M[at (i, j)] = factors[i];
    }
  }

  /** \brief v <- M^-1 v. */
  void
  solve (B *v) const
  {
    for (int j = 0; j < SIZE; ++j)
      for (int i = j + 1; i < SIZE; ++i)
        v[i] = fnma (M[at (i, j)], v[j], v[i]);
    for (int j = 0; j < SIZE; ++j)
      v[j] *= inverses_[j];
    backSubstitute (v, SIZE - 1);
  }

  /** \brief v with pivot_j = v^T M v. */
  void
  residualOfTerm (int j, B *v) const
  {
    for (int i = 0; i < SIZE; ++i)
      v[i] = B (i == j ? 1.0f : 0.0f);
    backSubstitute (v, j);
  }

  B
  pivot (int j) const
  {
    return pivots_[j];
  }

  B
  floor (int j) const
  {
    return floors_[j];
  }

  /** \brief ρ_j; zero for a term the nodes determine. */
  B
  raise (int j) const
  {
    return raises_[j];
  }

  /** \brief dρ_j / dpivot_j. */
  B
  raiseSlope (int j) const
  {
    return slopes_[j];
  }

private:
  /** \brief See floorOfPolynomial (). */
  static B
  floorOf (Constraint constraint, int degree, B weight, B spread)
  {
    if (degree == 0)
      return B (0.0f);
    if (constraint == Constraint::FUNCTIONAL)
      return degree == 1 ? B (2e-2f) * spread : B (1e-3f) * spread * spread / weight;
    return B (degree == 1 ? 1e-10f : 1e-4f) * weight;
  }

  void
  raisePivot (int j)
  {
    constexpr float LEAST = 1e-9f;
    B pivot = M[at (j, j)];
    const B floor = floors_[j], zero (0.0f), one (1.0f);
    pivots_[j] = pivot;
    raises_[j] = slopes_[j] = zero;
    M[at (j, j)] = xsimd::select (pivot > zero, pivot, one);
    const auto is_low = pivot < floor;
    if (!xsimd::any (is_low))
      return;
    const B share = xsimd::max (pivot / xsimd::select (floor > zero, floor, one), B (LEAST));
    raises_[j] = xsimd::select (is_low, floor * (one - share) * (one - share) / share, zero);
    slopes_[j] = xsimd::select (is_low && share > B (LEAST), one - one / (share * share), zero);
    pivot = xsimd::select (is_low, floor * share + raises_[j], pivot);
    M[at (j, j)] = xsimd::select (pivot > zero, pivot, one);
  }

  void
  backSubstitute (B *v, int last) const
  {
    for (int j = last - 1; j >= 0; --j)
      for (int i = j + 1; i <= last; ++i)
        v[j] = fnma (M[at (i, j)], v[i], v[j]);
  }

  B inverses_[SIZE]; // 1 / D
  B pivots_[SIZE], floors_[SIZE], raises_[SIZE], slopes_[SIZE];
};

} // namespace erkpa::lanes
