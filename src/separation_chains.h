// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "face_segmentation.h"
#include "mesh_graph.h"

#include <map>
#include <vector>

namespace erkpa
{

/** \brief One separation of two faces for each cell of a grid. \param[in] cell side of a cell */
std::vector<Separation>
thinOut (const std::vector<Separation> &separations, double cell);

/** \brief Sets of separations of the same two faces that follow each other: one crease or wall each.
 * \param[in] step how far they may be apart
 */
DisjointSets
chainSeparations (const std::vector<Separation> &separations, double step);

/** \brief How far the separations of each chain extend, along its longest side. */
std::map<int, float>
lengthsOf (const std::vector<Separation> &separations, DisjointSets &chains);

} // namespace erkpa
