// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cell_mesher.h"
#include "surface_vertices.h"

#include <Eigen/Core>

#include <array>

namespace erkpa
{

/** \brief Whether a triangle looks away from where the surface does. */
bool
looksAway (const std::array<int, 3> &triangle, const Eigen::Vector3d &normal, const SurfaceVertices &vertices);

/** \brief Whether a vertex lies in the cell of a loop, as the places of its ring on the cell's edges tell.
 * \param[in] voxel side of a cell
 */
bool
isInsideCell (int vertex, const CellLoop &loop, double voxel, const SurfaceVertices &vertices);

/** \brief Of the vertices of two triangles, take the one that was moved farthest from the edge of the grid it was found
 * on back there; false where none was moved. */
bool
putBackFarthest (const std::array<int, 3> &one, const std::array<int, 3> &other, SurfaceVertices &vertices);

} // namespace erkpa
