// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/oriented_points.h>
#include <erkpa/point_layout.h>
#include <erkpa/sharp_edges_from_faces.h>
#include <erkpa/sharp_surface.h>
#include <erkpa/status.h>

#include <vector>

namespace erkpa
{

/** \brief Settings of the sharp edges that are found in the points, beside those that are given. */
struct SharpOptions
{
  bool automatic = false;       ///< find sharp edges
  std::vector<FaceModel> faces; ///< faces of the solid, as segmentation finds them: see sharpEdgesFromFaces ()
  double face_tolerance = 0.0;  ///< how far points may lie off their face, a length; 0 = half their spacing
  double angle = 25.0; ///< edges whose faces turn by less than this many degrees are taken for smooth; in [5, 90]
};

/** \brief Find the sharp edges of a surface in points on it.
 *
 * The nodes are sorted into faces, smooth patches of surface, and where two faces meet in an edge or lie back to back
 * in a thin wall, a sharp surface keeps them apart: makeSharpBetween () two faces of points (makeFaceOfPoints ()),
 * limited to the places where they meet. They can be listed, left out, saved (sharp_surface_io.h) and given to a field
 * like any others.
 * \param[in] points the nodes, with normals that are not smeared over edges
 * \param[in] layout of their positions
 * \param[in] options its angle counts
 * \param[in] threads 0 = all processors
 * \param[out] surfaces one for each stretch along which two faces meet
 * \return Status::INVALID_SETTING for an angle that makes no sense
 */
Outcome
findSharpSurfaces (const OrientedPoints &points, const PointLayout &layout, const SharpOptions &options, int threads,
                   std::vector<SharpSurface::ConstPtr> &surfaces);

} // namespace erkpa
