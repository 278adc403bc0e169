// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sparse_grid.h"

#include <array>
#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief Drops the connected pieces of surface that too few nodes support.
 * \param[in] cells_of_nodes the cell in which each node is or has its foot; SurfaceTracker::NO_CELL for none
 * \param[in] min_points nodes that a piece needs
 * \return how many pieces were dropped
 */
std::size_t
dropUnsupported (const SparseGrid &grid, const std::vector<GridPoint> &cells_of_nodes, int min_points, int threads,
                 std::size_t vertex_count, std::vector<std::array<int, 3>> &triangles);

} // namespace erkpa
