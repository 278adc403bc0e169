// SPDX-License-Identifier: BSD-3-Clause
//
// A box and a twisted box from 3900 points each, without and with sharp edges, as figure 2 of the paper has them; then
// the one surface of the box bent and twisted as a whole, with no points moved.
//
//   bend_and_twist folder
#include <erkpa/erkpa.h>

#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <cmath>
#include <iostream>
#include <string>

using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Surfaces = std::vector<erkpa::SharpSurface::ConstPtr>;

static const Eigen::Vector3d HALF (0.6, 0.5, 1.2); // half the sides of the box
static const double TURN = 0.5 * M_PI;             // how far an end is turned against the other

/** \brief Adds \a count points to the face of the box whose outward normal is \a sign along \a axis. */
static void
addFace (Cloud &cloud, int axis, int sign, int count)
{
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double side = 2.0 * std::max (HALF[u], HALF[v]);
  Eigen::Vector3d position = sign * HALF[axis] * Eigen::Vector3d::Unit (axis);
  double a = 0.5, b = 0.5;
  while (count > 0)
  {
    a = std::fmod (a + 0.7548776662466927, 1.0); // the sequence R2, which fills a square evenly
    b = std::fmod (b + 0.5698402909980532, 1.0);
    position[u] = side * (a - 0.5);
    position[v] = side * (b - 0.5);
    if (std::abs (position[u]) > HALF[u] || std::abs (position[v]) > HALF[v])
      continue;
    pcl::PointNormal point;
    point.getVector3fMap () = position.cast<float> ();
    point.getNormalVector3fMap () = (sign * Eigen::Vector3d::Unit (axis)).cast<float> ();
    cloud.push_back (point);
    --count;
  }
}

static Cloud::Ptr
makeBox ()
{
  Cloud::Ptr cloud (new Cloud);
  const int counts[3] = {722, 867, 361}; // as the areas of the faces
  for (int axis = 0; axis < 3; ++axis)
    for (const int sign : {-1, 1})
      addFace (*cloud, axis, sign, counts[axis]);
  return cloud;
}

/** \brief The planes that halve the twelve edges of the box. */
static Surfaces
makeEdges ()
{
  Surfaces edges;
  for (int a = 0; a < 3; ++a)
    for (const int sign_a : {-1, 1})
      for (const int sign_b : {-1, 1})
      {
        const int b = (a + 1) % 3;
        const Eigen::Vector3d normal = sign_a * Eigen::Vector3d::Unit (a) - sign_b * Eigen::Vector3d::Unit (b);
        const double offset = HALF[b] - HALF[a];
        edges.push_back (std::make_shared<erkpa::SharpPlane> (normal * M_SQRT1_2, offset * M_SQRT1_2));
      }
  return edges;
}

/** \brief Turns space about the z axis by \a rate times z. */
static erkpa::SpaceWarp::ConstPtr
makeTwist (double rate)
{
  const auto map = [rate] (const Eigen::Vector3d &x) -> Eigen::Vector3d
  { return Eigen::AngleAxisd (rate * x.z (), Eigen::Vector3d::UnitZ ()) * x; };
  const auto jacobian = [rate, map] (const Eigen::Vector3d &x)
  {
    Eigen::Matrix3d J = Eigen::AngleAxisd (rate * x.z (), Eigen::Vector3d::UnitZ ()).toRotationMatrix ();
    J.col (2) += rate * Eigen::Vector3d::UnitZ ().cross (map (x));
    return J;
  };
  return erkpa::makeSpaceWarp (map, jacobian);
}

