// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_products.h"
#include "lane_vector.h"
#include "lanes.h"

namespace erkpa::lanes
{

/** \brief The sums that are kept at a point of a lattice, as columns. Attributes follow, one column per channel. */
template <typename TermsT, Constraint CONSTRAINT>
struct LatticeColumns
{
  static constexpr ProductTable<TermsT> PRODUCTS{};
  static constexpr int SIZE = TermsT::SIZE;
  static constexpr int SLOPES = PRODUCTS.count; ///< Σ w ∂R n, but for the first term
  static constexpr int HEIGHTS = SLOPES + (CONSTRAINT == Constraint::HERMITE ? SIZE - 1 : 0); ///< Σ w h R
  static constexpr int NORMALS = HEIGHTS + SIZE; ///< Σ w n_a R, by which heights of eq. (2) change with x
  static constexpr int SUPPORT = NORMALS + (CONSTRAINT == Constraint::FUNCTIONAL ? 3 * SIZE : 0); ///< number of nodes
  static constexpr int ON_SURFACE = SUPPORT + 1; ///< of those, without off-surface points
  static constexpr int NEAR = ON_SURFACE + 1;    ///< of these: see Settings::reach
  static constexpr int COUNT = NEAR + 1;

  /** \brief Bring sums about an origin to one that is a step s farther on. */
  template <typename B>
  static void
  shift (const B *s, B *sums)
  {
    B M[ProductTable<TermsT>::MOMENTS], slopes[SIZE];
    shiftProducts<TermsT> (s, sums, M);
    for (int p = 0; p < PRODUCTS.count; ++p)
      sums[p] = M[at (PRODUCTS.first[p], PRODUCTS.second[p])];
    if constexpr (CONSTRAINT == Constraint::HERMITE)
    {
      slopes[0] = B (0.0f);
      for (int j = 1; j < SIZE; ++j)
        slopes[j] = sums[SLOPES + j - 1];
      TermsT::shift (s, slopes);
      for (int j = 1; j < SIZE; ++j)
        sums[SLOPES + j - 1] = slopes[j];
    }
    if constexpr (CONSTRAINT == Constraint::FUNCTIONAL)
      for (int a = 0; a < 3; ++a)
      {
        B *const of_axis = sums + NORMALS + a * SIZE;
        for (int j = 0; j < SIZE; ++j)
          sums[HEIGHTS + j] = xsimd::fma (s[a], of_axis[j], sums[HEIGHTS + j]); // (x - x_i)·n_i
        TermsT::shift (s, of_axis);
      }
    TermsT::shift (s, sums + HEIGHTS);
  }
};

/** \brief Cubic interpolation along an axis of a lattice: the weights of its points and their derivatives.
 *
 * Lagrange's polynomials through the four points around each lane, which are exact for cubics; derivatives are those
 * of the cell that holds the lane.
 */
template <typename B>
class LatticeAxis
{
public:
  static constexpr std::size_t MOST = Lattice::MOST;

  LatticeAxis () = default;

  /** \param[in] x coordinates in the lanes
   * \param[in] first,spacing,points of the lattice
   */
  LatticeAxis (B x, float first, float spacing, std::size_t points)
  {
    const B along = (x - B (first)) * B (1.0f / spacing);
    const B cell = xsimd::floor (along), u = along - cell, one (1.0f), two (2.0f), half (0.5f), sixth (1.0f / 6.0f);
    const B left = one - u, right = two - u, far = one + u;
    const B of[4] = {-sixth * u * left * right, half * far * left * right, half * u * far * right,
                     -sixth * u * far * left};
    const B square = u * u, rate = one / B (spacing);
    const B of_slope[4] = {sixth * (B (-2.0f) + u * B (6.0f) - B (3.0f) * square) * rate,
                           half * (-one - B (4.0f) * u + B (3.0f) * square) * rate,
                           half * (two + two * u - B (3.0f) * square) * rate,
                           sixth * (B (-1.0f) + B (3.0f) * square) * rate};
    float cells[B::size];
    cell.store_unaligned (cells);
    float low = cells[0], high = cells[0];
    for (const float c : cells)
    {
      low = c < low ? c : low;
      high = c > high ? c : high;
    }
    low -= 1.0f;
    high += 3.0f;
    begin_ = low > 0.0f ? static_cast<std::size_t> (low) : 0;
    end_ = high < static_cast<float> (points) ? static_cast<std::size_t> (high > 0.0f ? high : 0.0f) : points;
    end_ = end_ < begin_ + MOST ? end_ : begin_ + MOST;
    for (std::size_t i = begin_; i < end_; ++i)
    {
      const B step = B (static_cast<float> (i)) - cell;
      B weight (0.0f), slope (0.0f);
      for (int k = 0; k < 4; ++k)
      {
        const auto is_it = step == B (static_cast<float> (k - 1));
        weight = xsimd::select (is_it, of[k], weight);
        slope = xsimd::select (is_it, of_slope[k], slope);
      }
      weights_[i - begin_] = weight;
      slopes_[i - begin_] = slope;
    }
  }

  std::size_t
  begin () const
  {
    return begin_;
  }

  std::size_t
  end () const
  {
    return end_;
  }

  B
  weight (std::size_t i) const
  {
    return weights_[i - begin_];
  }

  B
  slope (std::size_t i) const
  {
    return slopes_[i - begin_];
  }

private:
  std::size_t begin_ = 0, end_ = 0;
  B weights_[MOST], slopes_[MOST];
};

} // namespace erkpa::lanes
