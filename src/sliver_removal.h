// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "feature_loops.h"

#include <array>
#include <vector>

namespace erkpa
{

/** \brief Remove slivers: triangles so narrow that rounding alone decides where they look.
 *
 * Edges much shorter than a voxel collapse onto one of their vertices, and edges beside triangles that are still narrow
 * are flipped. The surface stays where it is within a few hundredths of a voxel, and stays the same topologically;
 * creases run as before, their ends and corners stay, and so does the border.
 * \param[in] voxel side of a grid cell
 * \param[in,out] creases the edges of the mesh that run along creases, sorted; those that are no edges of it are
 * dropped \param[in,out] triangles of an oriented mesh \param[in] vertices with normals of f; those that are not used
 * any more stay \param[in] threads 0 = all processors; the mesh does not depend on it
 */
void
removeSlivers (double voxel, std::vector<VertexPair> &creases, LargeVector<std::array<int, 3>> &triangles,
               const SurfaceVertices &vertices, int threads = 0);

} // namespace erkpa
