// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surface_vertices.h"

namespace erkpa
{

/** \brief Project vertices \a first .. end to f = iso, each within \a limit of where it is, and fill in the rest.
 * \param[in] lattice see BlockField
 * \param[in,out] vertices neighbours follow each other, or nearly
 */
void
projectVertices (const ImplicitField &field, const PolygonizerOptions &options, std::size_t first, double limit,
                 const MomentLattice *lattice, SurfaceVertices &vertices, PolygonizerReport &report);

} // namespace erkpa
