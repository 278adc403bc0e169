// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surface_vertices.h"

#include <array>
#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief The places of the triangles that have a marked vertex. */
LargeVector<std::size_t>
findTouching (const std::vector<char> &marks, int threads, const LargeVector<std::array<int, 3>> &triangles);

/** \brief Cut a surface off where the data ends.
 *
 * Past the border of the data the field goes on for a while, up to the ragged edge of the evaluated grid. A region
 * of vertices with too large a border offset is cut away if it runs out to that edge, along the line where the
 * offset has the limit. A region that does not is a hole in the data which the surface closes: it stays.
 * \param[in] limit the border offset at which a surface ends
 * \param[in,out] border the vertices on the border
 * \param[in,out] triangles the triangles; clipped ones are replaced
 * \param[in,out] vertices new vertices on the cut are appended, only their positions filled in
 */
void
trimBorder (double limit, int threads, LargeVector<int> &border, LargeVector<std::array<int, 3>> &triangles,
            SurfaceVertices &vertices);

/** \brief Give each fan of triangles around a vertex a vertex of its own, so that borders do not touch in a point.
 * \param[in] border all vertices on the border; others may be among them
 */
void
splitFans (const LargeVector<int> &border, int threads, LargeVector<std::array<int, 3>> &triangles,
           SurfaceVertices &vertices);

} // namespace erkpa
