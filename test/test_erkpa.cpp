// SPDX-License-Identifier: BSD-3-Clause
#include "erkpa_tests.h"

#include <erkpa/large_pages.h>

#include <pcl/search/kdtree.h>
#include <pcl/search/octree.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

template <typename PointT>
class ErkpaWithNormals : public testing::Test
{
};

using PointTypesWithNormals = testing::Types<pcl::PointNormal, pcl::PointXYZRGBNormal, pcl::PointXYZINormal>;
TYPED_TEST_SUITE (ErkpaWithNormals, PointTypesWithNormals);

TYPED_TEST (ErkpaWithNormals, MeshesASphere)
{
  ERKPA<TypeParam> erkpa;
  erkpa.setInputCloud (shapes::cloud<TypeParam> (shapes::sphere (3000)));
  pcl::PolygonMesh mesh = usedMesh ();
  erkpa.reconstruct (mesh);
  EXPECT_EQ (erkpa.getStatus (), Status::OK);
  expectSphere<TypeParam> (mesh);
}

TYPED_TEST (ErkpaWithNormals, GivesTheSameSurfaceThroughBothOverloads)
{
  ERKPA<TypeParam> erkpa;
  erkpa.setInputCloud (shapes::cloud<TypeParam> (shapes::sphere (2000)));
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  pcl::PointCloud<TypeParam> points;
  std::vector<pcl::Vertices> polygons (5);
  erkpa.reconstruct (points, polygons);
  ASSERT_EQ (points.size (), mesh.cloud.width);
  ASSERT_EQ (polygons.size (), mesh.polygons.size ());
  pcl::PointCloud<TypeParam> other;
  pcl::fromPCLPointCloud2 (mesh.cloud, other);
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    EXPECT_EQ (points[i].getVector3fMap (), other[i].getVector3fMap ());
    EXPECT_EQ (points[i].getNormalVector3fMap (), other[i].getNormalVector3fMap ());
  }
  for (std::size_t i = 0; i < polygons.size (); ++i)
    EXPECT_EQ (polygons[i].vertices, mesh.polygons[i].vertices);
}

TEST (Erkpa, IsASurfaceReconstructionOfPcl)
{
  const pcl::SurfaceReconstruction<pcl::PointNormal>::Ptr stage = std::make_shared<ERKPA<pcl::PointNormal>> ();
  stage->setInputCloud (shapes::cloud<pcl::PointNormal> (shapes::sphere (2000)));
  pcl::PolygonMesh mesh;
  stage->reconstruct (mesh);
  expectSphere<pcl::PointNormal> (mesh);
}

TEST (Erkpa, CarriesColourFromThePointsToTheMesh)
{
  const auto cloud = shapes::cloud<pcl::PointXYZRGBNormal> (shapes::sphere (3000));
  for (auto &p : *cloud)
  {
    p.r = p.z > 0.0f ? 200 : 10;
    p.g = 50;
    p.b = p.z > 0.0f ? 10 : 200;
  }
  ERKPA<pcl::PointXYZRGBNormal> erkpa;
  erkpa.setInputCloud (cloud);
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  pcl::PointCloud<pcl::PointXYZRGBNormal> vertices;
  pcl::fromPCLPointCloud2 (mesh.cloud, vertices);
  ASSERT_FALSE (vertices.empty ());
  for (const auto &v : vertices)
  {
    EXPECT_EQ (v.g, 50);
    if (std::abs (v.z) > 0.2f)
    {
      EXPECT_EQ (v.r, v.z > 0.0f ? 200 : 10);
    }
  }
}

TEST (Erkpa, CarriesIntensityFromThePointsToTheMesh)
{
  const auto cloud = shapes::cloud<pcl::PointXYZINormal> (shapes::sphere (3000));
  for (auto &p : *cloud)
    p.intensity = 5.0f + p.x;
  ERKPA<pcl::PointXYZINormal> erkpa;
  erkpa.setInputCloud (cloud);
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  pcl::PointCloud<pcl::PointXYZINormal> vertices;
  pcl::fromPCLPointCloud2 (mesh.cloud, vertices);
  ASSERT_FALSE (vertices.empty ());
  for (const auto &v : vertices)
    EXPECT_NEAR (v.intensity, 5.0f + v.x, 0.02f);
}

