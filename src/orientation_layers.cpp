// SPDX-License-Identifier: BSD-3-Clause
#include "orientation_layers.h"

#include "threads.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace erkpa
{

namespace
{

constexpr std::size_t DIRECTIONS = 13;

/** \brief A node seen along a direction. */
struct Crossing
{
  std::int64_t column;
  float depth;     ///< where the facet's plane crosses the middle of the column
  float thickness; ///< uncertainty of the depth
  float slope;     ///< cosine between the facet's normal and the direction
  int node;

  bool
  operator<(const Crossing &other) const
  {
    return std::tie (column, depth, node) < std::tie (other.column, other.depth, other.node);
  }
};

/** \brief Directions all over half a sphere, along no axis (where the faces of a part are). */
Eigen::Vector3f
direction (std::size_t index)
{
  const double z = (static_cast<double> (index) + 0.5) / DIRECTIONS,
               turn = 0.3 + 2.399963 * static_cast<double> (index);
  const double r = std::sqrt (1.0 - z * z);
  return Eigen::Vector3d (r * std::cos (turn), r * std::sin (turn), z).cast<float> ();
}

std::vector<Crossing>
crossingsAlong (const Eigen::Vector3f &way, const OrientedPoints &points, const Facets &facets)
{
  constexpr std::int64_t COLUMNS = std::int64_t (1) << 32; // in a row, at most
  constexpr double WIDTH = 2.0; // of a column, in spacings: a layer that is there has a point in it
  const auto width = static_cast<float> (WIDTH * facets.spacing);
  const Eigen::Vector3f u = way.unitOrthogonal (), v = way.cross (u);
  std::vector<Crossing> crossings (points.size ());
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    const Eigen::Vector3f &x = points.positions[i];
    const Facet &facet = facets.of_node[i];
    const float a = x.dot (u) / width, b = x.dot (v) / width;
    const Eigen::Vector3f to_middle = width * ((std::floor (a) + 0.5f - a) * u + (std::floor (b) + 0.5f - b) * v);
    Crossing &c = crossings[i];
    c.column = COLUMNS * static_cast<std::int64_t> (std::floor (a)) + static_cast<std::int64_t> (std::floor (b));
    c.slope = facet.normal.dot (way);
    const float steepness = std::max (0.05f, std::abs (c.slope));
    c.depth = x.dot (way) - facet.normal.dot (to_middle) / std::copysign (steepness, c.slope);
    c.thickness = (2.0f * facet.deviation + facet.bend * static_cast<float> (facets.spacing)) / steepness;
    c.node = static_cast<int> (i);
  }
  std::sort (crossings.begin (), crossings.end ());
  return crossings;
}

constexpr signed char ODD = 2;

/** \brief The layers of one column; writes +1, -1 or ODD for its nodes into \a votes. */
void
voteInColumn (const Crossing *begin, const Crossing *end, double spacing, std::vector<signed char> &votes)
{
  constexpr float STEEPEST = 0.4f;
  constexpr double LEAST_GAP = 0.25; // between layers, in spacings
  const auto isLast = [&] (const Crossing *c)
  {
    return c + 1 == end ||
           c[1].depth - c->depth > std::max (static_cast<float> (LEAST_GAP * spacing), c->thickness + c[1].thickness);
  };
  int layers = 0;
  for (const Crossing *c = begin; c != end; ++c)
  {
    if (std::abs (c->slope) < STEEPEST)
      return;
    layers += isLast (c);
  }
  int layer = 0;
  for (const Crossing *c = begin; c != end; ++c)
  {
    const bool outwards = (c->slope < 0.0f) == (layer % 2 == 0);
    votes[static_cast<std::size_t> (c->node)] = layers % 2 != 0 ? ODD : outwards ? 1 : -1;
    layer += isLast (c);
  }
}

} // namespace

std::vector<LayerVotes>
votesOfLayers (const OrientedPoints &points, const Facets &facets, int threads)
{
  std::vector<std::vector<signed char>> votes (DIRECTIONS);
  parallelFor (
      DIRECTIONS, threads, [] { return 0; },
      [&] (int, std::size_t d)
      {
        votes[d].assign (points.size (), 0);
        const std::vector<Crossing> crossings = crossingsAlong (direction (d), points, facets);
        for (std::size_t begin = 0, end = 0; begin < crossings.size (); begin = end)
        {
          while (end < crossings.size () && crossings[end].column == crossings[begin].column)
            ++end;
          voteInColumn (&crossings[begin], &crossings[begin] + (end - begin), facets.spacing, votes[d]);
        }
      });
  std::vector<LayerVotes> sums (points.size ());
  for (const auto &some : votes)
    for (std::size_t i = 0; i < sums.size (); ++i)
    {
      sums[i].outwards += some[i] == ODD ? 0 : some[i];
      sums[i].even += some[i] == 1 || some[i] == -1;
      sums[i].odd += some[i] == ODD;
    }
  return sums;
}

} // namespace erkpa
