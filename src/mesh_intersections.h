// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/large_pages.h>

#include <Eigen/Core>

#include <array>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief Whether two triangles of a mesh pass through each other beside the vertices they share.
 *
 * Those that share an edge never do: they fold at most. Touching does not count.
 */
bool
passThrough (const LargeVector<Eigen::Vector3d> &positions, const std::array<int, 3> &one,
             const std::array<int, 3> &other);

/** \brief The pairs of triangles that pass through each other, of which the first is one of the \a suspects.
 * \param[in] suspects places in \a triangles
 * \param[in] cell about the length of the triangles' sides
 * \return places in \a triangles; pairs of two suspects once, sorted
 */
std::vector<std::pair<int, int>>
findIntersections (const LargeVector<Eigen::Vector3d> &positions, const LargeVector<std::array<int, 3>> &triangles,
                   const std::vector<int> &suspects, double cell, int threads);

} // namespace erkpa