TEST (Erkpa, KeepsTheHeaderInMeshAndCloud)
{
  const auto cloud = shapes::cloud<pcl::PointNormal> (shapes::sphere (1000));
  cloud->header.frame_id = "camera_link";
  cloud->header.stamp = 123456;
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (cloud);
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  for (const pcl::PCLHeader &header : {mesh.header, mesh.cloud.header})
  {
    EXPECT_EQ (header.frame_id, "camera_link");
    EXPECT_EQ (header.stamp, 123456u);
  }
  pcl::PointCloud<pcl::PointNormal> points;
  std::vector<pcl::Vertices> polygons;
  erkpa.reconstruct (points, polygons);
  EXPECT_EQ (points.header.frame_id, "camera_link");
}

TEST (Erkpa, UsesOnlyThePointsOfTheIndices)
{
  shapes::Samples scene = shapes::sphere (2000, 1.0, {5.0, 0.0, 0.0});
  const shapes::Samples wanted = shapes::sphere (2000);
  const pcl::IndicesPtr indices (new pcl::Indices);
  for (std::size_t i = 0; i < wanted.size (); ++i)
  {
    indices->push_back (static_cast<int> (scene.size ()));
    scene.add (wanted.positions[i], wanted.normals[i]);
  }
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (shapes::cloud<pcl::PointNormal> (scene));
  erkpa.setIndices (indices);
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  expectSphere<pcl::PointNormal> (mesh);
  EXPECT_EQ (erkpa.getReport ().points.read, 2000u);
}

TEST (Erkpa, RefusesIndicesOutsideTheCloud)
{
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (shapes::cloud<pcl::PointNormal> (shapes::sphere (100)));
  for (const int bad : {-1, 100})
  {
    erkpa.setIndices (std::make_shared<pcl::Indices> (pcl::Indices{0, 1, 2, 3, bad}));
    pcl::PolygonMesh mesh = usedMesh ();
    erkpa.reconstruct (mesh);
    EXPECT_EQ (erkpa.getStatus (), Status::BAD_INDICES);
    expectEmpty (mesh);
  }
}

TEST (Erkpa, SaysThatThereIsNoInput)
{
  ERKPA<pcl::PointNormal> erkpa;
  pcl::PolygonMesh mesh = usedMesh ();
  erkpa.reconstruct (mesh);
  EXPECT_EQ (erkpa.getStatus (), Status::NO_INPUT);
  EXPECT_NE (erkpa.getStatusMessage ().find ("setInputCloud"), std::string::npos);
  expectEmpty (mesh);
  pcl::PointCloud<pcl::PointNormal> points (3, 1);
  std::vector<pcl::Vertices> polygons (2);
  erkpa.reconstruct (points, polygons);
  EXPECT_TRUE (points.empty () && polygons.empty ());
  EXPECT_EQ (erkpa.getField (), nullptr);
}

TEST (Erkpa, SaysThatThereAreTooFewPoints)
{
  for (const int count : {0, 1, 2, 3, 4})
  {
    const auto cloud = shapes::cloud<pcl::PointNormal> (shapes::sphere (count));
    ERKPA<pcl::PointNormal> erkpa;
    erkpa.setInputCloud (cloud);
    pcl::PolygonMesh mesh = usedMesh ();
    erkpa.reconstruct (mesh);
    EXPECT_EQ (erkpa.getStatus (), Status::TOO_FEW_POINTS);
    expectEmpty (mesh);
  }
}

TEST (Erkpa, SurvivesDegenerateCloudsWithAStatus)
{
  shapes::Samples line, spot;
  for (int i = 0; i < 100; ++i)
  {
    line.add ({0.01 * i, 0.0, 0.0}, Eigen::Vector3d::UnitZ ());
    spot.add ({1.0, 2.0, 3.0}, Eigen::Vector3d::UnitZ ());
  }
  for (const shapes::Samples &samples : {line, spot, shapes::sphere (5)})
    for (const bool with_normals : {true, false})
    {
      auto cloud = shapes::cloud<pcl::PointNormal> (samples);
      if (!with_normals)
        for (auto &p : *cloud)
          p.normal_x = p.normal_y = p.normal_z = 0.0f;
      ERKPA<pcl::PointNormal> erkpa;
      erkpa.setInputCloud (cloud);
      pcl::PolygonMesh mesh = usedMesh ();
      erkpa.reconstruct (mesh);
      EXPECT_EQ (mesh.polygons.empty (), erkpa.getStatus () != Status::OK);
      if (erkpa.getStatus () != Status::OK)
        expectEmpty (mesh);
    }
}

