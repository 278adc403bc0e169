// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_products.h"
#include "lane_reach.h"
#include "lane_system.h"
#include "lane_weights.h"

#include <algorithm>
#include <type_traits>

namespace erkpa::lanes
{

/** \brief M and b of eq. (17), summed over the nodes, in x_i - x.
 *
 * About an origin that the lanes share, a node brings the same products of terms to each of them, times its weight
 * there: a sum costs one multiply-add per node, and the products are made for many nodes at once. From the origin to x
 * terms are shifted (Terms::shift), which costs digits where x lies many ε from it: such lanes are summed up once more,
 * about themselves.
 */
template <typename B, Basis BASIS, Constraint CONSTRAINT, template <typename> class KernelT>
class LaneMoments
{
public:
  using TermsT = Terms<B, BASIS>;
  using SystemT = LaneSystem<TermsT, B>;

  /** \brief At most so many supports are summed up at once. */
  static constexpr std::size_t SHARED = 4;

  explicit LaneMoments (const Settings &settings) : settings_ (settings) {}

  /** \brief Sum up, and count the nodes, for so many supports with one list of nodes. */
  void
  sum (const LaneSupport<B> *supports, std::size_t count)
  {
    for (std::size_t s = 0; s < count; ++s)
      reaches_[s] = LaneReach<B> (settings_, supports[s].radius (), supports[s].squaredRadius ());
    const float middle[3] = {0.0f, 0.0f, 0.0f};
    sumAbout (middle, supports, count, reaches_);
    for (std::size_t s = 0; s < count; ++s)
      bringToPoint (supports[s], sums_[s], systems_[s]);
    for (std::size_t s = 0; s < count; ++s)
      if (const auto is_far = distanceFrom (middle, supports[s]) > farthest (supports[s]); xsimd::any (is_far))
        sumLeft (supports[s], xsimd::select (is_far, B (1.0f), B (0.0f)), systems_[s]);
  }

  /** \brief Of one of the supports. */
  const LaneReach<B> &
  reach (std::size_t s) const
  {
    return reaches_[s];
  }

  SystemT &
  system (std::size_t s)
  {
    return systems_[s];
  }

private:
  static constexpr int SIZE = TermsT::SIZE;
  static constexpr ProductTable<TermsT> PRODUCTS{};
  static constexpr int SLOPES = CONSTRAINT == Constraint::HERMITE ? SIZE - 1 : 0;
  static constexpr int COLUMNS = PRODUCTS.count + SLOPES;
  static constexpr std::size_t WIDTH = B::size, CHUNK = 64;
  static constexpr std::size_t TOGETHER =
      B::size == 16 ? 8 : 4; // nodes, for each of which operations wait for one another

  /** \brief What is summed up for a vector of points. */
  struct Sums
  {
    B shift[3]; // x - origin
    B columns[COLUMNS], heights[SIZE];
  };

  /** \brief The square of how far from the origin a point may lie. */
  static B
  farthest (const LaneSupport<B> &support)
  {
    constexpr float FAR = 2.5f;
    return B (FAR * FAR) * support.squaredRadius ();
  }

  static B
  distanceFrom (const float *origin, const LaneSupport<B> &support)
  {
    B from[3];
    for (int a = 0; a < 3; ++a)
      from[a] = support.x (a) - B (origin[a]);
    return dot (from, from);
  }

  /** \brief The lanes that are left, about one of them after the other. */
  void
  sumLeft (const LaneSupport<B> &support, B is_left, SystemT &system)
  {
    float left[WIDTH], x[3][WIDTH];
    for (int a = 0; a < 3; ++a)
      support.x (a).store_unaligned (x[a]);
    while (xsimd::any (is_left > B (0.5f)))
    {
      is_left.store_unaligned (left);
      const std::size_t lane = static_cast<std::size_t> (std::find (left, left + WIDTH, 1.0f) - left);
      const float origin[3] = {x[0][lane], x[1][lane], x[2][lane]};
      LaneReach<B> counted_again (settings_, support.radius (), support.squaredRadius ());
      sumAbout (origin, &support, 1, &counted_again);
      SystemT there;
      bringToPoint (support, sums_[0], there);
      const auto is_taken = is_left > B (0.5f) && (distanceFrom (origin, support) <= farthest (support));
      for (int m = 0; m < SystemT::MOMENTS; ++m)
        system.M[m] = xsimd::select (is_taken, there.M[m], system.M[m]);
      for (int j = 0; j < SIZE; ++j)
        system.b[j] = xsimd::select (is_taken, there.b[j], system.b[j]);
      is_left = xsimd::select (is_taken, B (0.0f), is_left);
    }
  }

