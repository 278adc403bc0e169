// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/reconstruction.h>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <utility>
#include <vector>

/** \brief Shapes with a known surface, and what a mesh of them must measure. */
namespace shapes
{

struct Samples
{
  std::vector<Eigen::Vector3d> positions, normals;

  void
  add (const Eigen::Vector3d &position, const Eigen::Vector3d &normal)
  {
    positions.push_back (position);
    normals.push_back (normal);
  }

  std::size_t
  size () const
  {
    return positions.size ();
  }

  /** \brief The same samples, moved: p -> scale R p + offset. */
  Samples
  moved (const Eigen::Matrix3d &rotation, double scale, const Eigen::Vector3d &offset) const
  {
    Samples result;
    for (std::size_t i = 0; i < size (); ++i)
      result.add (scale * (rotation * positions[i]) + offset, rotation * normals[i]);
    return result;
  }
};

/** \brief Points spread evenly over a sphere. */
inline Samples
sphere (int count, double radius = 1.0, const Eigen::Vector3d &center = Eigen::Vector3d::Zero ())
{
  Samples samples;
  for (int i = 0; i < count; ++i)
  {
    const double z = 1.0 - (2.0 * i + 1.0) / count, turn = M_PI * (1.0 + std::sqrt (5.0)) * i;
    const double r = std::sqrt (1.0 - z * z);
    const Eigen::Vector3d n (r * std::cos (turn), r * std::sin (turn), z);
    samples.add (center + radius * n, n);
  }
  return samples;
}

/** \brief Points spread at random, evenly by area, over a torus around the z axis. */
inline Samples
torus (int count, double ring, double tube)
{
  std::mt19937 random (3);
  std::uniform_real_distribution<double> unit (0.0, 1.0);
  Samples samples;
  while (static_cast<int> (samples.size ()) < count)
  {
    const double u = 2.0 * M_PI * unit (random), v = 2.0 * M_PI * unit (random);
    if (unit (random) * (ring + tube) > ring + tube * std::cos (v))
      continue;
    const Eigen::Vector3d out (std::cos (u), std::sin (u), 0.0);
    const Eigen::Vector3d n = std::cos (v) * out + std::sin (v) * Eigen::Vector3d::UnitZ ();
    samples.add (ring * out + tube * n, n);
  }
  return samples;
}

/** \brief Points spread at random over the faces of a box around the origin. */
inline Samples
box (int count, const Eigen::Vector3d &half, unsigned seed = 5)
{
  std::mt19937 random (seed);
  std::uniform_real_distribution<double> unit (-1.0, 1.0);
  const Eigen::Vector3d areas (half[1] * half[2], half[0] * half[2], half[0] * half[1]);
  std::discrete_distribution<int> axis_of ({areas[0], areas[1], areas[2]});
  Samples samples;
  for (int i = 0; i < count; ++i)
  {
    const int axis = axis_of (random);
    Eigen::Vector3d p (unit (random) * half[0], unit (random) * half[1], unit (random) * half[2]);
    Eigen::Vector3d n = Eigen::Vector3d::Zero ();
    n[axis] = unit (random) < 0.0 ? -1.0 : 1.0;
    p[axis] = n[axis] * half[axis];
    samples.add (p, n);
  }
  return samples;
}

/** \brief Points spread at random, evenly by area, over a cylinder with its two caps, around the z axis. */
inline Samples
tin (int count, double radius, double half_height, unsigned seed = 5)
{
  std::mt19937 random (seed);
  std::uniform_real_distribution<double> unit (0.0, 1.0);
  const double share_of_caps = radius / (radius + 2.0 * half_height);
  Samples samples;
  for (int i = 0; i < count; ++i)
  {
    const double turn = 2.0 * M_PI * unit (random), part = unit (random), place = unit (random);
    const Eigen::Vector3d out (std::cos (turn), std::sin (turn), 0.0), up = Eigen::Vector3d::UnitZ ();
    const double side = unit (random) < 0.5 ? -1.0 : 1.0;
    if (part < share_of_caps)
      samples.add (radius * std::sqrt (place) * out + side * half_height * up, side * up);
    else
      samples.add (radius * out + (2.0 * place - 1.0) * half_height * up, out);
  }
  return samples;
}

/** \brief The planes that halve the twelve edges of the box, as a, b, c, d. */
inline std::vector<Eigen::Vector4d>
boxBisectors (const Eigen::Vector3d &half)
{
  std::vector<Eigen::Vector4d> planes;
  for (int a = 0; a < 3; ++a)
    for (int b = a + 1; b < 3; ++b)
      for (const double sa : {-1.0, 1.0})
        for (const double sb : {-1.0, 1.0})
        {
          Eigen::Vector3d normal = Eigen::Vector3d::Zero (), edge = Eigen::Vector3d::Zero ();
          normal[a] = sa * M_SQRT1_2;
          normal[b] = -sb * M_SQRT1_2;
          edge[a] = sa * half[a];
          edge[b] = sb * half[b];
          planes.emplace_back (normal[0], normal[1], normal[2], -normal.dot (edge));
        }
  return planes;
}

/** \brief Points along the twelve edges of that box, corners included, \a steps to an edge. */
inline std::vector<Eigen::Vector3d>
boxEdgePoints (const Eigen::Vector3d &half, int steps)
{
  std::vector<Eigen::Vector3d> points;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sb : {-1.0, 1.0})
      for (const double sc : {-1.0, 1.0})
        for (int i = 0; i <= steps; ++i)
        {
          Eigen::Vector3d p;
          p[axis] = (2.0 * i / steps - 1.0) * half[axis];
          p[(axis + 1) % 3] = sb * half[(axis + 1) % 3];
          p[(axis + 2) % 3] = sc * half[(axis + 2) % 3];
          points.push_back (p);
        }
  return points;
}

