// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_columns.h"
#include "lane_products.h"
#include "lane_reach.h"
#include "lane_system.h"

#include <algorithm>

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
  using ColumnsT = LaneColumns<B, BASIS, CONSTRAINT, KernelT>;

  /** \brief At most so many supports are summed up at once. */
  static constexpr std::size_t SHARED = 4;

  explicit LaneMoments (const Settings &settings) : settings_ (settings), columns_ (settings) {}

  /** \brief Whether sums about the origin serve all points of a support. */
  static bool
  isNear (const LaneSupport<B> &support)
  {
    return !xsimd::any (distanceFrom (ORIGIN, support) > farthest (support));
  }

  /** \brief Sum up for one support that isNear ().
   * \param[in] take take (columns, first, count) is told of each chunk of its nodes
   */
  template <typename TakeT>
  void
  sum (const LaneSupport<B> &support, TakeT take)
  {
    reaches_[0] = LaneReach<B> (settings_, support.radius (), support.squaredRadius ());
    sumAbout (ORIGIN, &support, 1, reaches_, take);
    bringToPoint (support, sums_[0], systems_[0]);
  }

  /** \brief Sum up, and count the nodes, for so many supports with one list of nodes. */
  void
  sum (const LaneSupport<B> *supports, std::size_t count)
  {
    for (std::size_t s = 0; s < count; ++s)
      reaches_[s] = LaneReach<B> (settings_, supports[s].radius (), supports[s].squaredRadius ());
    sumAbout (ORIGIN, supports, count, reaches_, NOTHING);
    for (std::size_t s = 0; s < count; ++s)
      bringToPoint (supports[s], sums_[s], systems_[s]);
    for (std::size_t s = 0; s < count; ++s)
      if (const auto is_far = distanceFrom (ORIGIN, supports[s]) > farthest (supports[s]); xsimd::any (is_far))
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
  static constexpr float ORIGIN[3] = {0.0f, 0.0f, 0.0f};
  static constexpr auto NOTHING = [] (const ColumnsT &, std::size_t, std::size_t) {};
  static constexpr int SIZE = TermsT::SIZE, SLOPES = ColumnsT::SLOPES, COLUMNS = ColumnsT::COLUMNS;
  static constexpr std::size_t WIDTH = B::size, CHUNK = ColumnsT::CHUNK;

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
      sumAbout (origin, &support, 1, &counted_again, NOTHING);
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

  template <typename TakeT>
  void
  sumAbout (const float *origin, const LaneSupport<B> *supports, std::size_t count, LaneReach<B> *reaches, TakeT take)
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
      columns_.fill (origin, supports[0], first, nodes);
      for (std::size_t s = 0; s < count; ++s)
      {
        columns_.weigh (supports[s], first, nodes, reaches[s]);
        columns_.template addTo<0, COLUMNS> (nodes, columns_.of_nodes, sums_[s].columns);
        addHeights (supports[s], first, nodes, sums_[s]);
        take (columns_, first, nodes);
      }
    }
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
      B height (columns_.levels[i]);
      if constexpr (CONSTRAINT == Constraint::FUNCTIONAL)
        for (int a = 0; a < 3; ++a)
          height = xsimd::fma (shift[a], B (normals[a][i]), height); // eq. (2)
      const B weighted = columns_.weight (i) * height;
      for (int j = 0; j < SIZE; ++j)
        added[j] = xsimd::fma (weighted, B (columns_.of_nodes[j][i]), added[j]);
    }
    for (int j = 0; j < SIZE; ++j)
      sums.heights[j] = added[j];
  }

  /** \brief From y_i = x_i - origin to x_i - x: b <- T b, and M as well. */
  static void
  bringToPoint (const LaneSupport<B> &support, const Sums &sums, SystemT &system)
  {
    B slopes[SIZE], heights[SIZE];
    shiftProducts<TermsT> (sums.shift, sums.columns, system.M);
    for (int j = 0; j < SIZE; ++j)
    {
      slopes[j] = SLOPES > 0 && j > 0 ? sums.columns[ColumnsT::PRODUCTS.count + j - 1] : B (0.0f);
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
  ColumnsT columns_;
};

} // namespace erkpa::lanes
