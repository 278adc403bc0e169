// SPDX-License-Identifier: BSD-3-Clause
//
// pcl::SACSegmentation finds planes; where two of them meet in the cloud, the plane between them makes a
// sharp edge.
//
//   sharp_edges_from_planes points.pcd|points.ply planes threshold mesh.ply
#include <erkpa/erkpa.h>

#include <pcl/filters/extract_indices.h>
#include <pcl/io/auto_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

using Cloud = pcl::PointCloud<pcl::PointNormal>;

/** \brief The plane most points of \a rest lie on, with its normal out of the solid; takes them away. */
static Eigen::Vector4f
takePlane (Cloud &rest, double threshold)
{
  pcl::SACSegmentation<pcl::PointNormal> segmentation;
  segmentation.setModelType (pcl::SACMODEL_PLANE);
  segmentation.setDistanceThreshold (threshold);
  segmentation.setMaxIterations (1000);
  segmentation.setInputCloud (rest.makeShared ());
  pcl::PointIndices inliers;
  pcl::ModelCoefficients coefficients;
  segmentation.segment (inliers, coefficients);
  if (inliers.indices.empty ())
    return Eigen::Vector4f::Zero ();
  const Eigen::Vector4f plane (coefficients.values.data ());
  Eigen::Vector3f outwards = Eigen::Vector3f::Zero ();
  for (const auto i : inliers.indices)
    outwards += rest[i].getNormalVector3fMap ();
  pcl::ExtractIndices<pcl::PointNormal> others;
  others.setInputCloud (rest.makeShared ());
  others.setIndices (pcl::make_shared<pcl::PointIndices> (inliers));
  others.setNegative (true);
  others.filter (rest);
  return outwards.dot (plane.head<3> ()) < 0.0f ? Eigen::Vector4f (-plane) : plane;
}

int
main (int argc, char **argv)
{
  Cloud::Ptr cloud (new Cloud);
  if (argc != 5 || pcl::io::load (argv[1], *cloud) < 0)
  {
    std::cerr << "usage: sharp_edges_from_planes points.pcd|points.ply planes threshold mesh.ply\n";
    return 2;
  }
  const double threshold = std::atof (argv[3]);
  std::vector<Eigen::Vector4f> planes (std::atoi (argv[2]));
  Cloud rest = *cloud;
  for (Eigen::Vector4f &plane : planes)
    plane = takePlane (rest, threshold);

  erkpa::ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (cloud);
  for (std::size_t i = 0; i < planes.size (); ++i)
    for (std::size_t j = 0; j < i; ++j)
    {
      int points_on_both = 0;
      for (const pcl::PointNormal &point : *cloud)
      {
        const Eigen::Vector4f p = point.getVector3fMap ().homogeneous ();
        points_on_both += std::max (std::abs (planes[i].dot (p)), std::abs (planes[j].dot (p))) < 2.0 * threshold;
      }
      if (points_on_both < 20) // they do not meet here
        continue;
      // Two planes have two bisectors. With unit normals that point out of the solid it is n_i - n_j that has
      // one face on either side; n_i + n_j has both on the same.
      const Eigen::Vector4f bisector = planes[i] - planes[j];
      pcl::ModelCoefficients edge;
      edge.values.assign (bisector.data (), bisector.data () + 4);
      erkpa.addSharpEdge (edge);
    }
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  std::cout << erkpa.getSharpEdges ().size () << " sharp edges, " << mesh.polygons.size () << " triangles\n";
  return erkpa.getStatus () == erkpa::Status::OK && pcl::io::savePLYFileBinary (argv[4], mesh) >= 0 ? 0 : 1;
}
