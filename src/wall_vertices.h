// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surface_vertices.h"

#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief Move vertices of thickened walls (LocalField::thicken ()) to the piece of f of their face; to the edge of the
 * wall where that lies beyond it. Those without such a place near them stay.
 * \param[in] which vertices; neighbours follow each other, or nearly
 */
void
moveToFaces (const ImplicitField &field, const PolygonizerOptions &options, const std::vector<std::size_t> &which,
             SurfaceVertices &vertices, PolygonizerReport &report);

} // namespace erkpa
