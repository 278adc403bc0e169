// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/sharp_surface.h>

#include <Eigen/Core>

#include <vector>

namespace erkpa
{

/** \brief A face of a solid as the points on it show it. */
struct FacePoints
{
  std::vector<Eigen::Vector3f> positions;            ///< relative to \a origin, in the unit of length of the cloud
  std::vector<Eigen::Vector3f> normals;              ///< one per position, unit length, pointing out of the solid
  Eigen::Vector3d origin = Eigen::Vector3d::Zero (); ///< in the frame of the cloud
  int k = 0;                                         ///< neighbours of the support; 0 = chosen from their noise
};

/** \brief A face of any shape from points on it alone: θ is their ERKPA field (Hermite constraints, spherical basis).
 *
 * Two of them make the edge in which they meet, see makeSharpBetween (). The field is built when θ is first asked for.
 * Beyond the points θ is what their border says of the face; where the field is undefined, the tangent plane of the
 * nearest point.
 * \param[in] positions at least five, finite, relative to \a origin
 * \param[in] normals as many, not zero
 * \param[in] origin of the positions in the frame of the cloud
 * \param[in] k neighbours of the support, at least 5 (where there are fewer points, all of them are used); 0 = chosen
 * from the noise
 * \return null where the points make no face
 */
SharpSurface::ConstPtr
makeFaceOfPoints (std::vector<Eigen::Vector3f> positions, std::vector<Eigen::Vector3f> normals,
                  const Eigen::Vector3d &origin, int k = 0);

/** \brief The points behind a face made by makeFaceOfPoints (), limited or not; null for any other surface. They live
 * as long as the surface. */
const FacePoints *
pointsBehind (const SharpSurface &surface);

} // namespace erkpa
