// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>

#include <cstddef>

namespace erkpa
{

/** \brief Turn the normals of single points that look the other way than nearly all of their neighbours on the same
 * level.
 *
 * They would be faces of their own, on the back of a wall without thickness. Points of real walls lie on another level
 * than those of the other side.
 * \return how many were turned
 */
std::size_t
turnFlippedNormals (const NeighborSearch &search, int threads, OrientedPoints &points);

} // namespace erkpa
