// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/normals.h>

#include "normal_orientation.h"
#include "normal_sharpening.h"
#include "normal_smoothing.h"
#include "threads.h"

#include <pcl/features/normal_3d_omp.h>
#include <pcl/search/kdtree.h>

#include <cmath>

namespace erkpa
{

namespace
{

/** \brief Normals by the plane fit of PCL, each towards the view point. */
std::vector<Eigen::Vector3f>
fitPlanes (const OrientedPoints &points, int k, const Eigen::Vector3f &view_point, int threads)
{
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud (new pcl::PointCloud<pcl::PointXYZ>);
  cloud->reserve (points.size ());
  for (const Eigen::Vector3f &p : points.positions)
    cloud->push_back (pcl::PointXYZ (p.x (), p.y (), p.z ()));
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation (static_cast<unsigned> (threadCount (threads)));
  estimation.setInputCloud (cloud);
  estimation.setSearchMethod (pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>> (false));
  estimation.setKSearch (k);
  estimation.setViewPoint (view_point.x (), view_point.y (), view_point.z ());
  pcl::PointCloud<pcl::Normal> estimated;
  estimation.compute (estimated);
  std::vector<Eigen::Vector3f> normals;
  normals.reserve (points.size ());
  for (const pcl::Normal &n : estimated)
    normals.emplace_back (n.normal_x, n.normal_y, n.normal_z);
  return normals;
}

} // namespace

Outcome
estimateNormals (OrientedPoints &points, const PointLayout &layout, const NormalOptions &options,
                 Orientation &orientation)
{
  if (options.k != 0 && options.k < 3)
    return {Status::INVALID_SETTING, "normals need at least 3 neighbours, or 0 for automatic"};
  if (options.has_view_point && !options.view_point.allFinite ())
    return {Status::INVALID_SETTING, "the view point must be finite"};
  const int k = options.k > 0 ? options.k : layout.k;
  const Eigen::Vector3f view_point = (options.view_point - points.origin).cast<float> ();
  std::vector<Eigen::Vector3f> estimated = fitPlanes (points, k, view_point, options.threads);
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    if (!points.normals[i].isZero (0.0f))
      estimated[i] = points.normals[i];
    else if (!estimated[i].allFinite ())
      return {Status::NO_NORMALS, "normals could not be estimated at some points: give normals with the input"};
  }
  orientation = orientNormals (points, *layout.search, k, options, estimated);
  points.normals.swap (estimated);
  return {};
}

Orientation
reorientNormals (OrientedPoints &points, const PointLayout &layout, const NormalOptions &options)
{
  constexpr double MOST = 0.6; // of the normals: then they know the side better
  std::vector<Eigen::Vector3f> normals (points.size (), Eigen::Vector3f::Zero ());
  normals.swap (points.normals); // as if none were given
  const std::vector<Eigen::Vector3f> given = normals;
  const int k = options.k > 0 ? options.k : layout.k;
  const Orientation orientation = orientNormals (points, *layout.search, k, options, normals);
  points.normals.swap (normals);
  std::size_t against = 0;
  for (std::size_t i = 0; i < points.size (); ++i)
    against += points.normals[i].dot (given[i]) < 0.0f ? 1 : 0;
  if (static_cast<double> (against) > MOST * static_cast<double> (points.size ()))
    for (Eigen::Vector3f &normal : points.normals)
      normal = -normal;
  return orientation;
}

RefinedNormals
refineNormals (const PointLayout &layout, bool estimated, int threads, OrientedPoints &points)
{
  constexpr double NOISY = 4.5;          // degrees
  constexpr double NOISY_POSITION = 0.1; // spacings
  constexpr int PASSES = 3, NEIGHBORS = 24;
  constexpr double SIGMA = 25.0; // degrees
  const NeighborSearch &search = *layout.search;
  const double spacing = layout.spacing;
  RefinedNormals refined;
  if (!(spacing > 0.0))
    return refined;
  NormalScale scale{spacing, positionNoise (search, spacing, threads, points), layout.k};
  refined.sharpened = estimated || areNormalsSmeared (search, scale, threads, points);
  if (refined.sharpened)
  {
    sharpenNormals (search, scale, threads, points);
    scale.noise = positionNoise (search, spacing, threads, points); // it is measured apart from other faces' points
  }
  refined.smoothed = scale.noise > NOISY_POSITION * spacing ||
                     (!refined.sharpened && normalNoise (search, spacing, threads, points) > NOISY);
  if (refined.smoothed)
    smoothNormals (search, spacing, PASSES, NEIGHBORS, SIGMA, threads, points);
  return refined;
}

} // namespace erkpa