/** \brief An open sheet: points on a jittered square grid over -1..1, at z = height (x, y). */
template <typename HeightT>
Samples
sheet (int side, HeightT height)
{
  std::mt19937 random (7);
  std::uniform_real_distribution<double> jitter (-0.3, 0.3);
  Samples samples;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
    {
      const double x = (2.0 * (i + 0.5 + jitter (random))) / side - 1.0;
      const double y = (2.0 * (j + 0.5 + jitter (random))) / side - 1.0;
      constexpr double STEP = 1e-5;
      const double slope_x = (height (x + STEP, y) - height (x - STEP, y)) / (2 * STEP);
      const double slope_y = (height (x, y + STEP) - height (x, y - STEP)) / (2 * STEP);
      samples.add ({x, y, height (x, y)}, Eigen::Vector3d (-slope_x, -slope_y, 1.0).normalized ());
    }
  return samples;
}

inline erkpa::SharpSurface::ConstPtr
plane (const Eigen::Vector4d &coefficients)
{
  const double length = coefficients.head<3> ().norm ();
  return std::make_shared<erkpa::SharpPlane> (coefficients.head<3> () / length, coefficients[3] / length);
}

inline std::shared_ptr<erkpa::OrientedPoints>
points (const Samples &samples)
{
  const auto result = std::make_shared<erkpa::OrientedPoints> ();
  for (std::size_t i = 0; i < samples.size (); ++i)
  {
    result->positions.emplace_back (samples.positions[i].cast<float> ());
    result->normals.emplace_back (samples.normals[i].cast<float> ());
  }
  return result;
}

inline std::shared_ptr<erkpa::ImplicitField>
field (const std::shared_ptr<erkpa::OrientedPoints> &points, const erkpa::FieldOptions &options = {})
{
  return std::make_shared<erkpa::ImplicitField> (points, erkpa::makeKdTreeSearch (points->positions), options);
}

inline std::shared_ptr<erkpa::ImplicitField>
field (const Samples &samples, const erkpa::FieldOptions &options = {})
{
  return field (points (samples), options);
}

template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr
cloud (const Samples &samples)
{
  const typename pcl::PointCloud<PointT>::Ptr result (new pcl::PointCloud<PointT>);
  for (std::size_t i = 0; i < samples.size (); ++i)
  {
    PointT point;
    point.getVector3fMap () = samples.positions[i].cast<float> ();
    if constexpr (pcl::traits::has_field<PointT, pcl::fields::normal_x>::value)
      point.getNormalVector3fMap () = samples.normals[i].cast<float> ();
    result->push_back (point);
  }
  return result;
}