TEST (Erkpa, LeavesOutAndCountsNanAndDuplicatePoints)
{
  shapes::Samples samples = shapes::sphere (3000);
  for (std::size_t i = 0; i < 500; ++i)
    samples.add (samples.positions[i], samples.normals[i]);
  const auto cloud = shapes::cloud<pcl::PointNormal> (samples);
  for (std::size_t i = 0; i < 10; ++i)
    (*cloud)[3000 + i].x = NOT_A_NUMBER;
  cloud->is_dense = false;
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (cloud);
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  expectSphere<pcl::PointNormal> (mesh);
  const erkpa::PointCounts &counts = erkpa.getReport ().points;
  EXPECT_EQ (counts.read, 3500u);
  EXPECT_EQ (counts.not_finite, 10u);
  EXPECT_EQ (counts.duplicate, 490u);
  EXPECT_EQ (counts.used, 3000u);
}

TEST (Erkpa, EstimatesNormalsWhereTheyAreZeroOrNan)
{
  const auto cloud = shapes::cloud<pcl::PointNormal> (shapes::sphere (3000));
  for (std::size_t i = 0; i < cloud->size (); ++i)
    if (i % 3 != 0)
      (*cloud)[i].normal_x = (*cloud)[i].normal_y = (*cloud)[i].normal_z = i % 3 == 1 ? 0.0f : NOT_A_NUMBER;
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (cloud);
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  expectSphere<pcl::PointNormal> (mesh);
  EXPECT_EQ (erkpa.getReport ().points.without_normal, 2000u);
}

TEST (Erkpa, OrientsNormalsThatNobodyHasOriented)
{
  shapes::Samples sphere = shapes::sphere (3000);
  for (std::size_t i = 0; i < sphere.size (); ++i)
    sphere.normals[i] *= i * 7 % 11 < 5 ? -1.0 : 1.0;
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (shapes::cloud<pcl::PointNormal> (sphere));
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  expectSphere<pcl::PointNormal> (mesh, -1.0); // towards the sensor in the middle
  EXPECT_TRUE (erkpa.getReport ().normals_contradicted);
}

TEST (Erkpa, EstimatesNormalsOfPointsThatCannotHaveThem)
{
  const auto cloud = shapes::cloud<pcl::PointXYZ> (shapes::sphere (3000));
  ERKPA<pcl::PointXYZ> erkpa;
  erkpa.setInputCloud (cloud);
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh); // the sensor's origin is the middle of the sphere: a room seen from inside
  expectSphere<pcl::PointXYZ> (mesh, -1.0);
  erkpa.setViewPoint (0.0f, 0.0f, 10.0f); // cannot have seen the back
  erkpa.reconstruct (mesh);
  expectSphere<pcl::PointXYZ> (mesh, 1.0);
}

TEST (Erkpa, TakesTheViewPointFromTheSensorUnlessItIsGiven)
{
  const auto cloud = shapes::cloud<pcl::PointXYZ> (shapes::sheet (40, [] (double, double) { return 0.0; }));
  cloud->sensor_origin_ = Eigen::Vector4f (0.0f, 0.0f, -4.0f, 0.0f);
  ERKPA<pcl::PointXYZ> erkpa;
  erkpa.setInputCloud (cloud);
  const auto looks_up = [&] { return erkpa.computeField ()->sample ({0.0, 0.0, 0.0}).gradient.z () > 0.0; };
  EXPECT_FALSE (looks_up ());
  erkpa.setViewPoint (0.0f, 0.0f, 4.0f);
  EXPECT_TRUE (looks_up ());
  erkpa.useSensorOriginAsViewPoint ();
  EXPECT_FALSE (looks_up ());
}

