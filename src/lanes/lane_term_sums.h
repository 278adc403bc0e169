// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_columns.h"
#include "lane_kinks.h"

#include <algorithm>

namespace erkpa::lanes
{

/** \brief The sums of eq. (17) in which terms of sharp surfaces are, for the functional values of eq. (2).
 *
 * Seen from one side of its surface, a term has the same value at a node for all lanes: like the products of
 * polynomials it is a column of numbers (see LaneColumns); where lanes see it from either side, it is two. A sum costs
 * one multiply-add per node, whatever it is of.
 */
template <typename B, Basis BASIS, typename ColumnsT, typename KinksT>
class LaneTermSums
{
public:
  /** \param[in] support of the points that the terms are seen from */
  LaneTermSums (const KinksT &kinks, const LaneSupport<B> &support) : kinks_ (kinks), support_ (support)
  {
    kinks.visitViews (
        [this] (int term, bool from_behind)
        {
          view_of_[term][from_behind ? 1 : 0] = views_;
          list_[views_++] = {term, from_behind};
        });
    for (int v = 0; v < views_; ++v)
      for (int c = 0; c < PER_VIEW; ++c)
        addProduct (FIRST_VIEW + v, c);
    for (int v = 0; v < views_; ++v)
      for (int other = 0; other <= v; ++other)
        addProduct (FIRST_VIEW + v, FIRST_VIEW + other);
    for (int side = 0; side < 2 * kinks.surfaces (); ++side)
      addProduct (FIRST_VIEW + views_ + side, 0);
    std::fill_n (sums_, products_ + TOGETHER, B (0.0f));
  }

  /** \brief Add what a chunk of the support's nodes brings.
   * \param[in] columns with their weights
   */
  void
  add (const ColumnsT &columns, std::size_t first, std::size_t count)
  {
    fillFactors (columns, first, count);
    for (int p = 0; p < products_; p += TOGETHER)
    {
      for (int c = 0; c < std::min (TOGETHER, products_ - p); ++c)
        for (std::size_t i = 0; i < count; i += B::size)
          (B::load_unaligned (factors_[factor_[p + c]] + i) * B::load_unaligned (factors_[other_[p + c]] + i))
              .store_unaligned (of_nodes_[c] + i);
      B added[TOGETHER];
      for (int c = 0; c < TOGETHER; ++c)
        added[c] = sums_[p + c];
      for (std::size_t i = 0; i < count; ++i)
      {
        const B weight = columns.weight (i);
#pragma GCC unroll 8
        for (int c = 0; c < TOGETHER; ++c)
          added[c] = xsimd::fma (weight, B (of_nodes_[c][i]), added[c]);
      }
      for (int c = 0; c < TOGETHER; ++c)
        sums_[p + c] = added[c];
    }
  }

  /** \brief What a term shares with the polynomials in x_i - x.
   * \param[in] shift x from the origin of the columns
   * \param[out] products Σ w term R, SIZE of them
   */
  void
  withPolynomials (int term, const B *shift, B *products) const
  {
    for (int j = 0; j < SIZE; ++j)
      products[j] = seen (term, [&] (int v) { return sums_[PER_VIEW * v + j]; });
    TermsT::shift (shift, products);
  }

  /** \brief Σ w term h: see LaneMoments::addHeights (). */
  B
  withHeight (int term, const B *shift) const
  {
    return seen (term,
                 [&] (int v)
                 {
                   B sum = sums_[PER_VIEW * v + SIZE];
                   for (int a = 0; a < 3; ++a)
                     sum = xsimd::fma (shift[a], sums_[PER_VIEW * v + SIZE + 1 + a], sum);
                   return sum;
                 });
  }

  /** \brief Σ w term other; \a other is none that comes after \a term. */
  B
  withTerm (int term, int other) const
  {
    return seen (term,
                 [&] (int v) {
                   return seen (other, [&] (int w)
                                { return sums_[PER_VIEW * views_ + at (std::max (v, w), std::min (v, w))]; });
                 });
  }