/** \brief Bends the z axis to a circle about (radius, y, 0). */
static erkpa::SpaceWarp::ConstPtr
makeBend (double radius)
{
  const auto map = [radius] (const Eigen::Vector3d &x)
  {
    const double angle = x.z () / radius, r = radius - x.x ();
    return Eigen::Vector3d (radius - r * std::cos (angle), x.y (), r * std::sin (angle));
  };
  const auto jacobian = [radius] (const Eigen::Vector3d &x)
  {
    const double angle = x.z () / radius, stretch = 1.0 - x.x () / radius;
    Eigen::Matrix3d J = Eigen::Matrix3d::Identity ();
    J.col (0) = Eigen::Vector3d (std::cos (angle), 0.0, -std::sin (angle));
    J.col (2) = stretch * Eigen::Vector3d (std::sin (angle), 0.0, std::cos (angle));
    return J;
  };
  return erkpa::makeSpaceWarp (map, jacobian);
}

/** \brief Moves the points; their normals go with the inverse transpose of the Jacobian. */
static Cloud::Ptr
warpPoints (const Cloud &cloud, const erkpa::SpaceWarp &warp)
{
  Cloud::Ptr warped (new Cloud (cloud));
  for (pcl::PointNormal &point : *warped)
  {
    const Eigen::Vector3d x = point.getVector3fMap ().cast<double> (),
                          n = point.getNormalVector3fMap ().cast<double> ();
    point.getVector3fMap () = warp.map (x).cast<float> ();
    point.getNormalVector3fMap () = (warp.jacobian (x).inverse ().transpose () * n).normalized ().cast<float> ();
  }
  return warped;
}

/** \brief The edges of warped points: the same planes, seen through the warp undone. */
static Surfaces
warpEdges (const Surfaces &edges, const erkpa::SpaceWarp::ConstPtr &back)
{
  Surfaces warped;
  for (const erkpa::SharpSurface::ConstPtr &edge : edges)
    warped.push_back (erkpa::makeWarpedSharpSurface (edge, back));
  return warped;
}

static bool
reconstruct (const Cloud::Ptr &cloud, const Surfaces &edges, const erkpa::SpaceWarp::ConstPtr &warp,
             const std::string &file)
{
  erkpa::ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (cloud);
  erkpa.setRadiusSearch (0.25);             // wide: rounds the edges off where nothing is said of them
  erkpa.setOrder (erkpa::Order::QUADRATIC); // the faces of the twisted box are saddles
  erkpa.setGridResolution (140);
  for (const erkpa::SharpSurface::ConstPtr &edge : edges)
    erkpa.addSharpSurface (edge);
  erkpa.setSpaceWarp (warp);
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  std::cout << file << ": " << mesh.polygons.size () << " triangles\n";
  return erkpa.getStatus () == erkpa::Status::OK && pcl::io::savePLYFileBinary (file, mesh) >= 0;
}

int
main (int argc, char **argv)
{
  if (argc != 2)
  {
    std::cerr << "usage: bend_and_twist folder\n";
    return 2;
  }
  const std::string folder = std::string (argv[1]) + "/";
  const double rate = TURN / (2.0 * HALF.z ());
  const auto twist = makeTwist (rate), untwist = makeTwist (-rate), bend = makeBend (1.0 / rate);

  const Cloud::Ptr box = makeBox (), twisted = warpPoints (*box, *twist);
  const Surfaces edges = makeEdges (), twisted_edges = warpEdges (edges, untwist);
  const bool written = pcl::io::savePCDFileASCII (folder + "box_points.pcd", *box) >= 0 &&
                       pcl::io::savePCDFileASCII (folder + "twisted_points.pcd", *twisted) >= 0;

  return written && reconstruct (box, {}, nullptr, folder + "box_classical.ply") &&
                 reconstruct (box, edges, nullptr, folder + "box_enriched.ply") &&
                 reconstruct (twisted, {}, nullptr, folder + "twisted_classical.ply") &&
                 reconstruct (twisted, twisted_edges, nullptr, folder + "twisted_enriched.ply") &&
                 // the surface of the straight points, deformed
                 reconstruct (box, edges, twist, folder + "box_twisted.ply") &&
                 reconstruct (box, edges, bend, folder + "box_bent.ply")
             ? 0
             : 1;
}
