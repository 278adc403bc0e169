// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_products.h"
#include "lane_reach.h"
#include "lane_support.h"
#include "lane_weights.h"

#include <algorithm>
#include <type_traits>

namespace erkpa::lanes
{

/** \brief What a chunk of nodes brings into the sums of eq. (17), and its weights.
 *
 * About an origin that the lanes share, a node brings the same products of terms to each of them: they are columns of
 * numbers, and a sum is that of weights times numbers.
 */
template <typename B, Basis BASIS, Constraint CONSTRAINT, template <typename> class KernelT>
class LaneColumns
{
public:
  using TermsT = Terms<B, BASIS>;
  static constexpr ProductTable<TermsT> PRODUCTS{};
  static constexpr int SIZE = TermsT::SIZE;
  static constexpr int SLOPES = CONSTRAINT == Constraint::HERMITE ? SIZE - 1 : 0;
  static constexpr int COLUMNS = PRODUCTS.count + SLOPES;
  static constexpr std::size_t WIDTH = B::size, CHUNK = 64;

  explicit LaneColumns (const Settings &settings) : settings_ (settings) {}

  /** \brief What the nodes of a chunk bring, so many of them at once as there are lanes. */
  void
  fill (const float *origin, const LaneSupport<B> &support, std::size_t first, std::size_t count)
  {
    const float *const lambda = support.near (LaneSupport<B>::LAMBDA);
    for (std::size_t i = 0; i < count; i += WIDTH)
    {
      B u[3], n[3], R[SIZE];
      for (std::size_t a = 0; a < 3; ++a)
      {
        u[a] = B::load_unaligned (support.near (a) + first + i) - B (origin[a]);
        n[a] = B::load_unaligned (support.near (LaneSupport<B>::NORMAL + a) + first + i);
      }
      TermsT::evaluate (u, dot (u, u), R);
      for (int p = 0; p < PRODUCTS.count; ++p)
        (p < SIZE ? R[p] : R[PRODUCTS.first[p]] * R[PRODUCTS.second[p]]).store_unaligned (of_nodes[p] + i);
      if constexpr (CONSTRAINT == Constraint::HERMITE)
        storeSlopes (u, n, i);
      B level = lambda != nullptr ? B::load_unaligned (lambda + first + i) : B (0.0f);
      if constexpr (CONSTRAINT == Constraint::FUNCTIONAL)
        level -= dot (u, n);
      level.store_unaligned (levels + i);
    }
  }

  /** \brief The weights of a chunk, from the distances. */
  void
  weigh (const LaneSupport<B> &support, std::size_t first, std::size_t count, LaneReach<B> &reach)
  {
    const LaneWeights<B, KernelT> weights (settings_, support);
    const std::size_t last = first + count, on_surface = std::clamp (support.onSurface (), first, last);
    LaneReach<B> counted = reach;
    float *to = of_weights_;
    const auto step = [&] (auto together, std::size_t &i, bool is_on_surface)
    {
      constexpr std::size_t N = decltype (together)::value;
      weighSome<N> (support, weights, i, is_on_surface, counted, to);
      i += N;
      to += WIDTH * N;
    };
    std::size_t i = first;
    while (i + TOGETHER <= on_surface)
      step (std::integral_constant<std::size_t, TOGETHER> (), i, true);
    while (i + 2 <= on_surface)
      step (std::integral_constant<std::size_t, 2> (), i, true);
    while (i < on_surface)
      step (std::integral_constant<std::size_t, 1> (), i, true);
    if (i == support.onSurface ())
      counted.endOnSurface ();
    while (i < last)
      step (std::integral_constant<std::size_t, 1> (), i, false);
    reach = counted;
  }

  /** \brief Of the i-th node of the chunk, in each lane. */
  B
  weight (std::size_t i) const
  {
    return B::load_unaligned (of_weights_ + WIDTH * i);
  }

  /** \brief Adds COUNT columns of a chunk from FIRST on to their sums, so many at once as there are registers. */
  template <int FIRST, int COUNT>
  void
  addTo (std::size_t count, const float (*columns)[CHUNK], B *sums) const
  {
    constexpr int NOW = SUMS_AT_ONCE<B, COUNT>;
    B added[NOW];
#pragma GCC unroll 32
    for (int c = 0; c < NOW; ++c)
      added[c] = sums[FIRST + c];
    for (std::size_t i = 0; i < count; ++i)
    {
      const B of_node = weight (i);
#pragma GCC unroll 32
      for (int c = 0; c < NOW; ++c)
        added[c] = xsimd::fma (of_node, B (columns[FIRST + c][i]), added[c]);
    }
#pragma GCC unroll 32
    for (int c = 0; c < NOW; ++c)
      sums[FIRST + c] = added[c];
    if constexpr (COUNT > NOW)
      addTo<FIRST + NOW, COUNT - NOW> (count, columns, sums);
  }

  float of_nodes[COLUMNS][CHUNK]; ///< products of terms, then ∂R n
  float levels[CHUNK];            ///< what nodes ask for at the origin: λ, or λ - y_i·n

private:
  static constexpr std::size_t TOGETHER = B::size == 16 ? 8 : 4; // nodes: operations on one wait for one another

  void
  storeSlopes (const B *u, const B *n, std::size_t i)
  {
    B slopes[SIZE];
    for (B &slope : slopes)
      slope = B (0.0f);
    TermsT::addNormal (B (1.0f), u, n, slopes);
    for (int j = 1; j < SIZE; ++j)
      slopes[j].store_unaligned (of_nodes[PRODUCTS.count + j - 1] + i);
  }

  template <std::size_t N>
  [[gnu::always_inline]] static void
  weighSome (const LaneSupport<B> &support, const LaneWeights<B, KernelT> &weights, std::size_t i, bool is_on_surface,
             LaneReach<B> &reach, float *of_weights)
  {
    B squared[N], t[N];
    support.template distances<N> (i, squared);
    for (std::size_t n = 0; n < N; ++n)
      t[n] = squared[n];
    weights.template stretch<N> (i, t);
    for (std::size_t n = 0; n < N; ++n)
      if (!is_on_surface)
        reach.countOffSurface (t[n]);
      else
        weights.areFlattened () ? reach.count (squared[n], t[n]) : reach.count (squared[n]);
    weights.template shares<N> (t, t);
    weights.template weights<N> (i, t);
    for (std::size_t n = 0; n < N; ++n)
      t[n].store_unaligned (of_weights + WIDTH * n);
  }

  const Settings &settings_;
  float of_weights_[CHUNK * WIDTH];
};

} // namespace erkpa::lanes