TEST (Erkpa, TakesOrganizedCloudsWithHoles)
{
  const shapes::Samples sheet = shapes::sheet (40, [] (double x, double y) { return 0.1 * x * y; });
  const auto cloud = shapes::cloud<pcl::PointNormal> (sheet);
  cloud->width = cloud->height = 40;
  (*cloud)[777].z = NOT_A_NUMBER;
  cloud->is_dense = false;
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (cloud);
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  EXPECT_EQ (erkpa.getStatus (), Status::OK);
  EXPECT_MESH_CONTRACT (fromPcl (mesh), false);
}

TEST (Erkpa, UsesTheSearchMethodItIsGiven)
{
  const auto cloud = shapes::cloud<pcl::PointNormal> (shapes::sphere (2000));
  pcl::PolygonMesh expected;
  ERKPA<pcl::PointNormal> plain;
  plain.setInputCloud (cloud);
  plain.reconstruct (expected);
  const pcl::search::Search<pcl::PointNormal>::Ptr searches[] = {
      std::make_shared<pcl::search::KdTree<pcl::PointNormal>> (),
      std::make_shared<pcl::search::Octree<pcl::PointNormal>> (0.2),
  };
  for (const auto &search : searches)
  {
    ERKPA<pcl::PointNormal> erkpa;
    erkpa.setInputCloud (cloud);
    erkpa.setSearchMethod (search);
    pcl::PolygonMesh mesh;
    erkpa.reconstruct (mesh);
    EXPECT_EQ (mesh.cloud.data, expected.cloud.data);
    EXPECT_NE (search->getInputCloud (), nullptr);
  }
}

TEST (Erkpa, SharpEdgesTakePlanesOfAnyScaleAndRefuseOthers)
{
  ERKPA<pcl::PointNormal> erkpa;
  EXPECT_TRUE (erkpa.addSharpEdge (coefficients ({0.0f, -20.0f, 0.0f, 4.0f})));
  EXPECT_FALSE (erkpa.addSharpEdge (coefficients ({1.0f, 0.0f, 0.0f})));
  EXPECT_FALSE (erkpa.addSharpEdge (coefficients ({1.0f, 0.0f, 0.0f, 0.0f, 1.0f})));
  EXPECT_FALSE (erkpa.addSharpEdge (coefficients ({0.0f, 0.0f, 0.0f, 1.0f})));
  EXPECT_FALSE (erkpa.addSharpEdge (coefficients ({1.0f, NOT_A_NUMBER, 0.0f, 1.0f})));
  ASSERT_EQ (erkpa.getSharpEdges ().size (), 1u);
  const auto &surface = erkpa.getOptions ().field.sharp_surfaces.front ();
  EXPECT_NEAR (surface->theta ({7.0, 1.2, 3.0}), -1.0, 1e-6);

  EXPECT_FALSE (erkpa.setSharpEdges ({coefficients ({1, 0, 0, 0}), coefficients ({0, 0, 0, 0})}));
  EXPECT_EQ (erkpa.getSharpEdges ().front ().values[1], -20.0f); // as before
  EXPECT_TRUE (erkpa.setSharpEdges ({coefficients ({1, 0, 0, 0}), coefficients ({0, 1, 0, 0})}));
  EXPECT_EQ (erkpa.getOptions ().field.sharp_surfaces.size (), 2u);
  erkpa.clearSharpEdges ();
  EXPECT_TRUE (erkpa.getSharpEdges ().empty ());
  EXPECT_TRUE (erkpa.getOptions ().field.sharp_surfaces.empty ());
}

TEST (Erkpa, SharpEdgesReachTheSurface)
{
  const Eigen::Vector3d half (1.0, 0.7, 0.5);
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (shapes::cloud<pcl::PointNormal> (shapes::box (8000, half)));
  const auto value_on_edge = [&] { return std::abs (erkpa.computeField ()->value ({1.0, 0.7, 0.1})); };
  EXPECT_GT (value_on_edge (), 1e-3);
  for (const Eigen::Vector4d &b : shapes::boxBisectors (half))
    ASSERT_TRUE (erkpa.addSharpEdge (coefficients ({float (b[0]), float (b[1]), float (b[2]), float (b[3])})));
  EXPECT_LT (value_on_edge (), 1e-5);
}

