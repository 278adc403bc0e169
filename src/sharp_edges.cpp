// SPDX-License-Identifier: BSD-3-Clause
#include "sharp_edges.h"

#include "mesh_graph.h"
#include "noise.h"
#include "threads.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace erkpa
{

namespace
{

constexpr double DEGREES = M_PI / 180.0;

/** \brief Sets of separations of the same two faces that follow each other: one crease or wall each. */
DisjointSets
chainSeparations (const std::vector<Separation> &separations, double step)
{
  std::vector<Eigen::Vector3f> positions;
  for (const Separation &separation : separations)
    positions.push_back (separation.position);
  DisjointSets chains (separations.size ());
  if (positions.empty ())
    return chains;
  const NeighborSearch::ConstPtr search = makeKdTreeSearch (positions);
  std::vector<int> found;
  std::vector<float> squared;
  for (std::size_t i = 0; i < positions.size (); ++i)
  {
    search->withinRadius (positions[i], step, found, squared);
    for (const int j : found)
      if (separations[static_cast<std::size_t> (j)].face == separations[i].face &&
          separations[static_cast<std::size_t> (j)].other == separations[i].other)
        chains.unite (static_cast<int> (i), j);
  }
  return chains;
}

/** \brief How far a set of places extends, along its longest side. */
std::map<int, float>
lengthsOf (const std::vector<Separation> &separations, DisjointSets &chains)
{
  std::map<int, std::pair<Eigen::Vector3f, Eigen::Vector3f>> boxes;
  for (std::size_t i = 0; i < separations.size (); ++i)
  {
    const Eigen::Vector3f &p = separations[i].position;
    auto &box = boxes.try_emplace (chains.find (static_cast<int> (i)), p, p).first->second;
    box.first = box.first.cwiseMin (p);
    box.second = box.second.cwiseMax (p);
  }
  std::map<int, float> lengths;
  for (const auto &[chain, box] : boxes)
    lengths[chain] = (box.second - box.first).norm ();
  return lengths;
}

} // namespace

FoundFaces
findFaces (const OrientedPoints &points, const NeighborSearch &search, const SharpOptions &options, int threads)
{
  const int k = chooseSupportSize (points, search);
  SegmentationOptions segmentation;
  segmentation.spacing = measureSpacing (points.positions, search);
  segmentation.angle = options.angle * DEGREES;
  const bool noisy = k > CLEAN_SUPPORT;
  segmentation.chord = noisy ? 1.2 * segmentation.spacing : 0.0;
  segmentation.ball = noisy ? 160 : 64;
  segmentation.smallest = noisy ? 8 : 2;
  segmentation.separation_reach = segmentation.spacing * std::sqrt (k / M_PI);
  const FaceSegmentation found = segmentFaces (points, search, segmentation, threads);

  FoundFaces result;
  result.faces = found.faces;
  result.count = found.count;
  const double shortest = (noisy ? 4.0 : 2.0) * segmentation.spacing;
  DisjointSets chains = chainSeparations (found.separations, segmentation.link_reach * segmentation.spacing);
  std::map<int, float> lengths = lengthsOf (found.separations, chains);
  std::map<int, int> numbers;
  std::vector<int> nearest;
  std::vector<float> squared;
  for (std::size_t i = 0; i < found.separations.size (); ++i)
  {
    const int chain = chains.find (static_cast<int> (i));
    if (lengths[chain] < shortest)
      continue;
    const int surface = numbers.try_emplace (chain, static_cast<int> (numbers.size ())).first->second;
    const Separation &separation = found.separations[i];
    search.nearestK (separation.position, k, nearest, squared);
    const double reach = std::sqrt (static_cast<double> (*std::max_element (squared.begin (), squared.end ())));
    result.separations.push_back ({separation.position, separation.face, separation.other, surface, 1.1 * reach});
  }
  return result;
}

} // namespace erkpa
