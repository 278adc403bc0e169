// SPDX-License-Identifier: BSD-3-Clause
//
// What the class takes beside the cloud: sharp surfaces, fields and lists of the points, interpolation, warps.
#include "erkpa_tests.h"

#include <algorithm>

TEST (Erkpa, TakesSharpSurfacesByTheirModelOfSampleConsensus)
{
  ERKPA<pcl::PointNormal> erkpa;
  const auto ball = coefficients ({1.0f, 0.0f, 0.0f, 0.8f});
  const auto tube = coefficients ({0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.7f});
  EXPECT_TRUE (erkpa.addSharpEdge (ball, pcl::SACMODEL_SPHERE));
  EXPECT_TRUE (erkpa.addSharpEdge (tube, pcl::SACMODEL_CYLINDER));
  EXPECT_TRUE (erkpa.addSharpEdge (tube, pcl::SACMODEL_CONE));
  EXPECT_TRUE (erkpa.addSharpEdge (ball, pcl::SACMODEL_NORMAL_PLANE));
  EXPECT_FALSE (erkpa.addSharpEdge (ball, pcl::SACMODEL_CYLINDER));
  EXPECT_FALSE (erkpa.addSharpEdge (ball, pcl::SACMODEL_TORUS));
  EXPECT_FALSE (erkpa.addSharpEdge (ball, pcl::SACMODEL_PLANE, ball, pcl::SACMODEL_PLANE)); // parallel
  EXPECT_FALSE (erkpa.addSharpEdge (ball, pcl::SACMODEL_SPHERE, ball, pcl::SACMODEL_CONE));
  EXPECT_TRUE (erkpa.addSharpEdge (ball, pcl::SACMODEL_SPHERE, ball, pcl::SACMODEL_PLANE));
  EXPECT_EQ (erkpa.getOptions ().field.sharp_surfaces.size (), 5u);
  EXPECT_EQ (erkpa.getSharpEdges ().size (), 1u); // the plane
  erkpa.addSharpSurface (erkpa::makeSharpFunction ([] (const Eigen::Vector3d &x) { return x.z (); },
                                                   [] (const Eigen::Vector3d &) { return Eigen::Vector3d::UnitZ (); }));
  erkpa.addSharpSurface (nullptr);
  EXPECT_EQ (erkpa.getOptions ().field.sharp_surfaces.size (), 6u);
  erkpa.setInputCloud (shapes::cloud<pcl::PointNormal> (shapes::sphere (3000)));
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  ASSERT_EQ (erkpa.getStatus (), Status::OK) << erkpa.getStatusMessage ();
  expectSphere<pcl::PointNormal> (mesh);
  erkpa.clearSharpEdges ();
  EXPECT_TRUE (erkpa.getOptions ().field.sharp_surfaces.empty ());
}

TEST (Erkpa, TakesRadiiFromAFieldOfTheCloudOrFromAList)
{
  const auto cloud = shapes::cloud<pcl::PointNormal> (shapes::sphere (3000));
  std::vector<float> radii;
  for (pcl::PointNormal &point : *cloud)
  {
    point.curvature = 0.25f + 0.05f * point.z;
    radii.push_back (point.curvature);
  }
  ERKPA<pcl::PointNormal> by_field, by_list;
  pcl::PolygonMesh of_field, of_list;
  by_field.setInputCloud (cloud);
  by_field.setRadiusField ("curvature");
  by_field.reconstruct (of_field);
  by_list.setInputCloud (cloud);
  by_list.setRadii (radii);
  by_list.reconstruct (of_list);
  ASSERT_EQ (by_field.getStatus (), Status::OK) << by_field.getStatusMessage ();
  expectSphere<pcl::PointNormal> (of_field);
  EXPECT_EQ (of_field.cloud.data, of_list.cloud.data);
}

TEST (Erkpa, LeavesOutPointsOfNoConfidence)
{
  const auto cloud = shapes::cloud<pcl::PointXYZINormal> (shapes::sphere (3000));
  for (pcl::PointXYZINormal &point : *cloud)
    point.intensity = 0.7f;
  pcl::PointXYZINormal stray;
  stray.x = 0.4f;
  stray.normal_x = 1.0f;
  for (int i = 0; i < 40; ++i)
  {
    stray.y = 0.01f * static_cast<float> (i);
    cloud->push_back (stray);
  }
  ERKPA<pcl::PointXYZINormal> erkpa;
  erkpa.setInputCloud (cloud);
  erkpa.setConfidenceField ("intensity");
  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  ASSERT_EQ (erkpa.getStatus (), Status::OK) << erkpa.getStatusMessage ();
  EXPECT_EQ (erkpa.getReport ().points.no_confidence, 40u);
  expectSphere<pcl::PointXYZINormal> (mesh);
}

