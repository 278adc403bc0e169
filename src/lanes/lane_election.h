// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_terms.h"
#include "lane_vector.h"
#include "lanes.h"

namespace erkpa::lanes
{

/** \brief FaceVote::electTree () with a voter in each lane: how far from zero the value of each tree is at all of them
 * together.
 * \tparam FACES number of them
 */
template <typename B, Basis BASIS, std::size_t FACES>
class LaneElection
{
public:
  explicit LaneElection (const FaceFits &fits) : fits_ (fits)
  {
    for (std::size_t face = 0; face < FACES; ++face)
      for (int j = 0; j < SIZE; ++j)
        coefficients_[face][j] = B (fits.coefficients[face][j]);
  }

  void
  measure (const Voters &voters, const Trees &trees, float *distances) const
  {
    B sums[Trees::MAX];
    for (std::size_t tree = 0; tree < trees.count; ++tree)
      sums[tree] = B (0.0f);
    for (std::size_t first = 0; first < voters.count; first += B::size)
    {
      B heights[FACES];
      findHeights (voters, first, heights);
      const B weight = B::load_unaligned (voters.weight + first);
      for (std::size_t tree = 0; tree < trees.count; ++tree)
        sums[tree] = xsimd::fma (weight, xsimd::abs (valueOf (trees.steps[tree], heights)), sums[tree]);
    }
    for (std::size_t tree = 0; tree < trees.count; ++tree)
    {
      float lanes[B::size];
      sums[tree].store_unaligned (lanes);
      distances[tree] = 0.0f;
      for (const float lane : lanes)
        distances[tree] += lane;
    }
  }

private:
  static constexpr int SIZE = Terms<B, BASIS>::SIZE;

  void
  findHeights (const Voters &voters, std::size_t first, B *heights) const
  {
    for (std::size_t face = 0; face < FACES; ++face)
    {
      B u[3], R[SIZE];
      for (std::size_t a = 0; a < 3; ++a)
        u[a] = B::load_unaligned (voters.u[a] + first) * B (fits_.scale[face]);
      Terms<B, BASIS>::evaluate (u, dot (u, u), R);
      heights[face] = combine<Terms<B, BASIS>> (coefficients_[face], R);
    }
  }

  static B
  valueOf (const Trees::Step *steps, const B *heights)
  {
    if constexpr (FACES == 2) // by far the most
      return steps[0].larger ? xsimd::max (heights[0], heights[1]) : xsimd::min (heights[0], heights[1]);
    B best[FACES];
    for (std::size_t face = 0; face < FACES; ++face)
      best[face] = heights[face];
    std::size_t last = 0;
    for (std::size_t s = 0; s + 1 < FACES; ++s)
    {
      last = steps[s].face;
      const B other = best[steps[s].other];
      best[last] = steps[s].larger ? xsimd::max (best[last], other) : xsimd::min (best[last], other);
    }
    return best[last];
  }

  const FaceFits &fits_;
  B coefficients_[FACES][SIZE];
};

template <typename B, Basis BASIS>
void
measureTrees (const Voters &voters, const FaceFits &fits, const Trees &trees, float *distances)
{
  if (fits.count == 2)
    LaneElection<B, BASIS, 2> (fits).measure (voters, trees, distances);
  else if (fits.count == 3)
    LaneElection<B, BASIS, 3> (fits).measure (voters, trees, distances);
  else
    LaneElection<B, BASIS, FaceFits::MAX> (fits).measure (voters, trees, distances);
}

/** \brief What an Engine does, in vectors of one instruction set. */
template <typename ArchT>
void
measureTrees (const Voters &voters, const FaceFits &fits, const Trees &trees, float *distances)
{
  using B = xsimd::batch<float, ArchT>;
  switch (fits.basis)
  {
    case Basis::CONSTANT:
      measureTrees<B, Basis::CONSTANT> (voters, fits, trees, distances);
      break;
    case Basis::LINEAR:
      measureTrees<B, Basis::LINEAR> (voters, fits, trees, distances);
      break;
    case Basis::SPHERICAL:
      measureTrees<B, Basis::SPHERICAL> (voters, fits, trees, distances);
      break;
    case Basis::QUADRATIC:
      measureTrees<B, Basis::QUADRATIC> (voters, fits, trees, distances);
      break;
  }
}

} // namespace erkpa::lanes
