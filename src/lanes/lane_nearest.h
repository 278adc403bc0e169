// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_vector.h"

#include <cstddef>

namespace erkpa::lanes
{

/** \brief The k-th nearest node of the point in each lane, from the squared distances of the nodes.
 *
 * The number of nodes within a distance grows about as its square. Bounds close in on a square within which there are k
 * or little more, of which the largest ones tell the k-th; where many distances are equal, single steps from node to
 * node find it.
 */
template <typename B>
class LaneNearest
{
public:
  /** \param[in] rows a row for each node, its squared distances from the points */
  LaneNearest (const float *rows, std::size_t count, float k) : rows_ (rows), count_ (count), k_ (k) {}

  /** \brief How many of the rows are at most \a squared.
   *
   * In four sums, since one would wait for itself.
   */
  B
  countWithin (B squared) const
  {
    LaneCount<B> counts[4];
    std::size_t i = 0;
    for (; i + 4 <= count_; i += 4)
      for (std::size_t j = 0; j < 4; ++j)
        counts[j].add (row (i + j) <= squared);
    for (; i < count_; ++i)
      counts[0].add (row (i) <= squared);
    return (counts[0].count () + counts[1].count ()) + (counts[2].count () + counts[3].count ());
  }

  /** \param[in] bound squared distance within which the k-th is expected
   * \param[in] in_bound how many there are
   */
  void
  find (B bound, B in_bound)
  {
    constexpr int STEPS = 10, EVEN = 5;
    B low (0.0f), high = bound, in_low (0.0f), in_high = in_bound;
    const B k (k_), enough (k_ + static_cast<float> (LARGEST - 1)), wanted (k_ + 0.5f * static_cast<float> (LARGEST));
    for (int step = 0; step < STEPS && xsimd::any (in_high > enough); ++step)
    {
      const B share = step <= EVEN ? (wanted - in_low) / xsimd::max (in_high - in_low, B (1.0f)) : B (0.5f);
      const B between = xsimd::fma (xsimd::min (share, B (0.9f)), high - low, low);
      const B middle = xsimd::select (in_high > enough, between, high), count = countWithin (middle);
      const auto is_enough = count >= k;
      high = xsimd::select (is_enough, middle, high);
      in_high = xsimd::select (is_enough, count, in_high);
      low = xsimd::select (is_enough, low, middle);
      in_low = xsimd::select (is_enough, in_low, count);
    }
    found_ = in_high;
    squared_ = largestWithin (high, in_high - k);
    if (xsimd::any (in_high > enough))
      stepToKth (low, in_low, in_high > enough);
  }

  /** \brief The square of its distance; of the farthest node where there are fewer within the bound. */
  B
  squared () const
  {
    return squared_;
  }

  /** \brief At least k nodes, but for lanes where there are fewer within the bound: so many. */
  B
  found () const
  {
    return found_;
  }

private:
  static constexpr std::size_t WIDTH = B::size, LARGEST = 3;

  B
  row (std::size_t i) const
  {
    return B::load_unaligned (rows_ + WIDTH * i);
  }

  /** \brief The largest of the rows within a bound, or the next one, or that after it, by their number above. */
  B
  largestWithin (B bound, B above) const
  {
    static_assert (LARGEST == 3);
    B largest[LARGEST] = {B (0.0f), B (0.0f), B (0.0f)};
    for (std::size_t i = 0; i < count_; ++i)
    {
      B next = xsimd::select (row (i) <= bound, row (i), B (0.0f));
      for (B &one : largest)
      {
        const B less = xsimd::min (one, next);
        one = xsimd::max (one, next);
        next = less;
      }
    }
    const B of_two = xsimd::select (above > B (0.5f), largest[1], largest[0]);
    return xsimd::select (above > B (1.5f), largest[2], of_two);
  }

  template <typename MaskT>
  void
  stepToKth (B low, B in_low, MaskT open)
  {
    const B k (k_), far (3e38f);
    auto searching = open;
    low = xsimd::select (in_low > B (0.5f), low, B (-1.0f));
    for (std::size_t step = 0; step <= count_ && xsimd::any (searching); ++step)
    {
      B next = far;
      for (std::size_t i = 0; i < count_; ++i)
        next = xsimd::min (next, xsimd::select (row (i) > low, row (i), far));
      const auto reached = countWithin (next) >= k;
      squared_ = xsimd::select (searching && reached, next, squared_);
      searching = searching && !reached;
      low = next;
    }
  }

  const float *rows_;
  std::size_t count_;
  float k_;
  B squared_, found_;
};

} // namespace erkpa::lanes
