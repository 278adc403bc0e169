// SPDX-License-Identifier: BSD-3-Clause
//
// Sharp edges from the cloud to the mesh: found in the points or given, they are chains of the mesh's edges.
#include "erkpa_tests.h"
#include "mesh_intersections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

using Eigen::Vector3d;
using Stage = ERKPA<pcl::PointNormal>;

namespace
{

const Vector3d HALF (1.0, 0.7, 0.5);
constexpr double EXACT = 1e-4;

/** \brief The box at an odd attitude, so that no edge runs along the grid. */
struct TurnedBox
{
  explicit TurnedBox (int count, double noise = 0.0, const Vector3d &half_lengths = HALF)
      : half (half_lengths), samples (shapes::box (count, half).moved (rotation, 1.0, offset)),
        spacing (std::sqrt (8.0 * (half[0] * half[1] + half[1] * half[2] + half[2] * half[0]) / count))
  {
    std::mt19937 random (8);
    std::normal_distribution<double> normal (0.0, noise * spacing);
    for (Vector3d &p : samples.positions)
      p += noise > 0.0 ? Vector3d (normal (random), normal (random), normal (random)) : Vector3d (0.0, 0.0, 0.0);
  }

  Vector3d
  at (const Vector3d &p) const
  {
    return rotation * p + offset;
  }

  /** \brief How far a point of the crease is from the nearest edge of the box. */
  double
  distanceToEdges (const Vector3d &p) const
  {
    const Vector3d q = (rotation.transpose () * (p - offset)).cwiseAbs () - half;
    double nearest = 1e9;
    for (int axis = 0; axis < 3; ++axis)
      nearest = std::min (nearest, Vector3d (std::max (0.0, q[axis]), q[(axis + 1) % 3], q[(axis + 2) % 3]).norm ());
    return nearest;
  }

  Vector3d half;
  Eigen::Matrix3d rotation = Eigen::AngleAxisd (0.6, Vector3d (0.3, 1.0, 0.5).normalized ()).toRotationMatrix ();
  Vector3d offset{0.13, -0.2, 0.05};
  shapes::Samples samples;
  double spacing;
};

/** \brief A tetrahedron that is thin and runs out into edges of 15 degrees and two sharp tips. */
shapes::Samples
blade (int count)
{
  const std::array<Vector3d, 4> corners{Vector3d (-1.0, 0.0, 0.0), Vector3d (1.0, 0.0, 0.0), Vector3d (0.1, 0.8, 0.1),
                                        Vector3d (-0.1, 0.8, -0.1)};
  const Vector3d middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  std::mt19937 random (6);
  std::uniform_real_distribution<double> unit (0.0, 1.0);
  shapes::Samples samples;
  double total = 0.0;
  const auto area = [&] (int face)
  {
    const auto at = [&] (int i) { return corners[static_cast<std::size_t> ((face + i) % 4)]; };
    const Vector3d normal = (at (1) - at (0)).cross (at (2) - at (0));
    return Vector3d (normal.dot (at (0) - middle) > 0.0 ? normal : -normal);
  };
  for (int face = 0; face < 4; ++face)
    total += area (face).norm ();
  for (int face = 0; face < 4; ++face)
    for (int i = 0; i < static_cast<int> (count * area (face).norm () / total); ++i)
    {
      const double u = std::sqrt (unit (random)), v = unit (random);
      const auto at = [&] (int j) { return corners[static_cast<std::size_t> ((face + j) % 4)]; };
      samples.add ((1.0 - u) * at (0) + u * (1.0 - v) * at (1) + u * v * at (2), area (face).normalized ());
    }
  return samples;
}

/** \brief The two sides of an open sheet of thickness \a gap, 2 long and 1 wide; the upper ends at x = \a end. */
shapes::Samples
twoSheets (double end, double gap, double spacing)
{
  std::mt19937 random (9);
  std::uniform_real_distribution<double> unit (0.0, 1.0);
  shapes::Samples samples;
  for (const bool is_upper : {false, true})
  {
    const double length = is_upper ? end : 2.0;
    for (int i = 0; i < static_cast<int> (length / (spacing * spacing)); ++i)
      samples.add ({length * unit (random), unit (random), is_upper ? gap : 0.0},
                   (is_upper ? 1.0 : -1.0) * Vector3d::UnitZ ());
  }
  return samples;
}

/** \brief The points of a cube's faces on a lattice: many lie on the planes that halve its edges. */
shapes::Samples
latticeCube (double half, double step)
{
  shapes::Samples samples;
  for (int axis = 0; axis < 3; ++axis)
    for (double u = -half + 0.5 * step; u < half; u += step)
      for (double v = -half + 0.5 * step; v < half; v += step)
        for (const double side : {-half, half})
        {
          Vector3d p;
          p[axis] = side;
          p[(axis + 1) % 3] = u;
          p[(axis + 2) % 3] = v;
          samples.add (p, Vector3d::Unit (axis) * (side > 0.0 ? 1.0 : -1.0));
        }
  return samples;
}

/** \brief A mesh with its creases. */
struct SharpMesh
{
  pcl::PolygonMesh pcl;
  erkpa::TriangleMesh mesh;
  std::vector<erkpa::Crease> creases;
  std::vector<int> corners;

