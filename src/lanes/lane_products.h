// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_terms.h"

namespace erkpa::lanes
{

/** \brief The distinct products R_i R_j of a basis, the terms themselves (R_0 = 1) first. */
template <typename TermsT>
struct ProductTable
{
  static constexpr int MOMENTS = TermsT::SIZE * (TermsT::SIZE + 1) / 2;

  int count = 0;
  int column[MOMENTS] = {}; ///< of M_ij, by at (i, j)
  int first[MOMENTS] = {};  ///< i of a column
  int second[MOMENTS] = {}; ///< j

  constexpr ProductTable ()
  {
    for (int j = 0; j < TermsT::SIZE; ++j)
      add (j, 0);
    for (int i = 1; i < TermsT::SIZE; ++i)
      for (int j = 1; j <= i; ++j)
        add (i, j);
  }

private:
  constexpr void
  add (int i, int j)
  {
    int known = 0;
    while (known < count && !areEqual (i, j, first[known], second[known]))
      ++known;
    if (known == count)
    {
      first[count] = i;
      second[count] = j;
      ++count;
    }
    column[at (i, j)] = known;
  }

  static constexpr bool
  areEqual (int i, int j, int k, int l)
  {
    for (int factor = 0; factor < 4; ++factor)
      if (TermsT::power (i, factor) + TermsT::power (j, factor) !=
          TermsT::power (k, factor) + TermsT::power (l, factor))
        return false;
    return true;
  }
};

/** \brief M from sums of the distinct products, about an origin that is a step s farther on.
 *
 * R (y - s) = T R (y), so that M <- T M T^T.
 * \param[out] M row after row of its lower triangle
 */
template <typename TermsT, typename B>
void
shiftProducts (const B *s, const B *products, B *M)
{
  constexpr int SIZE = TermsT::SIZE;
  constexpr ProductTable<TermsT> PRODUCTS{};
  B full[SIZE][SIZE];
  for (int i = 0; i < SIZE; ++i)
    for (int j = 0; j < SIZE; ++j)
      full[i][j] = products[PRODUCTS.column[i < j ? at (j, i) : at (i, j)]]; // symmetric
  for (auto &row : full)
    TermsT::shift (s, row);
  for (int j = 0; j < SIZE; ++j)
  {
    B column[SIZE];
    for (int i = 0; i < SIZE; ++i)
      column[i] = full[i][j];
    TermsT::shift (s, column);
    for (int i = j; i < SIZE; ++i)
      M[at (i, j)] = column[i];
  }
}

} // namespace erkpa::lanes