TEST (Erkpa, RefusesWhatIsNotGivenForEveryPoint)
{
  const auto cloud = shapes::cloud<pcl::PointNormal> (shapes::sphere (500));
  const auto status = [&] (auto set)
  {
    ERKPA<pcl::PointNormal> erkpa;
    erkpa.setInputCloud (cloud);
    set (erkpa);
    pcl::PolygonMesh mesh = usedMesh ();
    erkpa.reconstruct (mesh);
    expectEmpty (mesh);
    EXPECT_FALSE (erkpa.getStatusMessage ().empty ());
    return erkpa.getStatus ();
  };
  using Stage = ERKPA<pcl::PointNormal>;
  const Eigen::Matrix3f wide = 0.5f * Eigen::Matrix3f::Identity ();
  EXPECT_EQ (status ([] (Stage &s) { s.setRadii ({0.1f, 0.2f}); }), Status::INVALID_SETTING);
  EXPECT_EQ (status ([] (Stage &s) { s.setRadii (std::vector<float> (500, -1.0f)); }), Status::INVALID_SETTING);
  EXPECT_EQ (status ([] (Stage &s) { s.setRadii (std::vector<float> (500, NOT_A_NUMBER)); }), Status::INVALID_SETTING);
  EXPECT_EQ (status ([] (Stage &s) { s.setConfidences ({1.0f}); }), Status::INVALID_SETTING);
  EXPECT_EQ (status ([&] (Stage &s) { s.setSupportShapes (std::vector<Eigen::Matrix3f> (500, wide)); }),
             Status::INVALID_SETTING);
  EXPECT_EQ (status ([] (Stage &s) { s.setRadiusField ("nothing"); }), Status::INVALID_SETTING);
  EXPECT_EQ (status (
                 [] (Stage &s)
                 {
                   s.setRadii (std::vector<float> (500, 0.3f));
                   s.setKSearch (20);
                 }),
             Status::INVALID_SETTING);
  EXPECT_EQ (status ([] (Stage &s) { s.setConfidences (std::vector<float> (500, 0.0f)); }), Status::TOO_FEW_POINTS);
  EXPECT_EQ (status ([] (Stage &s) { s.setRadiusFunction ([] (const Eigen::Vector3d &) { return -1.0; }); }),
             Status::INVALID_SETTING);
  const auto huge_on_one_side = [] (const Eigen::Vector3d &x) { return x.z () > 0.3 ? 1e30 : 0.3; };
  EXPECT_EQ (status ([&] (Stage &s) { s.setRadiusFunction (huge_on_one_side); }), Status::INVALID_SETTING);
  EXPECT_EQ (status (
                 [] (Stage &s)
                 {
                   s.setSupportShapes (std::vector<Eigen::Matrix3f> (500, Eigen::Matrix3f::Identity ()));
                   s.setFlatten (0.5);
                 }),
             Status::INVALID_SETTING);
  const auto nowhere = erkpa::makeSpaceWarp ([] (const Eigen::Vector3d &x) { return Eigen::Vector3d (x / 0.0); },
                                             [] (const Eigen::Vector3d &) { return Eigen::Matrix3d::Identity (); });
  EXPECT_EQ (status ([&] (Stage &s) { s.setSpaceWarp (nowhere); }), Status::INVALID_SETTING);
}

TEST (Erkpa, InterpolatesByCollocation)
{
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (shapes::cloud<pcl::PointNormal> (shapes::torus (2500, 1.0, 0.4)));
  erkpa.setInterpolation (erkpa::Interpolation::COLLOCATION);
  double last = 0.0;
  erkpa.setProgressCallback ([&last] (double done) { last = done; });
  const erkpa::ImplicitField::ConstPtr field = erkpa.computeField ();
  ASSERT_NE (field, nullptr) << erkpa.getStatusMessage ();
  EXPECT_EQ (last, 1.0);
  EXPECT_EQ (erkpa.getReport ().collocation.unknowns, 2500u);
  for (const Eigen::Vector3f &p : field->points ().positions)
    ASSERT_NEAR (field->value (p.cast<double> () + field->points ().origin), 0.0, 1e-6);
}