  /** \brief The weight of the nodes on a side of a surface. */
  B
  onSide (int surface, bool is_below) const
  {
    return sums_[PER_VIEW * views_ + at (views_, 0) + 2 * surface + (is_below ? 0 : 1)];
  }

private:
  using TermsT = Terms<B, BASIS>;
  static constexpr int SIZE = TermsT::SIZE, TOGETHER = 8;
  static constexpr int PER_VIEW = SIZE + 4;   // with polynomials, level and normal
  static constexpr int FIRST_VIEW = PER_VIEW; // of factors: these come first
  static constexpr int MAX_VIEWS = 2 * KinksT::MAX_TERMS, MAX_SIDES = 2 * KinksT::MAX_COUNT;
  static constexpr int MAX_PRODUCTS = PER_VIEW * MAX_VIEWS + at (MAX_VIEWS, 0) + MAX_SIDES;
  static constexpr std::size_t CHUNK = ColumnsT::CHUNK;

  /** \brief A term as it is seen from one side. */
  struct View
  {
    int term;
    bool from_behind;
  };

  void
  addProduct (int factor, int other)
  {
    factor_[products_] = factor;
    other_[products_++] = other;
  }

  /** \brief What nodes have: polynomials, level, normal, then the terms, and the sides of surfaces. */
  void
  fillFactors (const ColumnsT &columns, std::size_t first, std::size_t count)
  {
    for (int j = 0; j < SIZE; ++j)
      factors_[j] = columns.of_nodes[j];
    factors_[SIZE] = columns.levels;
    for (std::size_t a = 0; a < 3; ++a)
      factors_[SIZE + 1 + a] = support_.near (LaneSupport<B>::NORMAL + a) + first;
    for (int v = 0; v < views_; ++v)
    {
      if (list_[v].term >= kinks_.surfaces ())
        for (std::size_t i = 0; i < count; ++i)
          own_[v][i] = kinks_.valueAtNode (list_[v].term, list_[v].from_behind, support_.node (first + i));
      factors_[FIRST_VIEW + v] = own_[v];
    }
    for (int s = 0; s < kinks_.surfaces (); ++s)
      fillSurface (s, first, count);
  }

  /** \brief The views and sides of a surface. */
  void
  fillSurface (int surface, std::size_t first, std::size_t count)
  {
    float thetas[CHUNK] = {}; // whole vectors of them are read
    for (std::size_t i = 0; i < count; ++i)
      thetas[i] = kinks_.thetaAtNode (surface, support_.node (first + i));
    float *const below = own_[views_ + 2 * surface], *const above = own_[views_ + 2 * surface + 1];
    factors_[FIRST_VIEW + views_ + 2 * surface] = below;
    factors_[FIRST_VIEW + views_ + 2 * surface + 1] = above;
    const B zero (0.0f), one (1.0f);
    for (std::size_t i = 0; i < count; i += B::size)
    {
      const B theta = B::load_unaligned (thetas + i);
      xsimd::select (theta < zero, one, zero).store_unaligned (below + i);
      xsimd::select (theta > zero, one, zero).store_unaligned (above + i);
      for (const bool from_behind : {false, true})
        if (kinks_.isSeen (surface, from_behind))
          KinksT::valueAt (theta, from_behind).store_unaligned (own_[view_of_[surface][from_behind ? 1 : 0]] + i);
    }
  }

  /** \brief What of (view) says of the side from which each lane sees a term. */
  template <typename OfT>
  B
  seen (int term, OfT of) const
  {
    const bool from_front = kinks_.isSeen (term, false), from_behind = kinks_.isSeen (term, true);
    if (from_front && from_behind)
      return xsimd::select (kinks_.isBehind (term), of (view_of_[term][1]), of (view_of_[term][0]));
    return of (view_of_[term][from_behind ? 1 : 0]);
  }

  const KinksT &kinks_;
  const LaneSupport<B> &support_;
  int views_ = 0, products_ = 0;
  View list_[MAX_VIEWS];
  int view_of_[KinksT::MAX_TERMS][2]; // by term, and whether from behind
  int factor_[MAX_PRODUCTS], other_[MAX_PRODUCTS];
  const float *factors_[PER_VIEW + MAX_VIEWS + MAX_SIDES];
  float own_[MAX_VIEWS + MAX_SIDES][CHUNK]; // of them
  float of_nodes_[TOGETHER][CHUNK] = {};    // products
  B sums_[MAX_PRODUCTS + TOGETHER];
};

} // namespace erkpa::lanes
