// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "orientation_facets.h"
#include "viewer.h"

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace erkpa
{

constexpr double COLUMN_WIDTH = 2.0; // in spacings: a layer that is there has a point in it

/** \brief A node in a column along the line of sight. */
struct Crossing
{
  std::int64_t column;
  float depth;     ///< where the facet's plane crosses the middle of the column; less is closer to the viewer
  float thickness; ///< uncertainty of the depth
  float slope;     ///< cosine between the facet's normal and the direction in which one looks
  int node;

  bool
  operator<(const Crossing &other) const
  {
    return std::tie (column, depth, node) < std::tie (other.column, other.depth, other.node);
  }
};

/** \brief What a viewer sees of a cloud, column by column.
 * \param[in] width of columns; for a viewer that is not far, at a distance of 1
 * \param[in] one_in look at one of so many columns only, which lie here and there
 * \return by columns, each from the closest node to the farthest
 */
std::vector<Crossing>
lookAtLayers (const OrientedPoints &points, const Facets &facets, const Viewer &viewer, double width,
              std::uint64_t one_in = 1);

/** \brief Whether a node is the last one of its layer in a column. */
bool
isLastOfLayer (const Crossing *node, const Crossing *end, double spacing);

/** \brief Number of layers in a column; 0 where some of it lies along the line of sight, so that they cannot be
 * counted. */
int
countLayers (const Crossing *begin, const Crossing *end, double spacing);

/** \brief Calls take (begin, end) for the nodes of each column. */
template <typename TakeT>
void
visitColumns (const std::vector<Crossing> &crossings, TakeT take)
{
  for (std::size_t begin = 0, end = 0; begin < crossings.size (); begin = end)
  {
    while (end < crossings.size () && crossings[end].column == crossings[begin].column)
      ++end;
    take (crossings.data () + begin, crossings.data () + end);
  }
}

} // namespace erkpa
