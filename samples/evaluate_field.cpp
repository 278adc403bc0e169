// SPDX-License-Identifier: BSD-3-Clause
//
// The field without a mesh: how far given points are from the surface, and which way it lies.
//
//   echo "0 0 0.1" | evaluate_field points.pcd|points.ply
#include <erkpa/erkpa.h>

#include <pcl/io/auto_io.h>

#include <iostream>

int
main (int argc, char **argv)
{
  if (argc != 2)
  {
    std::cerr << "usage: evaluate_field points.pcd|points.ply < queries (x y z a line)\n";
    return 2;
  }
  pcl::PointCloud<pcl::PointNormal>::Ptr cloud (new pcl::PointCloud<pcl::PointNormal>);
  if (pcl::io::load (argv[1], *cloud) < 0)
    return 1;

  erkpa::ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (cloud);
  const erkpa::ImplicitField::ConstPtr field = erkpa.computeField ();
  if (!field) // the reason has been printed
    return 1;

  Eigen::Vector3d x;
  while (std::cin >> x.x () >> x.y () >> x.z ())
  {
    const erkpa::FieldSample sample = field->sample (x); // about the signed distance, positive outside
    if (sample.isDefined ())
      std::cout << "f = " << sample.value << ", gradient " << sample.gradient.transpose () << "\n";
    else
      std::cout << "undefined: no points near\n";
  }
  return 0;
}
