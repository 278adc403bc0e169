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
  int with = 0, against = 0;            ///< of those on its level
  int alike = 0, opposite = 0;          ///< of all
  int before = 0, behind = 0;           ///< where those lie that are opposite
  double squares = 0.0, fourths = 0.0;  ///< sums over opposite ones of d² and d⁴, in any unit ...
  double heights = 0.0, products = 0.0; ///< ... and of h and h d²

  void
  addOpposite (double squared, double height)
  {
    ++opposite;
    before += height > 0.0 ? 1 : 0;
    behind += height < 0.0 ? 1 : 0;
    squares += squared;
    fourths += squared * squared;
    heights += height;
    products += height * squared;
  }

  /** \brief Whether the opposite neighbours are the other side of a wall: on curved surfaces heights grow with squared
   * distances, from 0 at the point itself, there from the thickness of the wall. */
  bool
  isWall () const
  {
    constexpr double THICK = 0.08; // of their distance, root mean square
    const double count = std::max (1, opposite);
    const double spread = count * fourths - squares * squares;
    const double at_point = spread > 0.0 ? (heights * fourths - products * squares) / spread : heights / count;
    return at_point < -THICK * std::sqrt (squares / count);
  }

  /** \brief Whether it looks the other way than nearly all of its neighbours, or than most of them. */
  bool
  isFlipped (NormalSigns signs) const
  {
    constexpr int FEWEST = 6, FEWEST_OF_MANY = 4, AGAINST_ONE = 4; // neighbours that speak against the normal
    const bool is_outvoted = signs == NormalSigns::MANY_FLIPPED ? against >= FEWEST_OF_MANY && against > with
                                                                : against >= FEWEST && against > AGAINST_ONE * with;
    return is_outvoted && !isWall ();
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
    if (is_opposite)
      opinion.addOpposite (static_cast<double> (d.squaredNorm ()), static_cast<double> (height));
    else
      ++opinion.alike;
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

namespace
{

/** \brief A sample of all points, at no fixed stride: clouds have rows. */
std::vector<std::size_t>
scatteredSample (std::size_t size)
{
  std::vector<std::size_t> sample = spreadSample (size);
  for (std::size_t s = 0; s + 1 < sample.size (); ++s)
    sample[s] += s * 2654435761u % (sample[s + 1] - sample[s]);
  return sample;
}

/** \brief The points whose normals a turn of some others' may outvote: these and their neighbours. */
std::vector<std::size_t>
neighborsOf (const NeighborSearch &search, const OrientedPoints &points, const std::vector<std::size_t> &turned,
             int neighbors)
{
  std::vector<std::size_t> near = turned;
  FoundNodes found;
  for (const std::size_t i : turned)
  {
    search.nearestK (points.positions[i], neighbors + 1, found.nodes, found.squared);
    near.insert (near.end (), found.nodes.begin (), found.nodes.end ());
  }
  std::sort (near.begin (), near.end ());
  near.erase (std::unique (near.begin (), near.end ()), near.end ());
  return near;
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
  for (const Opinion &opinion : askAbout (search, points, scatteredSample (points.size ()), NEIGHBORS, threads))
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
  std::vector<char> is_turned (points.size (), 0);
  for (int pass = 0; pass < PASSES && !nodes.empty (); ++pass)
  {
    const std::vector<Opinion> opinions = askAbout (search, points, nodes, neighbors, threads);
    std::vector<std::size_t> turned;
    for (std::size_t i = 0; i < nodes.size (); ++i)
      if (opinions[i].isFlipped (signs))
        turned.push_back (nodes[i]);
    for (const std::size_t i : turned)
    {
      points.normals[i] = -points.normals[i];
      is_turned[i] ^= 1;
    }
    nodes = neighborsOf (search, points, turned, neighbors);
  }
  return static_cast<std::size_t> (std::count (is_turned.begin (), is_turned.end (), 1));
}

} // namespace erkpa
