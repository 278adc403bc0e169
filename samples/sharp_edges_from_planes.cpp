// SPDX-License-Identifier: BSD-3-Clause
//
// pcl::SACSegmentation finds planes; wherever two of them meet in the cloud, the plane between them makes a sharp edge.
//
//   sharp_edges_from_planes points.pcd|points.ply number_of_planes distance_threshold mesh.ply
#include <erkpa/erkpa.h>

#include <pcl/io/auto_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <numeric>

using Cloud = pcl::PointCloud<pcl::PointNormal>;

/** \brief Takes the plane most of \a remaining lie on out of them; its normal points out of the solid, as theirs do. */
static Eigen::Vector4f
takePlane (const Cloud::ConstPtr &cloud, double threshold, pcl::Indices &remaining)
{
  pcl::SACSegmentation<pcl::PointNormal> segmentation;
  segmentation.setModelType (pcl::SACMODEL_PLANE);
  segmentation.setDistanceThreshold (threshold);
  segmentation.setMaxIterations (1000);
  segmentation.setInputCloud (cloud);
  segmentation.setIndices (pcl::make_shared<pcl::Indices> (remaining));
  pcl::PointIndices inliers;
  pcl::ModelCoefficients coefficients;
  segmentation.segment (inliers, coefficients);
  if (inliers.indices.empty ())
    return Eigen::Vector4f::Zero ();
  const Eigen::Vector4f plane (coefficients.values.data ());

  Eigen::Vector3f outwards = Eigen::Vector3f::Zero ();
  for (const auto i : inliers.indices)
    outwards += (*cloud)[i].getNormalVector3fMap ();
  pcl::Indices rest;
  std::set_difference (remaining.begin (), remaining.end (), inliers.indices.begin (), inliers.indices.end (),
                       std::back_inserter (rest));
  remaining.swap (rest);
  return outwards.dot (plane.head<3> ()) < 0.0f ? Eigen::Vector4f (-plane) : plane;
}

int
main (int argc, char **argv)
{
  Cloud::Ptr cloud (new Cloud);
  if (argc != 5 || pcl::io::load (argv[1], *cloud) < 0)
  {
    std::cerr << "usage: sharp_edges_from_planes points.pcd|points.ply number_of_planes distance_threshold mesh.ply\n";
    return 2;
  }
  const double threshold = std::atof (argv[3]);
  std::vector<Eigen::Vector4f> planes (std::atoi (argv[2]));
  pcl::Indices remaining (cloud->size ());
  std::iota (remaining.begin (), remaining.end (), 0);
  for (Eigen::Vector4f &plane : planes)
    plane = takePlane (cloud, threshold, remaining);

  erkpa::ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (cloud);
  for (std::size_t i = 0; i < planes.size (); ++i)
    for (std::size_t j = 0; j < i; ++j)
    {
      const auto is_on_both = [&] (const pcl::PointNormal &point)
      {
        const Eigen::Vector4f p = point.getVector3fMap ().homogeneous ();
        return std::abs (planes[i].dot (p)) < 2.0 * threshold && std::abs (planes[j].dot (p)) < 2.0 * threshold;
      };
      if (std::count_if (cloud->begin (), cloud->end (), is_on_both) < 20) // they do not meet here
        continue;
      // Two planes have two bisectors. With unit normals that point out of the solid it is n_i - n_j that has one face
      // on either side; n_i + n_j has both on the same.
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
