// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <pcl/PCLPointCloud2.h>

#include <string>
#include <vector>

namespace erkpa::tool
{

/** \brief The coordinates of all points of a cloud with fields x, y, z of any type. */
std::vector<Eigen::Vector3d>
positionsOf (const pcl::PCLPointCloud2 &cloud);

/** \brief The cloud as the library takes it: x y z, and normals, intensity and rgb where the cloud has them,
 * all FLOAT32, whatever types and names (nx ny nz; red green blue) the file had.
 * \param[in] others more fields to keep, by name; throws a ToolError where the cloud lacks one
 */
pcl::PCLPointCloud2
toFloatFields (pcl::PCLPointCloud2 cloud, const std::vector<std::string> &others);

/** \brief The largest error that storing the coordinates as float makes; 0 where they are float anyway. */
double
largestRounding (const pcl::PCLPointCloud2 &cloud);

} // namespace erkpa::tool
