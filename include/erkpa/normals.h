// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/oriented_points.h>
#include <erkpa/point_layout.h>

namespace erkpa
{

/** \brief Settings of the normals that are estimated where a cloud has none. */
struct NormalOptions
{
  int k = 0;                                             ///< neighbours of the plane fit; 0 = chosen from the noise
  bool has_view_point = false;                           ///< whether the sensor's position is known
  Eigen::Vector3d view_point = Eigen::Vector3d::Zero (); ///< the sensor's position in the cloud's frame
  bool sharpen = true; ///< mend signs and, where sharp edges are known or sought, refineNormals (); else as given
  int threads = 0;     ///< 0 = all processors
};

/** \brief How normals got their sign that are estimated, or were given without one. */
enum class Orientation
{
  NONE,       ///< they were given, and none but single ones were turned
  VIEW_POINT, ///< towards the view point
  ONE_SIDE,   ///< nearly all is seen from far out on one side, not from the view point
  PROPAGATION ///< at least in part from neighbour to neighbour, outwards: the view point is unknown or cannot
              ///< have seen the surface
};

/** \brief Estimate (pcl::NormalEstimationOMP) and orient the normals that are zero; the others stay.
 * \param[in] layout of the positions
 */
Outcome
estimateNormals (OrientedPoints &points, const PointLayout &layout, const NormalOptions &options,
                 Orientation &orientation);

/** \brief Give the normals, which point nowhere in particular, their signs, as estimateNormals () does; but turn all of
 * them where most were given the other way round. */
Orientation
reorientNormals (OrientedPoints &points, const PointLayout &layout, const NormalOptions &options);

/** \brief What refineNormals () did. */
struct RefinedNormals
{
  bool sharpened = false; ///< normals smeared across edges became those of one face each
  bool smoothed =
      false; ///< noise was taken out of the normals, with which faces are told apart; the field keeps those given
};

/** \brief Make normals that respect sharp edges: each of the face its point is on.
 *
 * Estimated normals, and given ones that look estimated, are smeared across edges: they are fitted anew from points on
 * their own side only. Noisy ones are smoothed, over neighbours that look their way. Others stay as they are.
 * \param[in] layout of the positions
 * \param[in] estimated whether the normals come from estimateNormals ()
 * \param[in] threads 0 = all processors
 */
RefinedNormals
refineNormals (const PointLayout &layout, bool estimated, int threads, OrientedPoints &points);

} // namespace erkpa
