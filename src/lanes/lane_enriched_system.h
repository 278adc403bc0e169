// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_pivot.h"
#include "lane_terms.h"

namespace erkpa::lanes
{

/** \brief LaneSystem with the terms of sharp surfaces after the polynomials, of which each support has its own number.
 * \tparam POLYNOMIALS their number
 * \tparam MAX_SIZE of all terms together
 */
template <typename B, int POLYNOMIALS, int MAX_SIZE>
class LaneEnrichedSystem
{
public:
  /** \brief M, then L and D, row after row of its lower triangle. */
  B M[MAX_SIZE * (MAX_SIZE + 1) / 2];
  B b[MAX_SIZE];

  explicit LaneEnrichedSystem (int size) : size_ (size)
  {
    for (int j = 0; j < size; ++j)
    {
      b[j] = B (0.0f);
      for (int i = 0; i <= j; ++i)
        M[at (j, i)] = B (0.0f);
    }
  }

  int
  size () const
  {
    return size_;
  }

  /** \brief Strike a term out in lanes where it is not kept: these may hold NaNs, which a product would keep. */
  template <typename MaskT>
  void
  keepWhere (const MaskT &is_kept, int term)
  {
    for (int i = 0; i <= term; ++i)
      M[at (term, i)] = xsimd::select (is_kept, M[at (term, i)], B (0.0f));
    for (int i = term + 1; i < size_; ++i)
      M[at (i, term)] = xsimd::select (is_kept, M[at (i, term)], B (0.0f));
    b[term] = xsimd::select (is_kept, b[term], B (0.0f));
  }

  /** \brief M = L D L^T: see MomentSystem::factorize ().
   * \param[in] floor_of floor_of (term, its moment) below which its pivot is raised
   * \param[in] first_fading,fade_of fade_of (term) is added to the pivots of that term and those after it
   */
  template <typename FloorT, typename FadeT>
  void
  factorize (FloorT floor_of, int first_fading, FadeT fade_of)
  {
    B moments[MAX_SIZE];
    for (int j = 0; j < size_; ++j)
      moments[j] = M[at (j, j)];
    for (int j = 0; j < size_; ++j)
    {
      M[at (j, j)] = pivots_[j].raiseFrom (M[at (j, j)], floor_of (j, moments[j]));
      if (j >= first_fading)
        M[at (j, j)] += fade_of (j);
      const B inverse = B (1.0f) / M[at (j, j)];
      for (int k = j + 1; k < size_; ++k)
      {
        const B factor = M[at (k, j)] * inverse;
        for (int i = k; i < size_; ++i)
          M[at (i, k)] = fnma (M[at (i, j)], factor, M[at (i, k)]);
      }
      for (int i = j + 1; i < size_; ++i)
        M[at (i, j)] *= inverse;
    }
  }

  /** \brief v <- M^-1 v. */
  void
  solve (B *v) const
  {
    for (int j = 0; j < size_; ++j)
      for (int i = j + 1; i < size_; ++i)
        v[i] = fnma (M[at (i, j)], v[j], v[i]);
    for (int j = 0; j < size_; ++j)
      v[j] /= M[at (j, j)];
    for (int j = size_ - 2; j >= 0; --j)
      for (int i = j + 1; i < size_; ++i)
        v[j] = fnma (M[at (i, j)], v[i], v[j]);
  }

  /** \brief Of a term, as it was raised. */
  const LanePivot<B> &
  pivot (int term) const
  {
    return pivots_[term];
  }

  /** \brief v with pivot = v^T M v, of a polynomial: those after it count for nothing. */
  void
  residualOfTerm (int term, B *v) const
  {
    for (int i = 0; i < POLYNOMIALS; ++i)
      v[i] = B (i == term ? 1.0f : 0.0f);
    for (int j = term - 1; j >= 0; --j)
      for (int i = j + 1; i <= term; ++i)
        v[j] = fnma (M[at (i, j)], v[i], v[j]);
  }

private:
  int size_;
  LanePivot<B> pivots_[MAX_SIZE];
};

} // namespace erkpa::lanes
