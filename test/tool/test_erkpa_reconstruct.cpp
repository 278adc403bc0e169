// SPDX-License-Identifier: BSD-3-Clause
//
// Runs the program as a user does, on clouds of a sphere, and looks at what it leaves behind.
#include "erkpa_reconstruct_test.h"

#include <nlohmann/json.hpp>
#include <pcl/io/pcd_io.h>

#include <sstream>

namespace
{

TEST_F (ErkpaReconstruct, ReplacesTheFileALinkLeadsTo)
{
  write ("target.ply", "old");
  std::filesystem::create_symlink ("target.ply", path ("link.ply"));
  ASSERT_EQ (runCoarse ("sphere.xyz link.ply").status, 0);
  EXPECT_TRUE (std::filesystem::is_symlink (path ("link.ply")));
  expectSphere ("target.ply");
}

TEST_F (ErkpaReconstruct, PrintsEveryDefaultOnHelp)
{
  for (const std::string option : {"-h", "-help", "--help"})
  {
    const Result result = run (option);
    EXPECT_EQ (result.status, 0) << option;
    EXPECT_EQ (result.err, "") << option;
    for (const std::string name : {"-k",
                                   "-radius",
                                   "-order",
                                   "-constraint",
                                   "-sharp",
                                   "-voxel",
                                   "-resolution",
                                   "-iso",
                                   "-moment_tolerance",
                                   "-viewpoint",
                                   "-threads",
                                   "-evaluate",
                                   "-report",
                                   "-radius_ramp",
                                   "-radius_field",
                                   "-confidence_field",
                                   "-flatten",
                                   "-kernel",
                                   "-offset",
                                   "-interpolate",
                                   "-enrichment",
                                   "-sharp_sphere",
                                   "-sharp_cylinder",
                                   "-sharp_cone",
                                   "-sharp_edges",
                                   "-face",
                                   "-face_tolerance",
                                   "-sharp_auto",
                                   "-sharp_angle",
                                   "-save_sharp_edges",
                                   "-creases",
                                   "-split_normals"})
    {
      const std::size_t at = result.out.find ("\n    " + name + " ");
      ASSERT_NE (at, std::string::npos) << name;
      EXPECT_LT (result.out.find ("(default: ", at), result.out.find ('\n', at + 1)) << name;
    }
  }
}

TEST_F (ErkpaReconstruct, TakesValuesThatBeginWithAMinus)
{
  ASSERT_EQ (runCoarse ("sphere.xyz out.ply -iso -0.05 -viewpoint -1,-2,-3").status, 0);
  expectSphere ("out.ply", 0.95);
  for (const std::string sharp : {"-sharp -1,0,0,0.5", "-sharp=-1,0,0,.5", "--sharp -1,0,0,0.5", "-sharp -2,0,0,1"})
  {
    ASSERT_EQ (runCoarse ("sphere.xyz " + sharp + " out_sharp.ply -sharp 0,0,1,0").status, 0) << sharp;
    expectSphere ("out_sharp.ply");
  }
}

TEST_F (ErkpaReconstruct, DoesNotCareForDashesOrThreads)
{
  ASSERT_EQ (runCoarse ("sphere.xyz one.ply -k 25 -order linear -threads 1").status, 0);
  ASSERT_EQ (runCoarse ("--k=25 --order linear sphere.xyz --threads=2 two.ply").status, 0);
  EXPECT_EQ (read ("one.ply"), read ("two.ply"));
  EXPECT_NE (read ("one.ply"), "");
}

TEST_F (ErkpaReconstruct, EvaluatesTheSignedDistance)
{
  std::ostringstream queries;
  for (const Eigen::Vector3d &p : fibonacciSphere (50))
    for (const double radius : {0.95, 1.0, 1.05})
      queries << (radius * p).transpose () << "\n";
  write ("query.xyz", queries.str () + "10 20 -30\n");
  const Result result = runCoarse ("-evaluate query.xyz values.txt sphere.xyz out.ply -radius 0.25");
  ASSERT_EQ (result.status, 0) << result.err;
  expectSphere ("out.ply");

  std::istringstream values (read ("values.txt"));
  for (int i = 0; i < 150; ++i)
  {
    Eigen::Vector3d x, gradient;
    double f = 0.0;
    ASSERT_TRUE (values >> x[0] >> x[1] >> x[2] >> f >> gradient[0] >> gradient[1] >> gradient[2]);
    EXPECT_NEAR (f, x.norm () - 1.0, 0.002);
    EXPECT_NEAR (gradient.norm (), 1.0, 1.1 * std::abs (x.norm () - 1.0) + 0.002);
    EXPECT_NEAR (gradient.normalized ().dot (x.normalized ()), 1.0, 0.001);
  }
  std::string rest;
  std::getline (values >> std::ws, rest);
  EXPECT_EQ (rest, "10 20 -30 nan nan nan nan");
  EXPECT_FALSE (std::getline (values, rest));
}

TEST_F (ErkpaReconstruct, ReportsTheSumsThatEvaluationsAreInterpolatedFrom)
{
  write ("a.xyz", sphereRows (true));
  const auto sums_of = [this] (const std::string &option)
  {
    EXPECT_EQ (run ("a.xyz out.ply -radius 1 -voxel 0.05 -report r.json" + option).status, 0);
    return nlohmann::json::parse (read ("r.json"))["moment_sums"].get<int> ();
  };
  const int by_default = sums_of ("");
  EXPECT_GT (by_default, 0);
  EXPECT_GT (sums_of (" -moment_tolerance 0.005"), by_default);
  EXPECT_EQ (sums_of (" -moment_tolerance 0"), 0);
}

TEST_F (ErkpaReconstruct, ReportsWhatItDid)
{
  write ("a.xyz", sphereRows (true) + "nan 0 0 1 0 0\n0 0 5 0 0 0\n0 0 5 0 0 0\n");
  ASSERT_EQ (run ("a.xyz out.ply -k 20 -voxel 0.1 -report r.json").status, 0);
  const nlohmann::json report = nlohmann::json::parse (read ("r.json"));
  EXPECT_EQ (report["points"]["read"], 3003);
  EXPECT_EQ (report["points"]["used"], 3001);
  EXPECT_EQ (report["points"]["not_finite"], 1);
  EXPECT_EQ (report["points"]["duplicate"], 1);
  EXPECT_EQ (report["points"]["without_normal"], 1);
  EXPECT_NE (report["orientation"], "none");
  EXPECT_EQ (report["k"], 20);
  EXPECT_EQ (report["radius"], 0.0);
  EXPECT_NEAR (report["spacing"], std::sqrt (4.0 * M_PI / 3000.0), 0.03);
  EXPECT_DOUBLE_EQ (report["voxel_size"], 0.1);
  EXPECT_GT (report["evaluations"], 100);
  EXPECT_GT (report["mean_nodes_per_evaluation"], 4.0);
  const auto mesh = load ("out.ply");
  EXPECT_EQ (report["mesh"]["triangles"], mesh.polygons.size ());
  EXPECT_EQ (report["mesh"]["vertices"], mesh.cloud.width * mesh.cloud.height);
  EXPECT_EQ (report["mesh"]["boundary_edges"], 0);
  EXPECT_EQ (report["mesh"]["components"], 1);
  EXPECT_EQ (report["mesh"]["euler"], 2);
  EXPECT_TRUE (report["mesh"]["dropped_components"].is_number ());
  EXPECT_GT (report["peak_memory_mb"], 1.0);
  EXPECT_TRUE (report["version"].is_string ());
  double sum = 0.0;
  for (const std::string stage : {"read", "points", "normals", "sharp", "field", "polygonizer", "evaluate", "write"})
    sum += report["seconds"][stage].get<double> ();
  EXPECT_GT (sum, 0.0);
  EXPECT_LE (sum, report["seconds"]["total"]);
  double of_polygonizer = 0.0;
  for (const std::string stage : {"grid", "vertices", "triangles", "creases", "slivers"})
    of_polygonizer += report["seconds"]["of_polygonizer"][stage].get<double> ();
  EXPECT_GT (of_polygonizer, 0.0);
  EXPECT_LE (of_polygonizer, report["seconds"]["polygonizer"]);
}

TEST_F (ErkpaReconstruct, TakesTheViewPointFromThePcdUnlessItIsGiven)
{
  pcl::PointCloud<pcl::PointXYZ> plane;
  for (int i = 0; i < 900; ++i)
    plane.push_back (pcl::PointXYZ (0.1f * static_cast<float> (i % 30), 0.1f * static_cast<float> (i / 30), 0.0f));
  plane.sensor_origin_ = Eigen::Vector4f (1.5f, 1.5f, -9.0f, 0.0f);
  pcl::io::savePCDFileBinary (path ("plane.pcd"), plane);
  ASSERT_EQ (run ("plane.pcd below.ply").status, 0);
  ASSERT_EQ (run ("plane.pcd above.ply -viewpoint 1.5,1.5,9").status, 0);
  EXPECT_NEAR (loadVertices<pcl::PointNormal> ("below.ply").at (0).normal_z, -1.0f, 0.01f);
  EXPECT_NEAR (loadVertices<pcl::PointNormal> ("above.ply").at (0).normal_z, 1.0f, 0.01f);
}

TEST_F (ErkpaReconstruct, PrintsTimingsAndNothingOnStderr)
{
  const Result result = runCoarse ("sphere.xyz out.ply");
  EXPECT_EQ (result.status, 0);
  EXPECT_EQ (result.err, "");
  for (const std::string words : {"Loading", "Computing", "Saving", "[done, ", " ms : 3000 points]"})
    EXPECT_NE (result.out.find (words), std::string::npos) << result.out;
}

TEST_F (ErkpaReconstruct, MeshesByEveryConstraintKernelAndInterpolation)
{
  const std::string options[] = {"-constraint functional",   "-constraint offsurface -offset 0.3",
                                 "-kernel wendland_c4",      "-kernel gaussian -constraint functional",
                                 "-interpolate collocation", "-interpolate collocation -constraint offsurface",
                                 "-interpolate singular",    "-flatten 0.5 -k 40",
                                 "-radius_ramp z,0.2,0.4",   "-constraint functional -enrichment jump -sharp 0,0,1,0"};
  for (const std::string &option : options)
  {
    const Result result = runCoarse ("sphere.xyz out.ply " + option);
    ASSERT_EQ (result.status, 0) << option << ": " << result.err;
    expectSphere ("out.ply");
  }
}

TEST_F (ErkpaReconstruct, MakesSharpEdgesWhereOtherSurfacesThanPlanesCut)
{
  for (const std::string sharp : {"-sharp_sphere 1,0,0,0.8", "-sharp_cylinder 0,0,0,0,0,1,0.7",
                                  "-sharp_cone 0,0,0,0,0,1,0.8", "-sharp_sphere=-1,0,0,0.8 -sharp_sphere 0,1,0,0.8"})
  {
    ASSERT_EQ (runCoarse ("sphere.xyz out.ply " + sharp).status, 0) << sharp;
    expectSphere ("out.ply"); // nothing there to be sharp
  }
}

TEST_F (ErkpaReconstruct, TakesRadiiAndConfidencesFromFieldsOfTheCloud)
{
  std::ostringstream ply;
  const auto points = fibonacciSphere (3000);
  ply << "ply\nformat ascii 1.0\nelement vertex " << points.size () + 30 << "\n";
  for (const char *name : {"x", "y", "z", "nx", "ny", "nz", "reach", "trust"})
    ply << "property float " << name << "\n";
  ply << "end_header\n";
  for (const Eigen::Vector3d &p : points)
    ply << p.transpose () << " " << p.transpose () << " " << 0.25 + 0.05 * p.z () << " 0.8\n";
  for (int i = 0; i < 30; ++i) // stray points that nobody trusts
    ply << "0.5 0 " << 0.01 * i << " 0 0 1 0.3 0\n";
  write ("fields.ply", ply.str ());
  const Result result = runCoarse ("fields.ply out.ply -radius_field reach -confidence_field trust -report r.json");
  ASSERT_EQ (result.status, 0) << result.err;
  expectSphere ("out.ply");
  const auto report = nlohmann::json::parse (read ("r.json"));
  EXPECT_EQ (report["points"]["no_confidence"], 30);
  EXPECT_EQ (report["points"]["used"], 3000);
}

TEST_F (ErkpaReconstruct, EvaluatesTheFieldWithoutAMesh)
{
  write ("query.xyz", "0 0 1.05\n0 0 0.95\n");
  const Result result = run ("sphere.xyz -evaluate query.xyz values.txt -report r.json");
  ASSERT_EQ (result.status, 0) << result.err;
  std::istringstream values (read ("values.txt"));
  double x = 0.0, f = 0.0;
  ASSERT_TRUE (values >> x >> x >> x >> f);
  EXPECT_NEAR (f, 0.05, 2e-3);
  EXPECT_EQ (nlohmann::json::parse (read ("r.json"))["mesh"]["triangles"], 0);
}

TEST_F (ErkpaReconstruct, PassesThroughTheNodesByCollocation)
{
  std::ostringstream rows;
  const auto points = fibonacciSphere (1500);
  for (const Eigen::Vector3d &p : points) // far from round
    rows << (p * (1.0 + 0.05 * p.x () * p.y ())).transpose () << " " << p.transpose () << "\n";
  write ("bumpy.xyz", rows.str ());
  for (const std::string constraint : {"hermite", "functional", "offsurface"})
  {
    ASSERT_EQ (
        run ("bumpy.xyz -interpolate collocation -evaluate bumpy.xyz values.txt -constraint " + constraint).status, 0);
    std::istringstream values (read ("values.txt"));
    double x = 0.0, f = 0.0, largest = 0.0;
    while (values >> x >> x >> x >> f >> x >> x >> x)
      largest = std::max (largest, std::abs (f));
    EXPECT_LT (largest, 2e-6) << constraint; // 1e-5 of the support radius, about 0.23
  }
}

} // namespace
