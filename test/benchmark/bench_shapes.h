// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace bench
{

/** \brief A shape to reconstruct, and what is said about its edges. */
struct Shape
{
  pcl::PointCloud<pcl::PointNormal>::Ptr cloud;
  std::vector<Eigen::Vector4d> planes; ///< a, b, c, d of those that halve its edges; empty where none are given
  bool is_automatic = false;           ///< edges are to be found
};

/** \brief torus: smooth, with bumps; box: at an odd attitude, with its twelve planes; box_auto: without. */
const std::vector<std::string> &
shapeNames ();

/** \brief Points at random, evenly spread over a shape, with exact normals; always the same ones. No more memory is
 * taken than what is returned. */
Shape
makeShape (const std::string &name, std::size_t count);

} // namespace bench
