// SPDX-License-Identifier: BSD-3-Clause
//
// A surface from points with normals: three lines in the place of pcl::Poisson.
//
//   replace_poisson points.pcd|points.ply mesh.ply
#include <erkpa/erkpa.h>

#include <pcl/io/auto_io.h>
#include <pcl/io/ply_io.h>

#include <iostream>

int
main (int argc, char **argv)
{
  if (argc != 3)
  {
    std::cerr << "usage: replace_poisson points.pcd|points.ply mesh.ply\n";
    return 2;
  }
  pcl::PointCloud<pcl::PointNormal>::Ptr cloud (new pcl::PointCloud<pcl::PointNormal>);
  if (pcl::io::load (argv[1], *cloud) < 0)
    return 1;

  pcl::PolygonMesh mesh;
  erkpa::ERKPA<pcl::PointNormal> erkpa; // was: pcl::Poisson<pcl::PointNormal> poisson;
  erkpa.setInputCloud (cloud);
  erkpa.reconstruct (mesh);

  if (erkpa.getStatus () != erkpa::Status::OK) // the reason has been printed
    return 1;
  std::cout << mesh.polygons.size () << " triangles, " << erkpa.getReport ().topology.boundary_edges
            << " boundary edges\n";
  return pcl::io::savePLYFileBinary (argv[2], mesh) < 0 ? 1 : 0;
}
