// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_pivot.h"
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
      const B floor = floorOfPolynomial (constraint, TermsT::degree (j), weight, spread);
      M[at (j, j)] = pivots_[j].raiseFrom (M[at (j, j)], floor);
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

  /** \brief Of term j, as it was raised. */
  const LanePivot<B> &
  pivot (int j) const
  {
    return pivots_[j];
  }

private:
  void
  backSubstitute (B *v, int last) const
  {
    for (int j = last - 1; j >= 0; --j)
      for (int i = j + 1; i <= last; ++i)
        v[j] = fnma (M[at (i, j)], v[i], v[j]);
  }

  B inverses_[SIZE]; // 1 / D
  LanePivot<B> pivots_[SIZE];
};

} // namespace erkpa::lanes