inline double
volume (const erkpa::TriangleMesh &mesh)
{
  double sum = 0.0;
  for (const auto &t : mesh.triangles)
  {
    const auto at = [&] (std::size_t i)
    { return Eigen::Vector3d (mesh.vertices[static_cast<std::size_t> (t[i])].cast<double> ()); };
    sum += at (0).dot (at (1).cross (at (2))) / 6.0;
  }
  return sum;
}

inline double
area (const erkpa::TriangleMesh &mesh)
{
  double sum = 0.0;
  for (const auto &t : mesh.triangles)
  {
    const auto at = [&] (std::size_t i)
    { return Eigen::Vector3d (mesh.vertices[static_cast<std::size_t> (t[i])].cast<double> ()); };
    sum += 0.5 * (at (1) - at (0)).cross (at (2) - at (0)).norm ();
  }
  return sum;
}

/** \brief What the mesh contract forbids, counted without the library's own code. */
struct Defects
{
  int open_edges = 0;   ///< edges of one triangle
  int bad_edges = 0;    ///< edges of three or more triangles, or of two that disagree about the outside
  int bad_vertices = 0; ///< vertices around which the triangles form more than one fan
  int unused_vertices = 0;
  int flat_triangles = 0; ///< no area, or a vertex used twice
  int bad_normals = 0;    ///< not of unit length
};

inline Defects
defects (const erkpa::TriangleMesh &mesh)
{
  Defects found;
  std::map<std::pair<int, int>, int> directed;
  std::map<int, std::map<int, int>> around; // per vertex: from neighbour to neighbour across its triangles
  for (const auto &t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i)
    {
      const int a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
      ++directed[{a, b}];
      around[a][b] = c;
    }
  for (const auto &[edge, count] : directed)
  {
    found.bad_edges += count > 1;
    found.open_edges += directed.count ({edge.second, edge.first}) == 0;
  }
  for (auto &[vertex, links] : around)
  {
    int fans = 0;
    std::set<int> ends;
    for (const auto &[from, to] : links)
      ends.insert (to);
    for (const auto &[from, to] : links)
      fans += ends.count (from) == 0; // an open fan starts here
    std::set<int> seen;
    for (const auto &[from, to] : links)
    {
      if (seen.count (from))
        continue;
      int at = from;
      while (links.count (at) && seen.insert (at).second)
        at = links.at (at);
      fans += at == from; // a closed fan
    }
    found.bad_vertices += fans != 1;
  }
  found.unused_vertices = static_cast<int> (mesh.vertices.size () - around.size ());
  for (const auto &t : mesh.triangles)
  {
    const auto at = [&] (std::size_t i)
    { return Eigen::Vector3d (mesh.vertices[static_cast<std::size_t> (t[i])].cast<double> ()); };
    found.flat_triangles += !((at (1) - at (0)).cross (at (2) - at (0)).norm () > 0.0);
  }
  for (const Eigen::Vector3f &n : mesh.normals)
    found.bad_normals += !(std::abs (n.norm () - 1.0f) < 1e-4f);
  return found;
}

} // namespace shapes

/** \brief Fails where a mesh breaks the contract; border edges are allowed in an open one. */
#define EXPECT_MESH_CONTRACT(mesh, closed)                                                                             \
  {                                                                                                                    \
    const shapes::Defects found = shapes::defects (mesh);                                                              \
    EXPECT_FALSE ((mesh).triangles.empty ());                                                                          \
    EXPECT_EQ (found.bad_edges, 0);                                                                                    \
    EXPECT_EQ (found.bad_vertices, 0);                                                                                 \
    EXPECT_EQ (found.unused_vertices, 0);                                                                              \
    EXPECT_EQ (found.flat_triangles, 0);                                                                               \
    EXPECT_EQ (found.bad_normals, 0);                                                                                  \
    EXPECT_TRUE (!(closed) || found.open_edges == 0) << found.open_edges << " open edges";                             \
  }
