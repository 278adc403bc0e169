// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "feature_loops.h"

#include <array>
#include <vector>

namespace erkpa
{

/** \brief Add the triangles of loops with creases.
 *
 * Each loop becomes a fan around its vertex on the crease. After the fans of both cells at a crossing are there, the
 * edge between the two crossing vertices is turned into the edge between the two inner ones: it runs along the crease,
 * and none crosses it. A loop whose triangles would fold over or pass through others
 * is meshed without its crease, and vertices of thin walls go back to where they were found where that is not enough.
 * \param[in] voxel side of a grid cell
 * \param[in,out] triangles,vertices new ones are appended
 * \return the edges of the mesh that run along creases, sorted
 */
std::vector<VertexPair>
addCreases (double voxel, const LargeVector<CellLoop> &loops, const std::vector<MeshedLoop> &meshed, int threads,
            LargeVector<std::array<int, 3>> &triangles, SurfaceVertices &vertices);

} // namespace erkpa