TEST (Erkpa, RefusesSettingsThatMakeNoSenseAndRecovers)
{
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (shapes::cloud<pcl::PointNormal> (shapes::sphere (1000)));
  pcl::PolygonMesh mesh;
  erkpa.setKSearch (2);
  erkpa.reconstruct (mesh);
  EXPECT_EQ (erkpa.getStatus (), Status::INVALID_SETTING);
  expectEmpty (mesh);
  erkpa.setKSearch (0);
  erkpa.setVoxelSize (-1.0);
  erkpa.reconstruct (mesh);
  EXPECT_EQ (erkpa.getStatus (), Status::INVALID_SETTING);
  EXPECT_EQ (erkpa.getField (), nullptr);
  erkpa.setVoxelSize (0.0);
  erkpa.reconstruct (mesh);
  EXPECT_EQ (erkpa.getStatus (), Status::OK);
  EXPECT_TRUE (erkpa.getStatusMessage ().empty ());
  EXPECT_NE (erkpa.getField (), nullptr);
}

TEST (Erkpa, RefusesARadiusFarBeyondTheCloud)
{
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (shapes::cloud<pcl::PointNormal> (shapes::sphere (1000)));
  erkpa.setRadiusSearch (1e6);
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  EXPECT_EQ (erkpa.getStatus (), Status::INVALID_SETTING);
  expectEmpty (mesh);
}

TEST (Erkpa, TakesAnyNumberOfThreads)
{
  ERKPA<pcl::PointXYZ> erkpa;
  erkpa.setInputCloud (shapes::cloud<pcl::PointXYZ> (shapes::sphere (500)));
  erkpa.setNumberOfThreads (1000000000);
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  EXPECT_EQ (erkpa.getStatus (), Status::OK);
}

TEST (Erkpa, FieldIsUndefinedOnceItsSearchServesAnotherCloud)
{
  const auto search = std::make_shared<pcl::search::KdTree<pcl::PointNormal>> ();
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (shapes::cloud<pcl::PointNormal> (shapes::sphere (500)));
  erkpa.setSearchMethod (search);
  const erkpa::ImplicitField::ConstPtr field = erkpa.computeField ();
  EXPECT_TRUE (field->sample ({1.0, 0.0, 0.0}).isDefined ());
  search->setInputCloud (shapes::cloud<pcl::PointNormal> (shapes::sphere (50000)));
  EXPECT_FALSE (field->sample ({1.0, 0.0, 0.0}).isDefined ());
}

TEST (Erkpa, TakesItsOwnSharpEdgesBack)
{
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.addSharpEdge (coefficients ({1, 0, 0, 0}));
  EXPECT_TRUE (erkpa.setSharpEdges (erkpa.getSharpEdges ()));
  EXPECT_EQ (erkpa.getSharpEdges ().size (), 1u);
}

TEST (Erkpa, MayWriteItsResultOverItsInput)
{
  const auto cloud = shapes::cloud<pcl::PointNormal> (shapes::sphere (1000));
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (cloud);
  std::vector<pcl::Vertices> polygons;
  erkpa.reconstruct (*cloud, polygons);
  EXPECT_EQ (erkpa.getStatus (), Status::OK);
  EXPECT_EQ (cloud->size (), erkpa.getReport ().vertices);
}

TEST (Erkpa, KeepsItsShapeFarFromTheOriginOfTheFrame)
{
  const Eigen::Vector3d far (1000.0, -2000.0, 500.0); // float still resolves a ten-thousandth of the radius there
  const shapes::Samples sphere = shapes::sphere (3000, 1.0, far);
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (shapes::cloud<pcl::PointNormal> (sphere));
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  erkpa::TriangleMesh near = fromPcl (mesh);
  for (Eigen::Vector3f &v : near.vertices)
    v -= far.cast<float> ();
  EXPECT_EQ (shapes::defects (near).open_edges, 0);
  EXPECT_NEAR (shapes::volume (near), 4.0 / 3.0 * M_PI, 0.03);
}

