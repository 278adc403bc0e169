// SPDX-License-Identifier: BSD-3-Clause
#include "normal_flips.h"

#include "found_nodes.h"
#include "normal_smoothing.h"
#include "threads.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace erkpa
{

namespace
{

constexpr int NEIGHBORS = 12;

/** \brief What the neighbours of a point make of its normal. */
struct Opinion
{
  int with = 0, against = 0;   ///< of those on its level
  int alike = 0, opposite = 0; ///< of all
  int before = 0, behind = 0;  ///< where those lie that are opposite

  /** \brief Whether it looks the other way than nearly all of its neighbours, or than most of them. */
  bool
  isFlipped (NormalSigns signs) const
  {
    constexpr int FEWEST = 6, AGAINST_ONE = 4; // neighbours that speak against the normal
    return signs == NormalSigns::MANY_FLIPPED ? against > with : against >= FEWEST && against > AGAINST_ONE * with;
  }
};

Opinion
askNeighbors (const NeighborSearch &search, const OrientedPoints &points, std::size_t i, int neighbors,
              FoundNodes &found)
{
  constexpr float LEVEL = 0.2f; // height over distance, on curved surfaces, too
  constexpr float ALIKE = 0.7f; // cosine
  const Eigen::Vector3f &position = points.positions[i], &normal = points.normals[i];
  search.nearestK (position, neighbors + 1, found.nodes, found.squared);
  Opinion opinion;
  for (const int node : found.nodes)
  {
    const auto j = static_cast<std::size_t> (node);
    const float turn = normal.dot (points.normals[j]);
    if (j == i || std::abs (turn) <= ALIKE)
      continue;
    const bool is_opposite = turn < 0.0f;
    const Eigen::Vector3f d = points.positions[j] - position;
    const float height = d.dot (normal);
    ++(is_opposite ? opinion.opposite : opinion.alike);
    opinion.before += is_opposite && height > 0.0f ? 1 : 0;
    opinion.behind += is_opposite && height < 0.0f ? 1 : 0;
    if (std::abs (height) <= LEVEL * d.norm ())
      ++(is_opposite ? opinion.against : opinion.with);
  }
  return opinion;
}

/** \brief Ask about some points. */
std::vector<Opinion>
askAbout (const NeighborSearch &search, const OrientedPoints &points, const std::vector<std::size_t> &of, int neighbors,
          int threads)
{
  std::vector<Opinion> opinions (of.size ());
  parallelFor (
      of.size (), threads, [] { return FoundNodes (); },
      [&] (FoundNodes &found, std::size_t s) { opinions[s] = askNeighbors (search, points, of[s], neighbors, found); });
  return opinions;
}

} // namespace

NormalSigns
judgeSigns (const NeighborSearch &search, int threads, const OrientedPoints &points)
{
  constexpr int FEW = 2;                              // flipped ones in a sample
  constexpr double MANY = 0.08, CONTRADICTING = 0.36; // of all neighbours: 4 % are flipped, 23 %
  constexpr double ON_ONE_SIDE = 0.35;                // of the opposite ones: of walls nearly all are behind
  Opinion sum;
  int flipped = 0;
  for (const Opinion &opinion : askAbout (search, points, spreadSample (points.size ()), NEIGHBORS, threads))
  {
    flipped += opinion.isFlipped (NormalSigns::SINGLE_ONES_FLIPPED) ? 1 : 0;
    sum.alike += opinion.alike;
    sum.opposite += opinion.opposite;
    sum.before += opinion.before;
    sum.behind += opinion.behind;
  }
  const double share = static_cast<double> (sum.opposite) / std::max (1, sum.opposite + sum.alike);
  if (share > MANY && std::abs (sum.before - sum.behind) < ON_ONE_SIDE * sum.opposite)
    return share > CONTRADICTING ? NormalSigns::CONTRADICT : NormalSigns::MANY_FLIPPED;
  return flipped < FEW ? NormalSigns::AGREE : NormalSigns::SINGLE_ONES_FLIPPED;
}

std::size_t
turnFlippedNormals (const NeighborSearch &search, NormalSigns signs, int threads, OrientedPoints &points)
{
  const int neighbors = signs == NormalSigns::MANY_FLIPPED ? 2 * NEIGHBORS : NEIGHBORS;
  constexpr int PASSES = 8; // most are right after the first, the others where several are together
  std::vector<std::size_t> nodes (points.size ());
  std::iota (nodes.begin (), nodes.end (), std::size_t (0));
  const std::vector<Eigen::Vector3f> before = points.normals;
  bool is_done = false;
  for (int pass = 0; pass < PASSES && !is_done; ++pass)
  {
    const std::vector<Opinion> opinions = askAbout (search, points, nodes, neighbors, threads);
    is_done = true;
    for (std::size_t i = 0; i < nodes.size (); ++i)
      if (opinions[i].isFlipped (signs))
      {
        points.normals[i] = -points.normals[i];
        is_done = false;
      }
  }
  std::size_t turned = 0;
  for (std::size_t i = 0; i < nodes.size (); ++i)
    turned += points.normals[i].dot (before[i]) < 0.0f ? 1 : 0;
  return turned;
}

} // namespace erkpa
