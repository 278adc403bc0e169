// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/normals.h>

#include "threads.h"

#include <pcl/features/normal_3d_omp.h>
#include <pcl/search/kdtree.h>

namespace erkpa
{

Outcome
estimateNormals (OrientedPoints &points, const NeighborSearch &, const NormalOptions &options,
                 Orientation &orientation)
{
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud (new pcl::PointCloud<pcl::PointXYZ>);
  for (const Eigen::Vector3f &p : points.positions)
    cloud->push_back (pcl::PointXYZ (p.x (), p.y (), p.z ()));
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation (static_cast<unsigned> (options.threads));
  estimation.setInputCloud (cloud);
  estimation.setSearchMethod (pcl::search::KdTree<pcl::PointXYZ>::Ptr (new pcl::search::KdTree<pcl::PointXYZ> (false)));
  estimation.setKSearch (options.k > 0 ? options.k : 20);
  const Eigen::Vector3f view_point = (options.view_point - points.origin).cast<float> ();
  estimation.setViewPoint (view_point.x (), view_point.y (), view_point.z ());
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute (normals);
  for (std::size_t i = 0; i < points.size (); ++i)
    if (points.normals[i].isZero (0.0f))
      points.normals[i] = normals[i].getNormalVector3fMap ();
  orientation = Orientation::VIEW_POINT;
  return {};
}

} // namespace erkpa
