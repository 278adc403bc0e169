// SPDX-License-Identifier: BSD-3-Clause
//
// Real point sets: those of Debian's libcgal-demo (ERKPA_CGAL_DATA) and, where they are at hand, larger scans
// (ERKPA_TEST_DATA).
#include "shapes.h"

#include <erkpa/erkpa.h>

#include <pcl/io/pcd_io.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace
{

/** \brief The path of a file in the folder that an environment variable names; empty where there is none. */
std::string
pathOf (const char *variable, const std::string &file)
{
  const char *folder = std::getenv (variable);
  const std::string path = folder ? std::string (folder) + "/" + file : "";
  return !path.empty () && std::ifstream (path).good () ? path : "";
}

shapes::Samples
readPointsWithNormals (const std::string &path)
{
  shapes::Samples samples;
  std::ifstream file (path);
  std::string line;
  if (path.substr (path.rfind ('.')) == ".ply")
    while (std::getline (file, line) && line.substr (0, 10) != "end_header")
      continue;
  while (std::getline (file, line)) // there may be more after the normal
  {
    std::istringstream numbers (line);
    Eigen::Vector3d p, n;
    if (numbers >> p[0] >> p[1] >> p[2] >> n[0] >> n[1] >> n[2])
      samples.add (p, n);
  }
  return samples;
}

/** \brief The mesh with the sharp edges that are found in the points. */
pcl::PolygonMesh
sharpMeshOf (const shapes::Samples &samples, erkpa::ERKPA<pcl::PointNormal> &stage)
{
  pcl::PolygonMesh mesh;
  stage.setInputCloud (shapes::cloud<pcl::PointNormal> (samples));
  stage.setAutomaticSharpEdges (true);
  stage.reconstruct (mesh);
  return mesh;
}

/** \brief Points at random, evenly by area, over the triangles of an OFF file, with the triangles' normals. */
shapes::Samples
sampleOff (const std::string &path, int count, unsigned seed)
{
  std::ifstream file (path);
  std::string magic;
  std::size_t vertex_count = 0, face_count = 0, edge_count = 0;
  file >> magic >> vertex_count >> face_count >> edge_count;
  std::vector<Eigen::Vector3d> vertices (vertex_count);
  for (Eigen::Vector3d &v : vertices)
    file >> v[0] >> v[1] >> v[2];
  std::vector<std::array<std::size_t, 3>> faces (face_count);
  std::vector<double> areas;
  for (auto &f : faces)
  {
    int corners = 0;
    file >> corners >> f[0] >> f[1] >> f[2];
    areas.push_back ((vertices[f[1]] - vertices[f[0]]).cross (vertices[f[2]] - vertices[f[0]]).norm ());
  }
  std::mt19937 random (seed);
  std::discrete_distribution<std::size_t> pick (areas.begin (), areas.end ());
  std::uniform_real_distribution<double> unit (0.0, 1.0);
  shapes::Samples samples;
  for (int i = 0; i < count; ++i)
  {
    const auto &f = faces[pick (random)];
    const Eigen::Vector3d a = vertices[f[1]] - vertices[f[0]], b = vertices[f[2]] - vertices[f[0]];
    double u = unit (random), v = unit (random);
    if (u + v > 1.0)
    {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    samples.add (vertices[f[0]] + u * a + v * b, a.cross (b).normalized ());
  }
  return samples;
}

erkpa::TriangleMesh
meshOf (const shapes::Samples &samples)
{
  erkpa::TriangleMesh mesh;
  erkpa::PolygonizerReport report;
  const erkpa::Outcome outcome = erkpa::polygonize (*shapes::field (samples), {}, mesh, report);
  EXPECT_TRUE (outcome.ok ()) << outcome.message;
  return mesh;
}

} // namespace

TEST (PointSets, KittenIsClosedWithOneHandle)
{
  const std::string path = pathOf ("ERKPA_CGAL_DATA", "points_3/kitten.xyz");
  if (path.empty ())
    GTEST_SKIP () << "needs points_3/kitten.xyz of libcgal-demo in ERKPA_CGAL_DATA";
  const erkpa::TriangleMesh mesh = meshOf (readPointsWithNormals (path));
  EXPECT_MESH_CONTRACT (mesh, true);
  const erkpa::MeshTopology topology = erkpa::measureTopology (mesh);
  EXPECT_EQ (topology.components, 1u);
  EXPECT_EQ (topology.euler, 0);
}

TEST (PointSets, NoisySphereHasNoSharpEdges)
{
  const std::string path = pathOf ("ERKPA_CGAL_DATA", "points_3/sphere_20k_normal.xyz");
  if (path.empty ())
    GTEST_SKIP () << "needs points_3/sphere_20k_normal.xyz of libcgal-demo in ERKPA_CGAL_DATA";
  erkpa::ERKPA<pcl::PointNormal> stage;
  sharpMeshOf (readPointsWithNormals (path), stage);
  EXPECT_TRUE (stage.getFoundSharpSurfaces ().empty ());
  EXPECT_EQ (stage.getReport ().topology.boundary_edges, 0u);
  EXPECT_EQ (stage.getReport ().topology.components, 1u);
  EXPECT_EQ (stage.getReport ().topology.euler, 2);
}

TEST (PointSets, BallIsClosedWithItsSharpEdgesFound)
{
  const std::string path = pathOf ("ERKPA_CGAL_DATA", "points_3/ball.ply");
  if (path.empty ())
    GTEST_SKIP () << "needs points_3/ball.ply of libcgal-demo in ERKPA_CGAL_DATA";
  erkpa::ERKPA<pcl::PointNormal> stage;
  sharpMeshOf (readPointsWithNormals (path), stage);
  EXPECT_FALSE (stage.getFoundSharpSurfaces ().empty ());
  EXPECT_EQ (stage.getReport ().topology.boundary_edges, 0u);
  EXPECT_EQ (stage.getReport ().topology.components, 1u);
}

TEST (PointSets, FandiskIsClosedAtAnyNumberOfSamples)
{
  const std::string path = pathOf ("ERKPA_CGAL_DATA", "meshes/fandisk.off");
  if (path.empty ())
    GTEST_SKIP () << "needs meshes/fandisk.off of libcgal-demo in ERKPA_CGAL_DATA";
  for (const int count : {10000, 30000})
    for (unsigned seed = 1; seed <= 2; ++seed)
    {
      const erkpa::TriangleMesh mesh = meshOf (sampleOff (path, count, seed));
      EXPECT_MESH_CONTRACT (mesh, true);
      const erkpa::MeshTopology topology = erkpa::measureTopology (mesh);
      EXPECT_EQ (topology.components, 1u) << count << " samples, seed " << seed;
      EXPECT_EQ (topology.euler, 2) << count << " samples, seed " << seed;
    }
}

TEST (PointSets, KinectSceneBecomesAnOpenSurfaceThatFacesTheSensor)
{
  const std::string path = pathOf ("ERKPA_TEST_DATA", "boxes_on_table_kinect.pcd");
  if (path.empty ())
    GTEST_SKIP () << "needs boxes_on_table_kinect.pcd in ERKPA_TEST_DATA";
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud (new pcl::PointCloud<pcl::PointXYZ>);
  ASSERT_EQ (pcl::io::loadPCDFile (path, *cloud), 0);
  erkpa::ERKPA<pcl::PointXYZ> erkpa;
  erkpa.setInputCloud (cloud);
  erkpa.setVoxelSize (0.006);
  pcl::PolygonMesh output;
  erkpa.reconstruct (output);
  ASSERT_EQ (erkpa.getStatus (), erkpa::Status::OK);
  EXPECT_GT (erkpa.getReport ().points.not_finite, 0u);
  pcl::PointCloud<pcl::PointNormal> vertices;
  pcl::fromPCLPointCloud2 (output.cloud, vertices);
  std::size_t facing = 0;
  for (const pcl::PointNormal &v : vertices)
    facing += v.getNormalVector3fMap ().dot (v.getVector3fMap ()) < 0.0f;
  EXPECT_GT (static_cast<double> (facing), 0.99 * static_cast<double> (vertices.size ()));
}