TEST (Erkpa, ReconstructsACloudWhoseFieldsAreKnownAtRunTime)
{
  pcl::PCLPointCloud2 cloud;
  pcl::toPCLPointCloud2 (*shapes::cloud<pcl::PointXYZINormal> (shapes::sphere (2000)), cloud);
  pcl::PolygonMesh mesh;
  erkpa::Report report;
  erkpa::ImplicitField::ConstPtr field;
  EXPECT_TRUE (erkpa::reconstruct (cloud, {}, mesh, report, &field).ok ());
  expectSphere<pcl::PointXYZINormal> (mesh);
  ASSERT_NE (field, nullptr);
  EXPECT_NEAR (field->value ({1.1, 0.0, 0.0}), 0.1, 0.01);
  EXPECT_EQ (report.triangles, mesh.polygons.size ());
}

TEST (Erkpa, GivesTheLibrarysOwnMeshOfACloudWhoseFieldsAreKnownAtRunTime)
{
  pcl::PCLPointCloud2 cloud;
  pcl::toPCLPointCloud2 (*shapes::cloud<pcl::PointNormal> (shapes::sphere (2000)), cloud);
  pcl::PolygonMesh mesh;
  erkpa::TriangleMesh triangles;
  erkpa::Report report;
  ASSERT_TRUE (erkpa::reconstruct (cloud, {}, mesh, report).ok ());
  ASSERT_TRUE (erkpa::reconstruct (cloud, {}, triangles, report).ok ());
  ASSERT_EQ (triangles.triangles.size (), mesh.polygons.size ());
  EXPECT_EQ (triangles.vertices.size (), mesh.cloud.width);
  for (std::size_t t = 0; t < mesh.polygons.size (); ++t)
    ASSERT_TRUE (std::equal (triangles.triangles[t].begin (), triangles.triangles[t].end (),
                             mesh.polygons[t].vertices.begin ()));
}

TEST (Erkpa, KeepsTheFirstOfManyPointsThatRepeatEachOther)
{
  constexpr int COUNT = 100000;
  std::vector<Eigen::Vector3f> positions;
  for (int i = 0; i < COUNT; ++i) // the second half repeats the first, with the other zero
    positions.emplace_back (static_cast<float> (i % (COUNT / 2)), static_cast<float> (i % 7),
                            i < COUNT / 2 ? 0.0f : -0.0f);
  for (int i = COUNT / 2; i < COUNT; ++i)
    positions[static_cast<std::size_t> (i)].y () = static_cast<float> ((i - COUNT / 2) % 7);
  erkpa::PointView view;
  view.size = positions.size ();
  view.stride = sizeof (Eigen::Vector3f);
  view.position = positions.front ().data ();
  erkpa::OrientedPoints one, many;
  erkpa::PointCounts counts;
  ASSERT_TRUE (erkpa::collectPoints (view, one, counts, 1).ok ());
  EXPECT_EQ (counts.duplicate, std::size_t (COUNT / 2));
  ASSERT_EQ (one.size (), std::size_t (COUNT / 2));
  for (std::size_t i = 0; i < one.size (); ++i)
    ASSERT_EQ (one.positions[i], (positions[i].cast<double> () - one.origin).cast<float> ());
  ASSERT_TRUE (erkpa::collectPoints (view, many, counts, 4).ok ());
  EXPECT_EQ (one.positions, many.positions);
}

TEST (Erkpa, MakesTheSameMeshInLargePages)
{
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (shapes::cloud<pcl::PointNormal> (shapes::sphere (3000)));
  pcl::PolygonMesh before, after;
  erkpa.reconstruct (before);
  erkpa::preferLargePages ();
  erkpa.reconstruct (after);
  ASSERT_FALSE (before.polygons.empty ());
  EXPECT_EQ (before.cloud.data, after.cloud.data);
  EXPECT_FALSE (erkpa::preferLargePages (1000)) << "less than two of them";
}

TEST (Erkpa, RefusesAnEmptyCloudWhoseFieldsAreKnownAtRunTime)
{
  pcl::PolygonMesh mesh = usedMesh ();
  erkpa::Report report;
  EXPECT_EQ (erkpa::reconstruct (pcl::PCLPointCloud2 (), {}, mesh, report).status, Status::TOO_FEW_POINTS);
  expectEmpty (mesh);
}
