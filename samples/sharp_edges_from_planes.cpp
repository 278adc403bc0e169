// SPDX-License-Identifier: BSD-3-Clause
//
// pcl::SACSegmentation finds planes; where two of them meet in the cloud, the edge becomes sharp.
//
//   sharp_edges_from_planes points.pcd|points.ply planes threshold mesh.ply
#include <erkpa/erkpa.h>

#include <pcl/filters/extract_indices.h>
#include <pcl/io/auto_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <cstdlib>
#include <iostream>

using Cloud = pcl::PointCloud<pcl::PointNormal>;

/** \brief The plane most points of \a rest lie on; takes them away. */
static pcl::ModelCoefficients
takePlane (Cloud &rest, double threshold)
{
  pcl::SACSegmentation<pcl::PointNormal> segmentation;
  segmentation.setModelType (pcl::SACMODEL_PLANE);
  segmentation.setDistanceThreshold (threshold);
  segmentation.setMaxIterations (1000);
  segmentation.setInputCloud (rest.makeShared ());
  const pcl::PointIndices::Ptr inliers (new pcl::PointIndices);
  pcl::ModelCoefficients plane;
  segmentation.segment (*inliers, plane);
  pcl::ExtractIndices<pcl::PointNormal> others;
  others.setInputCloud (rest.makeShared ());
  others.setIndices (inliers);
  others.setNegative (true);
  others.filter (rest);
  return plane;
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
  erkpa::ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (cloud);
  erkpa.setFaceTolerance (threshold);
  Cloud rest = *cloud;
  for (int i = 0; i < std::atoi (argv[2]); ++i)
    erkpa.addFace (takePlane (rest, threshold)); // says why and returns false where there is no plane any more
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  std::cout << erkpa.getFoundSharpSurfaces ().size () << " sharp edges, " << erkpa.getCorners ().size () << " corners, "
            << mesh.polygons.size () << " triangles\n";
  return erkpa.getStatus () == erkpa::Status::OK && pcl::io::savePLYFileBinary (argv[4], mesh) >= 0 ? 0 : 1;
}