  Vector3d
  at (int vertex) const
  {
    return mesh.vertices[static_cast<std::size_t> (vertex)].cast<double> ();
  }
};

SharpMesh
meshOf (Stage &stage)
{
  SharpMesh result;
  stage.reconstruct (result.pcl);
  EXPECT_EQ (stage.getStatus (), Status::OK) << stage.getStatusMessage ();
  result.mesh = fromPcl (result.pcl);
  result.creases = stage.getCreases ();
  result.corners = stage.getCorners ();
  return result;
}

SharpMesh
automaticMeshOf (const shapes::Samples &samples, int threads = 0)
{
  Stage stage;
  stage.setInputCloud (shapes::cloud<pcl::PointNormal> (samples));
  stage.setAutomaticSharpEdges (true);
  stage.setNumberOfThreads (threads);
  return meshOf (stage);
}

void
expectClosedBall (const SharpMesh &result)
{
  EXPECT_MESH_CONTRACT (result.mesh, true);
  const erkpa::MeshTopology topology = erkpa::measureTopology (result.mesh);
  EXPECT_EQ (topology.euler, 2);
  EXPECT_EQ (topology.components, 1u);
}

bool
isEqual (const pcl::PolygonMesh &one, const pcl::PolygonMesh &other)
{
  return one.cloud.data == other.cloud.data && one.polygons.size () == other.polygons.size () &&
         std::equal (one.polygons.begin (), one.polygons.end (), other.polygons.begin (),
                     [] (const pcl::Vertices &a, const pcl::Vertices &b) { return a.vertices == b.vertices; });
}

/** \brief How far a point is from the nearest of the creases' mesh edges. */
double
distanceToCreases (const SharpMesh &result, const Vector3d &p)
{
  double nearest = 1e9;
  for (const erkpa::Crease &crease : result.creases)
    for (std::size_t i = 0; i + 1 < crease.vertices.size (); ++i)
    {
      const Vector3d a = result.at (crease.vertices[i]), way = result.at (crease.vertices[i + 1]) - a;
      const double t = std::clamp (way.dot (p - a) / way.squaredNorm (), 0.0, 1.0);
      nearest = std::min (nearest, (a + t * way - p).norm ());
    }
  return nearest;
}

double
distanceToVertices (const SharpMesh &result, const Vector3d &p)
{
  double nearest = 1e9;
  for (const Eigen::Vector3f &vertex : result.mesh.vertices)
    nearest = std::min (nearest, (vertex.cast<double> () - p).norm ());
  return nearest;
}

/** \brief Every crease is a chain of the mesh's edges. */
void
expectEdgesOfTheMesh (const SharpMesh &result)
{
  std::set<std::pair<int, int>> edges;
  for (const auto &t : result.mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      edges.insert (std::minmax (t[i], t[(i + 1) % 3]));
  for (const erkpa::Crease &crease : result.creases)
  {
    ASSERT_GE (crease.vertices.size (), 2u);
    for (std::size_t i = 0; i + 1 < crease.vertices.size (); ++i)
      EXPECT_EQ (edges.count (std::minmax (crease.vertices[i], crease.vertices[i + 1])), 1u);
  }
}

/** \brief Ends of creases at which no other begins. */
int
freeEnds (const SharpMesh &result)
{
  std::map<int, int> ends;
  for (const erkpa::Crease &crease : result.creases)
    for (const int v : {crease.vertices.front (), crease.vertices.back ()})
      ++ends[v];
  return static_cast<int> (
      std::count_if (ends.begin (), ends.end (), [] (const auto &end) { return end.second == 1; }));
}

/** \brief The creases are the twelve edges of the box and nothing else. An edge may be of several surfaces. */
void
expectEdgesOfTheBox (const TurnedBox &box, const SharpMesh &result, double tolerance)
{
  expectClosedBall (result);
  expectEdgesOfTheMesh (result);
  EXPECT_GE (result.creases.size (), 12u);
  EXPECT_EQ (result.corners.size (), 8u);
  EXPECT_EQ (freeEnds (result), 0);
  double worst = 0.0;
  for (const Vector3d &p : shapes::boxEdgePoints (box.half, 100))
    worst = std::max (worst, distanceToCreases (result, box.at (p)));
  EXPECT_LT (worst, tolerance) << "from the edges to the creases";
  worst = 0.0;
  for (const erkpa::Crease &crease : result.creases)
    for (const int v : crease.vertices)
      worst = std::max (worst, box.distanceToEdges (result.at (v)));
  EXPECT_LT (worst, tolerance) << "from the creases to the edges";
  for (const Vector3d &corner : shapes::boxEdgePoints (box.half, 1))
    EXPECT_LT (distanceToVertices (result, box.at (corner)), tolerance);
}

} // namespace

TEST (SharpEdges, OfABoxAreFoundAndAreChainsOfMeshEdgesFromCornerToCorner)
{
  const TurnedBox box (20000);
  expectEdgesOfTheBox (box, automaticMeshOf (box.samples), EXACT);
}

TEST (SharpEdges, OfABoxGivenByHandAreAsExact)
{
  const TurnedBox box (20000);
  Stage stage;
  stage.setInputCloud (shapes::cloud<pcl::PointNormal> (box.samples));
  for (const Eigen::Vector4d &b : shapes::boxBisectors (HALF))
  {
    const Vector3d normal = box.rotation * b.head<3> ();
    const double offset = b[3] - normal.dot (box.offset);
    ASSERT_TRUE (
        stage.addSharpEdge (coefficients ({float (normal[0]), float (normal[1]), float (normal[2]), float (offset)})));
  }
  expectEdgesOfTheBox (box, meshOf (stage), EXACT);
  EXPECT_TRUE (stage.getFoundSharpSurfaces ().empty ());
}

TEST (SharpEdges, OfABoxFollowFromItsSixFaces)
{
  const TurnedBox box (20000);
  Stage stage;
  stage.setInputCloud (shapes::cloud<pcl::PointNormal> (box.samples));
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
    {
      const Vector3d normal = box.rotation * Vector3d::Unit (axis); // of any side
      const double offset = -side * HALF[axis] - normal.dot (box.offset);
      ASSERT_TRUE (
          stage.addFace (coefficients ({float (normal[0]), float (normal[1]), float (normal[2]), float (offset)})));
    }
  expectEdgesOfTheBox (box, meshOf (stage), EXACT);
  EXPECT_EQ (stage.getFoundSharpSurfaces ().size (), 12u);
}

TEST (SharpEdges, ThatWereFoundGiveTheSameMeshWhenTheyAreGivenBack)
{
  const TurnedBox box (12000);
  Stage stage;
  stage.setInputCloud (shapes::cloud<pcl::PointNormal> (box.samples));
  stage.setAutomaticSharpEdges (true);
  const SharpMesh found = meshOf (stage);
  ASSERT_FALSE (stage.getFoundSharpSurfaces ().empty ());
  stage.setAutomaticSharpEdges (false);
  stage.setSharpSurfaces (stage.getFoundSharpSurfaces ());
  EXPECT_TRUE (isEqual (found.pcl, meshOf (stage).pcl));
  EXPECT_TRUE (stage.getFoundSharpSurfaces ().empty ());
  EXPECT_EQ (stage.getCreases ().size (), found.creases.size ());
}

TEST (SharpEdges, ThatWereFoundGiveTheSameMeshWhenTheyAreSavedAndLoaded)
{
  const std::string path =
      (std::filesystem::temp_directory_path () / ("erkpa_edges_" + std::to_string (std::random_device () ())))
          .string ();
  const TurnedBox box (12000);
  const auto cloud = shapes::cloud<pcl::PointNormal> (box.samples);
  Stage finder, taker;
  finder.setInputCloud (cloud);
  finder.setAutomaticSharpEdges (true);
  const SharpMesh found = meshOf (finder);
  ASSERT_TRUE (finder.saveSharpSurfaces (path));
  ASSERT_TRUE (taker.loadSharpSurfaces (path));
  EXPECT_EQ (taker.getSharpSurfaces ().size (), finder.getFoundSharpSurfaces ().size ());
  taker.setInputCloud (cloud);
  EXPECT_TRUE (isEqual (found.pcl, meshOf (taker).pcl));
  std::filesystem::remove (path);
  EXPECT_FALSE (taker.loadSharpSurfaces (path));
  EXPECT_EQ (taker.getSharpSurfaces ().size (), finder.getFoundSharpSurfaces ().size ());
}

TEST (SharpEdges, LeaveARoundEdgeWhereOneOfThemIsRemoved)
{
  const TurnedBox box (12000);
  Stage stage;
  stage.setInputCloud (shapes::cloud<pcl::PointNormal> (box.samples));
  stage.setAutomaticSharpEdges (true);
  meshOf (stage);
  stage.setAutomaticSharpEdges (false);
  stage.setSharpSurfaces (stage.getFoundSharpSurfaces ());
  const std::size_t count = stage.getSharpSurfaces ().size ();
  const Vector3d middle = box.at ({0.0, HALF[1], HALF[2]});
  for (std::size_t i = count; i-- > 0;) // an edge may be of several
    for (const double t : {-0.7, -0.35, 0.0, 0.35, 0.7})
      if (stage.getSharpSurfaces ()[i]->presence (box.at ({t, HALF[1], HALF[2]}), box.spacing) > 0.5)
      {
        EXPECT_TRUE (stage.removeSharpSurface (i));
        break;
      }
  ASSERT_LT (stage.getSharpSurfaces ().size (), count);
  EXPECT_FALSE (stage.removeSharpSurface (count - 1));
  const SharpMesh result = meshOf (stage);
  expectClosedBall (result);
  EXPECT_GT (distanceToCreases (result, middle), 0.5);
  double others = 0.0, own = 1.0;
  for (double t = -0.6; t <= 0.6; t += 0.05)
  {
    others = std::max (others, distanceToCreases (result, box.at ({t, -HALF[1], HALF[2]})));
    others = std::max (others, distanceToCreases (result, box.at ({t * HALF[0], HALF[1], -HALF[2]})));
    own = std::min (own, distanceToVertices (result, box.at ({t, HALF[1], HALF[2]})));
  }
  EXPECT_LT (others, EXACT);
  EXPECT_GT (own, EXACT);
}

TEST (SharpEdges, OfANoisyBoxAreFoundWithItsCorners)
{
  const TurnedBox box (20000, 0.3);
  const SharpMesh result = automaticMeshOf (box.samples);
  expectClosedBall (result);
  expectEdgesOfTheMesh (result);
  const double tolerance = box.spacing;
  for (const Vector3d &corner : shapes::boxEdgePoints (box.half, 1))
    EXPECT_LT (distanceToVertices (result, box.at (corner)), tolerance);
  double worst = 0.0;
  for (const Vector3d &p : shapes::boxEdgePoints (box.half, 40))
    worst = std::max (worst, distanceToCreases (result, box.at (p)));
  EXPECT_LT (worst, 2.0 * tolerance);
}

TEST (SharpEdges, OfSmoothShapesAreNotFound)
{
  for (const shapes::Samples &shape : {shapes::sphere (8000), shapes::torus (15000, 1.0, 0.4)})
  {
    const SharpMesh result = automaticMeshOf (shape);
    EXPECT_MESH_CONTRACT (result.mesh, true);
    EXPECT_TRUE (result.creases.empty ());
    EXPECT_TRUE (result.corners.empty ());
  }
}

TEST (SharpEdges, OfATinAreTwoClosedCircles)
{
  const double radius = 0.5, height = 0.4;
  const shapes::Samples tin = shapes::tin (15000, radius, height);
  const SharpMesh result = automaticMeshOf (tin);
  expectClosedBall (result);
  expectEdgesOfTheMesh (result);
  EXPECT_EQ (result.creases.size (), 2u);
  EXPECT_TRUE (result.corners.empty ());
  double worst = 0.0;
  for (const erkpa::Crease &crease : result.creases)
  {
    EXPECT_EQ (crease.vertices.front (), crease.vertices.back ());
    for (const int v : crease.vertices)
    {
      const Vector3d p = result.at (v);
      worst = std::max (worst, std::hypot (p.head<2> ().norm () - radius, std::abs (p.z ()) - height));
    }
  }
  EXPECT_LT (worst, 1e-3);
}

TEST (SharpEdges, AreTheSameForAnyNumberOfThreads)
{
  const TurnedBox box (8000, 0.05);
  const SharpMesh one = automaticMeshOf (box.samples, 1), two = automaticMeshOf (box.samples, 2);
  EXPECT_TRUE (isEqual (one.pcl, two.pcl));
  EXPECT_EQ (one.corners, two.corners);
}

TEST (SharpEdges, KeepAThinPlateClosed)
{
  const TurnedBox plate (8000, 0.0, {1.0, 0.7, 0.008});
  ASSERT_LT (2.0 * plate.half[2], plate.spacing);
  const SharpMesh result = automaticMeshOf (plate.samples);
  expectClosedBall (result);
  const double volume = 8.0 * plate.half.prod ();
  EXPECT_NEAR (shapes::volume (result.mesh), volume, 0.1 * volume);
  double farthest = 0.0; // from the two faces, between their edges
  for (const Eigen::Vector3f &v : result.mesh.vertices)
  {
    const Vector3d p = plate.rotation.transpose () * (v.cast<double> () - plate.offset);
    if (((p.cwiseAbs () - plate.half).array ().head<2> () < -plate.spacing).all ())
      farthest = std::max (farthest, std::abs (std::abs (p[2]) - plate.half[2]));
  }
  EXPECT_LT (farthest, 0.05 * plate.half[2]);
}

TEST (SharpEdges, ThatAreAcuteMakeNoTrianglesThatPassThroughEachOther)
{
  const SharpMesh result = automaticMeshOf (blade (12000));
  expectClosedBall (result);
  erkpa::LargeVector<Vector3d> positions;
  std::vector<int> all;
  for (const Eigen::Vector3f &v : result.mesh.vertices)
    positions.emplace_back (v.cast<double> ());
  for (std::size_t t = 0; t < result.mesh.triangles.size (); ++t)
    all.push_back (static_cast<int> (t));
  EXPECT_TRUE (erkpa::findIntersections (positions, result.mesh.triangles, all, 0.03, 0).empty ());
}

TEST (SharpEdges, LeaveASheetItsBorderThoughAnotherGoesOnBesideIt)
{
  const double end = 1.2, spacing = 0.03;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd (0.6, Vector3d (0.3, 1.0, 0.5).normalized ()).toRotationMatrix ();
  const SharpMesh result =
      automaticMeshOf (twoSheets (end, 2.0 * spacing, spacing).moved (turn, 1.0, Vector3d::Zero ()));
  EXPECT_MESH_CONTRACT (result.mesh, false);
  double farthest = 0.0, farthest_below = 0.0;
  for (std::size_t v = 0; v < result.mesh.vertices.size (); ++v)
  {
    const Vector3d position = turn.transpose () * result.at (static_cast<int> (v));
    const bool is_upper = (turn.transpose () * result.mesh.normals[v].cast<double> ()).z () > 0.9;
    double &reached = is_upper ? farthest : farthest_below;
    reached = std::max (reached, position.x ());
  }
  EXPECT_NEAR (farthest, end, 2.0 * spacing);
  EXPECT_NEAR (farthest_below, 2.0, 2.0 * spacing);
}

/** \brief Points on a sharp surface are on either of its sides as rounding has it: for all terms on the same. */
TEST (SharpEdges, OfALatticeAreExactAtTheCornersToo)
{
  const double half = 1.0, step = 0.1;
  Stage stage;
  stage.setInputCloud (shapes::cloud<pcl::PointNormal> (latticeCube (half, step)));
  for (int a = 0; a < 3; ++a)
    for (const float side : {-1.0f, 1.0f})
    {
      std::vector<float> plane (4, 0.0f);
      plane[static_cast<std::size_t> (a)] = 1.0f;
      plane[static_cast<std::size_t> ((a + 1) % 3)] = side;
      ASSERT_TRUE (stage.addSharpEdge (coefficients (plane)));
    }
  const SharpMesh result = meshOf (stage);
  expectClosedBall (result);
  EXPECT_EQ (result.creases.size (), 12u);
  EXPECT_EQ (result.corners.size (), 8u);
  for (const Eigen::Vector3f &v : result.mesh.vertices)
    EXPECT_NEAR (v.cwiseAbs ().maxCoeff (), half, 1e-5);
  for (const int corner : result.corners)
    EXPECT_NEAR ((result.at (corner).cwiseAbs () - Vector3d::Constant (half)).norm (), 0.0, 1e-4);
}

/** \brief What a thread has evaluated before must not decide which points go together. */
TEST (SharpEdges, ThatAreGivenAreTheSameForAnyNumberOfThreads)
{
  const shapes::Samples samples = shapes::box (12000, HALF);
  const auto mesh_with = [&samples] (int threads)
  {
    Stage stage;
    stage.setInputCloud (shapes::cloud<pcl::PointNormal> (samples));
    for (const Eigen::Vector4d &b : shapes::boxBisectors (HALF))
      stage.addSharpEdge (coefficients ({float (b[0]), float (b[1]), float (b[2]), float (b[3])}));
    stage.addSharpSurface (erkpa::makeSharpFunction (
        [] (const Vector3d &x) { return x[0] - 0.2 * std::sin (2.0 * x[1]); },
        [] (const Vector3d &x) { return Vector3d (1.0, -0.4 * std::cos (2.0 * x[1]), 0.0); }));
    stage.setNumberOfThreads (threads);
    return meshOf (stage).mesh;
  };
  const erkpa::TriangleMesh one = mesh_with (1), three = mesh_with (3);
  ASSERT_EQ (one.vertices.size (), three.vertices.size ());
  EXPECT_TRUE (one.triangles == three.triangles);
  for (std::size_t v = 0; v < one.vertices.size (); ++v)
  {
    ASSERT_EQ (one.vertices[v], three.vertices[v]);
    ASSERT_EQ (one.normals[v], three.normals[v]);
  }
}

TEST (SharpEdges, AreFoundWhereNormalsOfSinglePointsAreFlipped)
{
  shapes::Samples samples = shapes::box (6000, HALF);
  for (std::size_t i = 0; i < samples.size (); i += 23)
    samples.normals[i] *= -1.0;
  Stage stage;
  stage.setInputCloud (shapes::cloud<pcl::PointNormal> (samples));
  stage.setAutomaticSharpEdges (true);
  const erkpa::TriangleMesh mesh = meshOf (stage).mesh;
  EXPECT_MESH_CONTRACT (mesh, true);
  EXPECT_EQ (stage.getReport ().topology.euler, 2);
  EXPECT_EQ (stage.getCorners ().size (), 8u);
  EXPECT_GT (stage.getReport ().normals_turned, samples.size () / 25);
}

TEST (SharpEdges, LeaveTheMeshClosedWhereAFewWrongNormalsAlongAnEdgeLookLikeAFace)
{
  TurnedBox box (6000);
  for (std::size_t i = 0; i < box.samples.size (); ++i)
  {
    const Vector3d p = box.rotation.transpose () * (box.samples.positions[i] - box.offset);
    Vector3d &normal = box.samples.normals[i];
    const bool is_on_top = normal.dot (box.rotation.col (2)) > 0.5;
    if (is_on_top && std::abs (p[1]) < 0.5 * HALF[1] && p[0] > HALF[0] - 0.3 * box.spacing)
      normal *= -1.0;
  }
  const SharpMesh result = automaticMeshOf (box.samples);
  expectClosedBall (result);
  double farthest = 0.0;
  for (const Eigen::Vector3f &v : result.mesh.vertices)
  {
    const Vector3d q = (box.rotation.transpose () * (v.cast<double> () - box.offset)).cwiseAbs () - HALF;
    farthest = std::max (farthest, q.cwiseMax (0.0).norm () + std::abs (std::min (0.0, q.maxCoeff ())));
  }
  EXPECT_LT (farthest, 1.5 * box.spacing) << "from the box";
  for (const Vector3d &corner : shapes::boxEdgePoints (box.half, 1))
    EXPECT_LT (distanceToVertices (result, box.at (corner)), EXACT) << "the other edges are as sharp as ever";
}

TEST (SharpEdges, HaveTheNormalsOfEachSideWhereTheyAreSplit)
{
  const TurnedBox box (12000);
  Stage stage;
  stage.setInputCloud (shapes::cloud<pcl::PointNormal> (box.samples));
  stage.setAutomaticSharpEdges (true);
  stage.setSplitNormals (true);
  const SharpMesh result = meshOf (stage);
  EXPECT_EQ (stage.getReport ().topology.euler, 2) << "before they are split";
  EXPECT_EQ (stage.getReport ().topology.boundary_edges, 0u);
  double worst = 1.0;
  for (std::size_t v = 0; v < result.mesh.vertices.size (); ++v)
  {
    const Vector3d n = box.rotation.transpose () * result.mesh.normals[v].cast<double> ();
    worst = std::min (worst, n.cwiseAbs ().maxCoeff ());
  }
  EXPECT_GT (worst, 0.9999) << "each vertex has the normal of one face";
  std::map<std::array<float, 3>, int> copies;
  for (const Eigen::Vector3f &p : result.mesh.vertices)
    ++copies[{p[0], p[1], p[2]}];
  const std::set<int> corners (result.corners.begin (), result.corners.end ());
  for (const erkpa::Crease &crease : result.creases)
    for (const int v : crease.vertices)
    {
      const Eigen::Vector3f &p = result.mesh.vertices[static_cast<std::size_t> (v)];
      EXPECT_EQ ((copies[{p[0], p[1], p[2]}]), corners.count (v) > 0 ? 3 : 2);
    }
}

TEST (SharpEdges, AreInForceInTheirExtentOnly)
{
  const TurnedBox box (12000);
  Stage stage;
  stage.setInputCloud (shapes::cloud<pcl::PointNormal> (box.samples));
  const Eigen::Vector4d bisector = shapes::boxBisectors (HALF).back ();
  const Vector3d normal = box.rotation * bisector.head<3> ();
  const auto plane = coefficients (
      {float (normal[0]), float (normal[1]), float (normal[2]), float (bisector[3] - normal.dot (box.offset))});
  erkpa::Extent::ConstPtr extent;
  std::vector<Vector3d> half_of_the_edge;
  for (double t = 0.0; t <= HALF[0]; t += 0.01)
    half_of_the_edge.push_back (box.at ({t, HALF[1], HALF[2]}));
  ASSERT_TRUE (erkpa::makePointsExtent (half_of_the_edge, 3.0 * box.spacing, extent).ok ());
  EXPECT_FALSE (stage.addSharpEdge (plane, nullptr));
  EXPECT_FALSE (stage.addSharpEdge (coefficients ({0.0f, 0.0f, 0.0f, 1.0f}), extent));
  ASSERT_TRUE (stage.addSharpEdge (plane, extent));
  EXPECT_TRUE (stage.getSharpEdges ().empty ());
  EXPECT_EQ (stage.getSharpSurfaces ().size (), 1u);
  const SharpMesh result = meshOf (stage);
  expectClosedBall (result);
  EXPECT_LT (distanceToCreases (result, box.at ({0.5, HALF[1], HALF[2]})), EXACT);
  EXPECT_GT (distanceToCreases (result, box.at ({-0.5, HALF[1], HALF[2]})), 0.3);
}

/** \brief Where data end, so do the surface without edges and the crease; nothing runs into empty space there. */
TEST (SharpEdges, ReachTheBorderOfTwoOpenFaces)
{
  constexpr double SPACING = 0.025;
  std::mt19937 random (4);
  std::uniform_real_distribution<double> unit (0.0, 1.0);
  shapes::Samples roof;
  for (int i = 0; i < static_cast<int> (2.0 / (SPACING * SPACING)); ++i)
    if (i % 2 == 0)
      roof.add ({unit (random), unit (random), 0.0}, Vector3d::UnitZ ());
    else
      roof.add ({unit (random), 0.0, -unit (random)}, -Vector3d::UnitY ());
  const Eigen::Matrix3d turn = Eigen::AngleAxisd (0.5, Vector3d (0.3, 1.0, 0.5).normalized ()).toRotationMatrix ();
  const SharpMesh result = automaticMeshOf (roof.moved (turn, 1.0, Vector3d::Zero ()));
  EXPECT_MESH_CONTRACT (result.mesh, false);
  ASSERT_EQ (result.creases.size (), 1u);
  Eigen::AlignedBox1d along;
  for (const int v : result.creases.front ().vertices)
    along.extend (Eigen::Matrix<double, 1, 1> (turn.col (0).dot (result.at (v))));
  EXPECT_LT (along.min ()[0], 2.0 * SPACING);
  EXPECT_GT (along.max ()[0], 1.0 - 2.0 * SPACING);
  double farthest = 0.0;
  for (const Eigen::Vector3f &v : result.mesh.vertices)
  {
    const Vector3d p = turn.transpose () * v.cast<double> ();
    farthest = std::max (farthest, std::min (std::abs (p[2]), std::abs (p[1])));
  }
  EXPECT_LT (farthest, 0.25 * SPACING) << "from both faces";
}

TEST (SharpEdges, StayOnSurfacesAtADistanceFromThePoints)
{
  const TurnedBox box (6000);
  Stage stage;
  stage.setInputCloud (shapes::cloud<pcl::PointNormal> (box.samples));
  stage.setAutomaticSharpEdges (true);
  stage.setIsoLevel (2.0 * box.spacing);
  const SharpMesh result = meshOf (stage);
  EXPECT_EQ (stage.getReport ().topology.euler, 2);
  double length = 0.0;
  for (const erkpa::Crease &crease : result.creases)
    for (std::size_t i = 0; i + 1 < crease.vertices.size (); ++i)
      length += (result.at (crease.vertices[i + 1]) - result.at (crease.vertices[i])).norm ();
  EXPECT_GT (length, 0.9 * 8.0 * box.half.sum ());
}
