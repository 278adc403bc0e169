// SPDX-License-Identifier: BSD-3-Clause
#include "orientation_layers.h"

#include "layer_columns.h"
#include "threads.h"

#include <cmath>

namespace erkpa
{

namespace
{

constexpr std::size_t DIRECTIONS = 13;

/** \brief Directions all over half a sphere, along no axis (where the faces of a part are). */
Eigen::Vector3f
direction (std::size_t index)
{
  const double z = (static_cast<double> (index) + 0.5) / DIRECTIONS,
               turn = 0.3 + 2.399963 * static_cast<double> (index);
  const double r = std::sqrt (1.0 - z * z);
  return Eigen::Vector3d (r * std::cos (turn), r * std::sin (turn), z).cast<float> ();
}

constexpr signed char ODD = 2;

/** \brief The layers of one column; writes +1, -1 or ODD for its nodes into \a votes. */
void
voteInColumn (const Crossing *begin, const Crossing *end, double spacing, std::vector<signed char> &votes)
{
  const int layers = countLayers (begin, end, spacing);
  int layer = 0;
  for (const Crossing *c = begin; layers > 0 && c != end; ++c)
  {
    const bool outwards = (c->slope < 0.0f) == (layer % 2 == 0);
    votes[static_cast<std::size_t> (c->node)] = layers % 2 != 0 ? ODD : outwards ? 1 : -1;
    layer += isLastOfLayer (c, end, spacing) ? 1 : 0;
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
        const std::vector<Crossing> crossings =
            lookAtLayers (points, facets, {-direction (d), true}, COLUMN_WIDTH * facets.spacing);
        visitColumns (crossings, [&] (const Crossing *begin, const Crossing *end)
                      { voteInColumn (begin, end, facets.spacing, votes[d]); });
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