TEST (Erkpa, GivesTheMeshOfTheWarpedSpace)
{
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (shapes::cloud<pcl::PointNormal> (shapes::sphere (3000)));
  erkpa.setSpaceWarp (erkpa::makeSpaceWarp (
      [] (const Eigen::Vector3d &x) { return Eigen::Vector3d (2.0 * x.x (), x.y () + 5.0, x.z ()); },
      [] (const Eigen::Vector3d &) { return Eigen::Matrix3d (Eigen::Vector3d (2.0, 1.0, 1.0).asDiagonal ()); }));
  pcl::PolygonMesh output;
  erkpa.reconstruct (output);
  const erkpa::TriangleMesh mesh = fromPcl (output);
  EXPECT_MESH_CONTRACT (mesh, true);
  EXPECT_NEAR (shapes::volume (mesh), 2.0 * 4.0 / 3.0 * M_PI, 0.04);
}

TEST (Erkpa, RemembersEverySetting)
{
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setOffset (0.3);
  erkpa.setEnrichment (erkpa::EnrichmentType::JUMP);
  erkpa.setConstraint (erkpa::Constraint::FUNCTIONAL);
  erkpa.setKernel (erkpa::KernelType::GAUSSIAN);
  erkpa.setFlatten (0.5);
  erkpa.setRadiusRamp ({2, 0.1, 0.2});
  erkpa.setConfidenceField ("trust");
  erkpa.setMomentTolerance (0.002);
  EXPECT_EQ (erkpa.getOffset (), 0.3);
  EXPECT_EQ (erkpa.getEnrichment (), erkpa::EnrichmentType::JUMP);
  EXPECT_EQ (erkpa.getConstraint (), erkpa::Constraint::FUNCTIONAL);
  EXPECT_EQ (erkpa.getKernel (), erkpa::KernelType::GAUSSIAN);
  EXPECT_EQ (erkpa.getFlatten (), 0.5);
  EXPECT_EQ (erkpa.getMomentTolerance (), 0.002);
  EXPECT_EQ (erkpa.getRadiusRamp ().axis, 2);
  EXPECT_EQ (erkpa.getConfidenceField (), "trust");
  EXPECT_EQ (erkpa.getOptions ().points.confidence_field, "trust");
}

TEST (Erkpa, LetsNothingThroughThatACallerThrows)
{
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (shapes::cloud<pcl::PointNormal> (shapes::sphere (500)));
  erkpa.setRadiusFunction ([] (const Eigen::Vector3d &) -> double { throw 3; });
  pcl::PolygonMesh mesh = usedMesh ();
  EXPECT_NO_THROW (erkpa.reconstruct (mesh));
  expectEmpty (mesh);
  EXPECT_EQ (erkpa.getStatus (), Status::INTERNAL_ERROR);
  EXPECT_EQ (erkpa.getField (), nullptr);
}

TEST (Erkpa, ReadsFieldsOfRunTimeCloudsWithPaddedRowsAndRefusesBadOnes)
{
  pcl::PCLPointCloud2 packed, padded;
  const auto points = shapes::cloud<pcl::PointNormal> (shapes::sphere (3000));
  for (pcl::PointNormal &point : *points)
    point.curvature = 0.25f + 0.05f * point.z;
  pcl::toPCLPointCloud2 (*points, packed);
  padded = packed;
  padded.width = 100;
  padded.height = 30;
  padded.row_step = 100 * packed.point_step + 24;
  padded.data.assign (std::size_t (padded.row_step) * padded.height, 0xff);
  for (std::size_t row = 0; row < 30; ++row)
    std::copy_n (packed.data.begin () + static_cast<std::ptrdiff_t> (row * 100 * packed.point_step),
                 100 * packed.point_step, padded.data.begin () + static_cast<std::ptrdiff_t> (row * padded.row_step));
  erkpa::Options options;
  options.points.radius_field = "curvature";
  pcl::PolygonMesh of_packed, of_padded;
  erkpa::Report report;
  ASSERT_TRUE (erkpa::reconstruct (packed, options, of_packed, report).ok ());
  const erkpa::Outcome outcome = erkpa::reconstruct (padded, options, of_padded, report);
  ASSERT_TRUE (outcome.ok ()) << outcome.message;
  EXPECT_EQ (of_packed.cloud.data, of_padded.cloud.data);

  for (pcl::PCLPointField &field : packed.fields)
    if (field.name == "curvature")
      field.offset = 1000000;
  EXPECT_EQ (erkpa::reconstruct (packed, options, of_packed, report).status, Status::BAD_CLOUD);
  expectEmpty (of_packed);
  padded.data.resize (padded.data.size () / 2);
  EXPECT_EQ (erkpa::reconstruct (padded, options, of_padded, report).status, Status::BAD_CLOUD);
  expectEmpty (of_padded);
}

