// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cell_loops.h"

#include <Eigen/Core>

#include <array>

namespace erkpa
{

/** \brief A loop of a cell: the places of its vertices in order, where f looks there, and the cell edge of each. */
struct LoopShape
{
  int size = 0;
  std::array<Eigen::Vector3d, 12> positions, normals;
  LoopEdges edges{};
};

/** \brief Triangles of a loop, their corners as places in the loop. */
struct LoopTriangles
{
  int count = 0;
  std::array<std::array<int, 3>, 10> corners;
};

/** \brief Triangulate a loop of a cell without new vertices.
 *
 * No chord joins two vertices of one face: the neighbour cell could use the same one, and four triangles would meet
 * there. Among the other triangulations takes the one whose triangles agree best with the vertex normals, and with
 * the shorter chords where they agree alike: in flat loops the chords alone tell.
 * \param[out] triangles the triangles
 * \return false where every triangulation needs a forbidden chord; the best of them is given then
 */
bool
triangulateLoop (const LoopShape &loop, LoopTriangles &triangles);

} // namespace erkpa
