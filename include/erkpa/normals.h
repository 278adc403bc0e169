// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>

namespace erkpa
{

/** \brief Settings of the normals that are estimated where a cloud has none. */
struct NormalOptions
{
  int k = 0;                                             ///< neighbours of the plane fit; 0 = chosen from the noise
  bool has_view_point = false;                           ///< whether the sensor's position is known
  Eigen::Vector3d view_point = Eigen::Vector3d::Zero (); ///< the sensor's position in the cloud's frame
  int threads = 0;                                       ///< 0 = all processors
};

/** \brief How estimated normals got their sign. */
enum class Orientation
{
  NONE,       ///< nothing was estimated
  VIEW_POINT, ///< towards the view point
  PROPAGATION ///< at least in part from neighbour to neighbour, outwards: the view point is unknown or cannot
              ///< have seen the surface
};

/** \brief Estimate (pcl::NormalEstimationOMP) and orient the normals that are zero; the others stay. */
Outcome
estimateNormals (OrientedPoints &points, const NeighborSearch &search, const NormalOptions &options,
                 Orientation &orientation);

} // namespace erkpa
