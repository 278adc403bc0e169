// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "crease_edges.h"

#include <erkpa/marching_cubes.h>

#include <array>
#include <vector>

namespace erkpa
{

/** \brief The creases of a mesh as lines: each runs along one sharp surface, from a corner or end to the next, or
 * closes. \param[in] edges the edges along creases; those that are no edges of the mesh (any more) are left out
 */
std::vector<Crease>
traceCreases (const ImplicitField &field, const PolygonizerOptions &options, const std::vector<VertexPair> &edges,
              const LargeVector<std::array<int, 3>> &triangles, const SurfaceVertices &vertices);

} // namespace erkpa
