// SPDX-License-Identifier: BSD-3-Clause
#include "separation_chains.h"

#include "point_grid.h"

#include <array>
#include <cmath>
#include <memory>
#include <unordered_set>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief Two faces and a cell of a grid. */
using SeparatedCell = std::array<long, 5>;

struct SeparatedCellHash
{
  std::size_t
  operator() (const SeparatedCell &cell) const
  {
    constexpr std::size_t ODD = 0x9e3779b97f4a7c15u; // Fibonacci hashing
    std::size_t hash = 0;
    for (const long number : cell)
      hash = (hash ^ static_cast<std::size_t> (number)) * ODD;
    return hash ^ hash >> 32;
  }
};

} // namespace

std::vector<Separation>
thinOut (const std::vector<Separation> &separations, double cell)
{
  std::unordered_set<SeparatedCell, SeparatedCellHash> taken (separations.size ());
  std::vector<Separation> thinned;
  for (const Separation &separation : separations)
  {
    const Eigen::Vector3f place = (separation.position / cell).array ().round ();
    const auto number = [&place] (int axis) { return std::lround (place[axis]); };
    if (taken.insert ({separation.face, separation.other, number (0), number (1), number (2)}).second)
      thinned.push_back (separation);
  }
  return thinned;
}

DisjointSets
chainSeparations (const std::vector<Separation> &separations, double step)
{
  std::vector<Eigen::Vector3f> positions;
  positions.reserve (separations.size ());
  for (const Separation &separation : separations)
    positions.push_back (separation.position);
  DisjointSets chains (separations.size ());
  if (positions.empty ())
    return chains;
  const auto search = makeGridSearch (std::make_shared<const PointGrid> (positions, step, 1));
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

} // namespace erkpa
