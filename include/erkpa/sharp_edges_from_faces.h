// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/oriented_points.h>
#include <erkpa/sharp_surface.h>
#include <erkpa/status.h>

#include <vector>

namespace erkpa
{

/** \brief A face of a solid as segmentation finds it: a model and its coefficients. Which side is outside does not
 * matter. */
struct FaceModel
{
  SurfaceModel model = SurfaceModel::PLANE;
  std::vector<float> coefficients; ///< as SurfaceModel lists them, in the frame of the cloud
};

/** \brief The sharp edges in which faces meet in the data.
 *
 * A model has no borders, and two of them meet in curves where the solid has no edge. A pair is taken where points of
 * both faces come close to the curve along which both models are zero, in the same places, and only there: each sharp
 * surface is makeSharpBetween () the faces, limited to the points of the curve where they do. The faces are shared by
 * the surfaces, and turned so that the normals of their points point outside; where a model has points of both kinds,
 * it stands for two faces. Faces that meet at less than 10 degrees make no edge.
 * \param[in] points of the solid, with normals; those whose normal is zero are not used
 * \param[in] faces any number
 * \param[in] tolerance how far points may lie off their face, a length (the distance threshold of the segmentation);
 * 0 = half the spacing of the points
 * \param[out] surfaces by pair of faces, in the order of \a faces; untouched on error
 * \return Status::INVALID_SETTING where a face has bad coefficients (with its place in the list) or the tolerance is
 * negative or not finite, Status::NO_NORMALS where no point has a normal
 */
Outcome
sharpEdgesFromFaces (const OrientedPoints &points, const std::vector<FaceModel> &faces, double tolerance,
                     std::vector<SharpSurface::ConstPtr> &surfaces);

} // namespace erkpa
