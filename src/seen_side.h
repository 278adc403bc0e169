// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "orientation_facets.h"
#include "viewer.h"

#include <optional>

namespace erkpa
{

/** \brief Who sees all of an open surface at once, so that the normals look there.
 *
 * A column along the line of sight holds one layer of such a scan. Where it holds more, as under trees and eaves of
 * land seen from the air, they share the points that a sensor gets there; sheets of a surface that turns back below
 * itself have as many each. Asked are the view point if it is known, else somebody far out on the side that most
 * normals look to: up, where both of its sides would do.
 * \param[in] facets of the points, whose signs mean nothing
 * \param[in] view_point in the frame of the positions
 * \return none where nobody does, or the points are too few to tell
 */
std::optional<Viewer>
findViewer (const OrientedPoints &points, const Facets &facets, const std::optional<Eigen::Vector3f> &view_point);

} // namespace erkpa
