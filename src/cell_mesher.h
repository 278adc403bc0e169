// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cell_loops.h"
#include "surface_vertices.h"

#include <array>
#include <vector>

namespace erkpa
{

/** \brief A closed polygon in which the surface crosses a cell, over the vertices on the cell's edges. */
struct CellLoop
{
  std::vector<int> ring; ///< vertices, counter-clockwise from outside
  LoopEdges edges{};     ///< the cell's edge of each
};

/** \brief What the cells give. */
struct CellMesh
{
  LargeVector<std::array<int, 3>> triangles;
  LargeVector<CellLoop> centered_loops; ///< need a vertex of their own inside the cell
  LargeVector<CellLoop> mixed_loops; ///< have vertices on several sides of sharp surfaces, and may have a crease inside
  LargeVector<int> border; ///< vertices of the sides beyond which the surface does not go on, each once or more
};

/** \brief Turn the loops of the active cells into triangles over the placed vertices, block after block. */
CellMesh
meshCells (const SparseGrid &grid, int threads, const SurfaceVertices &vertices);

/** \brief Triangulate one loop without new vertices; false where it needs one. */
bool
triangulateCell (const CellLoop &loop, const SurfaceVertices &vertices, LargeVector<std::array<int, 3>> &triangles);

/** \brief Add the triangles between a loop and the vertex \a center in its middle. */
void
addFan (const std::vector<int> &ring, int center, LargeVector<std::array<int, 3>> &triangles);

} // namespace erkpa