  void
  sumAbout (const float *origin, const LaneSupport<B> *supports, std::size_t count, LaneReach<B> *reaches)
  {
    for (std::size_t s = 0; s < count; ++s)
    {
      for (int a = 0; a < 3; ++a)
        sums_[s].shift[a] = supports[s].x (a) - B (origin[a]);
      for (B &sum : sums_[s].columns)
        sum = B (0.0f);
      for (B &sum : sums_[s].heights)
        sum = B (0.0f);
    }
    for (std::size_t first = 0; first < supports[0].size (); first += CHUNK)
    {
      const std::size_t nodes = std::min (CHUNK, supports[0].size () - first);
      fillColumns (origin, supports[0], first, nodes);
      for (std::size_t s = 0; s < count; ++s)
      {
        measure (supports[s], first, nodes, reaches[s]);
        addAll<0, COLUMNS> (nodes, sums_[s].columns);
        addHeights (supports[s], first, nodes, sums_[s]);
      }
    }
  }

  /** \brief The weights of a chunk, from the distances. */
  void
  measure (const LaneSupport<B> &support, std::size_t first, std::size_t count, LaneReach<B> &reach)
  {
    const LaneWeights<B, KernelT> weights (settings_, support);
    const std::size_t last = first + count, on_surface = std::clamp (support.onSurface (), first, last);
    LaneReach<B> counted = reach;
    float *to = of_weights_;
    const auto step = [&] (auto together, std::size_t &i, bool is_on_surface)
    {
      constexpr std::size_t N = decltype (together)::value;
      measureSome<N> (support, weights, i, is_on_surface, counted, to);
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

  template <std::size_t N>
  [[gnu::always_inline]] static void
  measureSome (const LaneSupport<B> &support, const LaneWeights<B, KernelT> &weights, std::size_t i, bool is_on_surface,
               LaneReach<B> &reach, float *of_weights)
  {
    B squared[N], t[N];
    support.template distances<N> (i, squared);
    for (std::size_t n = 0; n < N; ++n)
      is_on_surface ? reach.count (squared[n]) : reach.countOffSurface (squared[n]);
    weights.template shares<N> (squared, t);
    weights.template weights<N> (i, t);
    for (std::size_t n = 0; n < N; ++n)
      t[n].store_unaligned (of_weights + WIDTH * n);
  }

  /** \brief What the nodes of a chunk bring, so many of them at once as there are lanes. */
  void
  fillColumns (const float *origin, const LaneSupport<B> &support, std::size_t first, std::size_t count)
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
        (p < SIZE ? R[p] : R[PRODUCTS.first[p]] * R[PRODUCTS.second[p]]).store_unaligned (columns_[p] + i);
      if constexpr (CONSTRAINT == Constraint::HERMITE)
        storeSlopes (u, n, i);
      B level = lambda != nullptr ? B::load_unaligned (lambda + first + i) : B (0.0f);
      if constexpr (CONSTRAINT == Constraint::FUNCTIONAL)
        level -= dot (u, n);
      level.store_unaligned (levels_ + i);
    }
  }

  void
  storeSlopes (const B *u, const B *n, std::size_t i)
  {
    B slopes[SIZE];
    for (B &slope : slopes)
      slope = B (0.0f);
    TermsT::addNormal (B (1.0f), u, n, slopes);
    for (int j = 1; j < SIZE; ++j)
      slopes[j].store_unaligned (columns_[PRODUCTS.count + j - 1] + i);
  }

