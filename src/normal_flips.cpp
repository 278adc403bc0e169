// SPDX-License-Identifier: BSD-3-Clause
#include "normal_flips.h"

#include "found_nodes.h"
#include "normal_smoothing.h"
#include "threads.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace erkpa
{

namespace
{

bool
isFlipped (const NeighborSearch &search, const OrientedPoints &points, std::size_t i, FoundNodes &found)
{
  constexpr int NEIGHBORS = 12, FEWEST = 6, AGAINST_ONE = 4; // neighbours that speak against the normal
  constexpr float LEVEL = 0.2f;                              // height over distance, on curved surfaces, too
  constexpr float ALIKE = 0.7f;                              // cosine
  const Eigen::Vector3f &position = points.positions[i], &normal = points.normals[i];
  search.nearestK (position, NEIGHBORS + 1, found.nodes, found.squared);
  int with = 0, against = 0;
  for (const int node : found.nodes)
  {
    const auto j = static_cast<std::size_t> (node);
    const Eigen::Vector3f d = points.positions[j] - position;
    if (j == i || std::abs (d.dot (normal)) > LEVEL * d.norm ())
      continue;
    const float turn = normal.dot (points.normals[j]);
    with += turn > ALIKE ? 1 : 0;
    against += turn < -ALIKE ? 1 : 0;
  }
  return against >= FEWEST && against > AGAINST_ONE * with;
}

/** \brief Which of some points have flipped normals. */
std::vector<char>
findFlipped (const NeighborSearch &search, const OrientedPoints &points, const std::vector<std::size_t> &of,
             int threads)
{
  std::vector<char> flipped (of.size ());
  parallelFor (
      of.size (), threads, [] { return FoundNodes (); },
      [&] (FoundNodes &found, std::size_t s) { flipped[s] = isFlipped (search, points, of[s], found) ? 1 : 0; });
  return flipped;
}

} // namespace

std::size_t
turnFlippedNormals (const NeighborSearch &search, int threads, OrientedPoints &points)
{
  constexpr std::ptrdiff_t FEW = 2; // in a sample: most clouds have none, and need not be searched through
  const auto count = [] (const std::vector<char> &flipped) { return std::count (flipped.begin (), flipped.end (), 1); };
  std::vector<std::size_t> nodes = spreadSample (points.size ());
  if (count (findFlipped (search, points, nodes, threads)) < FEW)
    return 0;
  nodes.resize (points.size ());
  for (std::size_t i = 0; i < nodes.size (); ++i)
    nodes[i] = i;
  const std::vector<char> flipped = findFlipped (search, points, nodes, threads);
  for (std::size_t i = 0; i < nodes.size (); ++i)
    if (flipped[i] != 0)
      points.normals[i] = -points.normals[i];
  return static_cast<std::size_t> (count (flipped));
}

} // namespace erkpa
