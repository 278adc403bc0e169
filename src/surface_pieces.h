// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surface_tracking.h"

#include <erkpa/large_pages.h>

#include <array>
#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief Drops the connected pieces of surface that too few nodes support.
 * \param[in] tracker knows the cells of the nodes
 * \param[in] min_points nodes that a piece needs
 * \return how many pieces were dropped
 */
std::size_t
dropUnsupported (const SparseGrid &grid, const SurfaceTracker &tracker, int min_points, int threads,
                 std::size_t vertex_count, LargeVector<std::array<int, 3>> &triangles);

} // namespace erkpa