  /** \brief Adds the columns from FIRST on, so many at once as there are registers. */
  template <int FIRST, int COUNT>
  void
  addAll (std::size_t count, B *sums) const
  {
    constexpr int MOST = B::size == 16 ? 26 : 12, GROUPS = (COUNT + MOST - 1) / MOST;
    constexpr int NOW = (COUNT + GROUPS - 1) / GROUPS;
    B added[NOW];
#pragma GCC unroll 32
    for (int c = 0; c < NOW; ++c)
      added[c] = sums[FIRST + c];
    for (std::size_t i = 0; i < count; ++i)
    {
      const B weight = B::load_unaligned (of_weights_ + WIDTH * i);
#pragma GCC unroll 32
      for (int c = 0; c < NOW; ++c)
        added[c] = xsimd::fma (weight, B (columns_[FIRST + c][i]), added[c]);
    }
#pragma GCC unroll 32
    for (int c = 0; c < NOW; ++c)
      sums[FIRST + c] = added[c];
    if constexpr (COUNT > NOW)
      addAll<FIRST + NOW, COUNT - NOW> (count, sums);
  }

  /** \brief Σ w h R, where nodes ask for a height h: λ or, where their tangent planes are fitted, λ - (x_i - x)·n. */
  void
  addHeights (const LaneSupport<B> &support, std::size_t first, std::size_t count, Sums &sums) const
  {
    if (CONSTRAINT != Constraint::FUNCTIONAL && support.near (LaneSupport<B>::LAMBDA) == nullptr)
      return;
    const float *normals[3];
    for (std::size_t a = 0; a < 3; ++a)
      normals[a] = support.near (LaneSupport<B>::NORMAL + a) + first;
    B added[SIZE];
    for (int j = 0; j < SIZE; ++j)
      added[j] = sums.heights[j];
    const B shift[] = {sums.shift[0], sums.shift[1], sums.shift[2]};
    for (std::size_t i = 0; i < count; ++i)
    {
      B height (levels_[i]);
      if constexpr (CONSTRAINT == Constraint::FUNCTIONAL)
        for (int a = 0; a < 3; ++a)
          height = xsimd::fma (shift[a], B (normals[a][i]), height); // eq. (2)
      const B weighted = B::load_unaligned (of_weights_ + WIDTH * i) * height;
      for (int j = 0; j < SIZE; ++j)
        added[j] = xsimd::fma (weighted, B (columns_[j][i]), added[j]);
    }
    for (int j = 0; j < SIZE; ++j)
      sums.heights[j] = added[j];
  }

  /** \brief From y_i = x_i - origin to x_i - x: R (y - s) = T R (y), M <- T M T^T, b <- T b. */
  static void
  bringToPoint (const LaneSupport<B> &support, const Sums &sums, SystemT &system)
  {
    B full[SIZE][SIZE], slopes[SIZE], heights[SIZE];
    for (int i = 0; i < SIZE; ++i)
      for (int j = 0; j < SIZE; ++j)
        full[i][j] = sums.columns[PRODUCTS.column[i < j ? at (j, i) : at (i, j)]]; // symmetric
    for (auto &row : full)
      TermsT::shift (sums.shift, row);
    for (int j = 0; j < SIZE; ++j)
    {
      B column[SIZE];
      for (int i = 0; i < SIZE; ++i)
        column[i] = full[i][j];
      TermsT::shift (sums.shift, column);
      for (int i = j; i < SIZE; ++i)
        system.M[at (i, j)] = column[i];
      slopes[j] = SLOPES > 0 && j > 0 ? sums.columns[PRODUCTS.count + j - 1] : B (0.0f);
      heights[j] = sums.heights[j];
    }
    if constexpr (SLOPES > 0)
      TermsT::shift (sums.shift, slopes);
    TermsT::shift (sums.shift, heights);
    // The others are the products of gradients, a degree of two lower.
    const B of_heights = CONSTRAINT == Constraint::HERMITE ? support.inverse () * support.inverse () : B (1.0f);
    for (int j = 0; j < SIZE; ++j)
      system.b[j] = xsimd::fma (of_heights, heights[j], slopes[j]);
  }

  const Settings &settings_;
  LaneReach<B> reaches_[SHARED];
  Sums sums_[SHARED];
  SystemT systems_[SHARED];
  // Of a chunk:
  float of_weights_[CHUNK * WIDTH], columns_[COLUMNS][CHUNK], levels_[CHUNK];
};

} // namespace erkpa::lanes
