// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <pcl/PolygonMesh.h>
#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

/** \brief Evenly spread points of the unit sphere; their normals are their coordinates. */
inline std::vector<Eigen::Vector3d>
fibonacciSphere (int count = 3000)
{
  std::vector<Eigen::Vector3d> points;
  const double golden_angle = M_PI * (3.0 - std::sqrt (5.0));
  for (int i = 0; i < count; ++i)
  {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double radius = std::sqrt (1.0 - z * z);
    points.emplace_back (radius * std::cos (golden_angle * i), radius * std::sin (golden_angle * i), z);
  }
  return points;
}

constexpr double SPHERE_VOLUME = 4.0 / 3.0 * M_PI;

/** \brief The sphere as rows of text: what stands before x, and between and behind the numbers. */
inline std::string
sphereRows (bool with_normals, const std::string &prefix = "", const std::string &separator = " ",
            const std::string &suffix = "")
{
  std::ostringstream rows;
  rows << std::setprecision (9);
  for (const Eigen::Vector3d &p : fibonacciSphere ())
  {
    rows << prefix << p.x () << separator << p.y () << separator << p.z ();
    if (with_normals)
      rows << separator << p.x () << separator << p.y () << separator << p.z ();
    rows << suffix << "\n";
  }
  return rows.str ();
}

/** \brief The sphere as PCL has it. */
template <typename PointT>
pcl::PointCloud<PointT>
sphereCloud ()
{
  pcl::PointCloud<PointT> cloud;
  for (const Eigen::Vector3d &p : fibonacciSphere ())
  {
    PointT point;
    point.getVector3fMap () = p.cast<float> ();
    point.getNormalVector3fMap () = p.cast<float> ();
    cloud.push_back (point);
  }
  return cloud;
}

/** \brief The volume a closed mesh encloses; negative where its triangles face inwards. */
inline double
volumeOf (const pcl::PolygonMesh &mesh)
{
  pcl::PointCloud<pcl::PointXYZ> vertices;
  pcl::fromPCLPointCloud2 (mesh.cloud, vertices);
  double volume = 0.0;
  for (const pcl::Vertices &polygon : mesh.polygons)
  {
    Eigen::Matrix3d corners;
    for (int c = 0; c < 3; ++c)
      corners.col (c) =
          vertices.at (polygon.vertices.at (static_cast<std::size_t> (c))).getVector3fMap ().cast<double> ();
    volume += corners.determinant () / 6.0;
  }
  return volume;
}
