// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_terms.h"
#include "lane_vector.h"
#include "lanes.h"

namespace erkpa::lanes
{

/** \brief FaceVote::electTree () with a voter in each lane: how far from zero the value of each tree is at all of them
 * together. */
template <typename B, Basis BASIS>
class LaneElection
{
public:
  explicit LaneElection (const FaceFits &fits) : fits_ (fits)
  {
    for (std::size_t face = 0; face < fits.count; ++face)
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
      B heights[FaceFits::MAX];
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
    for (std::size_t face = 0; face < fits_.count; ++face)
    {
      B u[3], R[SIZE];
      for (std::size_t a = 0; a < 3; ++a)
        u[a] = B::load_unaligned (voters.u[a] + first) * B (fits_.scale[face]);
      Terms<B, BASIS>::evaluate (u, dot (u, u), R);
      heights[face] = combine<Terms<B, BASIS>> (coefficients_[face], R);
    }
  }

  B
  valueOf (const Trees::Step *steps, const B *heights) const
  {
    B best[FaceFits::MAX];
    for (std::size_t face = 0; face < fits_.count; ++face)
      best[face] = heights[face];
    std::size_t last = 0;
    for (std::size_t s = 0; s + 1 < fits_.count; ++s)
    {
      last = steps[s].face;
      const B other = best[steps[s].other];
      best[last] = steps[s].larger ? xsimd::max (best[last], other) : xsimd::min (best[last], other);
    }
    return best[last];
  }

  const FaceFits &fits_;
  B coefficients_[FaceFits::MAX][SIZE];
};

/** \brief What an Engine does, in vectors of one instruction set. */
template <typename ArchT>
void
measureTrees (const Voters &voters, const FaceFits &fits, const Trees &trees, float *distances)
{
  using B = xsimd::batch<float, ArchT>;
  switch (fits.basis)
  {
    case Basis::CONSTANT:
      LaneElection<B, Basis::CONSTANT> (fits).measure (voters, trees, distances);
      break;
    case Basis::LINEAR:
      LaneElection<B, Basis::LINEAR> (fits).measure (voters, trees, distances);
      break;
    case Basis::SPHERICAL:
      LaneElection<B, Basis::SPHERICAL> (fits).measure (voters, trees, distances);
      break;
    case Basis::QUADRATIC:
      LaneElection<B, Basis::QUADRATIC> (fits).measure (voters, trees, distances);
      break;
  }
}

} // namespace erkpa::lanes
