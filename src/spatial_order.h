// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/oriented_points.h>

#include <cstdint>

namespace erkpa
{

/** \brief Bring points into another order.
 *
 * Where every point asks for its neighbours, these are at hand if points that follow each other are close together: a
 * large cloud in random order takes three times as long.
 * \param[in] order which point comes first, second and so on; as many as there are points
 */
void
reorder (const std::uint32_t *order, OrientedPoints &points);

} // namespace erkpa