TEST (Erkpa, KnowsWhereItsSurfaceIsToBeSharp)
{
  ERKPA<pcl::PointNormal> erkpa;
  EXPECT_FALSE (erkpa.getAutomaticSharpEdges ());
  EXPECT_EQ (erkpa.getSharpAngle (), 25.0);
  EXPECT_TRUE (erkpa.getSharpenNormals ());
  EXPECT_FALSE (erkpa.getSplitNormals ());
  erkpa.setSharpAngle (40.0);
  erkpa.setSharpenNormals (false);
  erkpa.setSplitNormals (true);
  erkpa.setFaceTolerance (0.01);
  EXPECT_EQ (erkpa.getOptions ().sharp.angle, 40.0);
  EXPECT_FALSE (erkpa.getOptions ().normals.sharpen);
  EXPECT_TRUE (erkpa.getOptions ().polygonizer.split_normals);
  EXPECT_EQ (erkpa.getOptions ().sharp.face_tolerance, 0.01);
  EXPECT_TRUE (erkpa.addFace (coefficients ({0.0f, 0.0f, 2.0f, 1.0f})));
  EXPECT_TRUE (erkpa.addFace (coefficients ({0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.5f}), pcl::SACMODEL_CYLINDER));
  EXPECT_FALSE (erkpa.addFace (coefficients ({0.0f, 0.0f, 0.0f, 1.0f})));
  EXPECT_FALSE (erkpa.addFace (coefficients ({0.0f, 0.0f, 0.0f, 1.0f}), pcl::SACMODEL_LINE));
  ASSERT_EQ (erkpa.getFaces ().size (), 2u);
  EXPECT_EQ (erkpa.getFaces ()[1].model, erkpa::SurfaceModel::CYLINDER);
  erkpa.clearFaces ();
  EXPECT_TRUE (erkpa.getFaces ().empty ());
}

TEST (Erkpa, KeepsThePlanesOfSharpEdgesAmongOtherSurfaces)
{
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.addSharpEdge (coefficients ({1, 0, 0, 0}));
  erkpa.addSharpEdge (coefficients ({0, 0, 0, 1}), pcl::SACMODEL_SPHERE);
  erkpa.addSharpEdge (coefficients ({0, 2, 0, 0}));
  EXPECT_FALSE (erkpa.removeSharpSurface (3));
  EXPECT_TRUE (erkpa.removeSharpSurface (0));
  ASSERT_EQ (erkpa.getSharpSurfaces ().size (), 2u);
  ASSERT_EQ (erkpa.getSharpEdges ().size (), 1u);
  EXPECT_EQ (erkpa.getSharpEdges ()[0].values[1], 2.0f);
  erkpa.setSharpSurfaces ({nullptr, erkpa.getSharpSurfaces ()[1], shapes::plane ({0.0, 0.0, 1.0, 0.0})});
  EXPECT_EQ (erkpa.getSharpSurfaces ().size (), 2u);
  EXPECT_EQ (erkpa.getSharpEdges ().size (), 1u) << "only those given as coefficients";
  erkpa.setSharpSurfaces (erkpa.getSharpSurfaces ()); // its own
  EXPECT_EQ (erkpa.getSharpSurfaces ().size (), 2u);
  erkpa.setSharpSurfaces ({});
  EXPECT_TRUE (erkpa.getSharpEdges ().empty ());
}

TEST (Erkpa, RefusesAnAngleAndAToleranceThatMakeNoSense)
{
  ERKPA<pcl::PointNormal> erkpa;
  erkpa.setInputCloud (shapes::cloud<pcl::PointNormal> (shapes::sphere (500)));
  erkpa.setAutomaticSharpEdges (true);
  pcl::PolygonMesh mesh = usedMesh ();
  for (const double angle : {0.0, 4.9, 91.0, double (NOT_A_NUMBER)})
  {
    erkpa.setSharpAngle (angle);
    erkpa.reconstruct (mesh);
    EXPECT_EQ (erkpa.getStatus (), Status::INVALID_SETTING) << angle;
    EXPECT_NE (erkpa.getStatusMessage ().find ("5 to 90"), std::string::npos);
    expectEmpty (mesh);
    EXPECT_TRUE (erkpa.getCreases ().empty ());
  }
  erkpa.setSharpAngle (25.0);
  ASSERT_TRUE (erkpa.addFace (coefficients ({0.0f, 0.0f, 1.0f, 0.0f})));
  erkpa.setFaceTolerance (-1.0);
  erkpa.reconstruct (mesh);
  EXPECT_EQ (erkpa.getStatus (), Status::INVALID_SETTING);
  EXPECT_NE (erkpa.getStatusMessage ().find ("tolerance"), std::string::npos);
}
