// SPDX-License-Identifier: BSD-3-Clause
#include "cell_loops.h"
#include "cube_sketch.h"
#include "loop_triangulation.h"
#include "plane_meeting.h"
#include "shapes.h"
#include "surface_feet.h"

#include <erkpa/marching_cubes.h>
#include <erkpa/sharp_detection.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

using Eigen::Vector3d;
using erkpa::PolygonizerOptions;
using erkpa::Status;
using erkpa::TriangleMesh;

namespace
{

TriangleMesh
meshOf (const erkpa::ImplicitField &field, const PolygonizerOptions &options = {},
        erkpa::PolygonizerReport *report = nullptr)
{
  TriangleMesh mesh;
  erkpa::PolygonizerReport own;
  const erkpa::Outcome outcome = erkpa::polygonize (field, options, mesh, report ? *report : own);
  EXPECT_TRUE (outcome.ok ()) << outcome.message;
  return mesh;
}

PolygonizerOptions
resolution (int cells)
{
  PolygonizerOptions options;
  options.resolution = cells;
  return options;
}

} // namespace

TEST (CellLoops, UseEachCrossingOnceInEverySignPattern)
{
  std::mt19937 random (1);
  std::uniform_real_distribution<double> size (0.01, 1.0);
  for (int pattern = 0; pattern < 256 * 20; ++pattern)
  {
    std::array<double, 8> values;
    for (std::size_t corner = 0; corner < 8; ++corner)
      values[corner] = (pattern >> corner & 1 ? -1.0 : 1.0) * size (random);
    const erkpa::CellLoops loops = erkpa::traceLoops (values);
    std::array<int, 12> uses{};
    for (int loop = 0; loop < loops.count; ++loop)
    {
      EXPECT_GE (loops.lengths[static_cast<std::size_t> (loop)], 3);
      for (int i = 0; i < loops.lengths[static_cast<std::size_t> (loop)]; ++i)
        ++uses[static_cast<std::size_t> (loops.edges[static_cast<std::size_t> (loop)][static_cast<std::size_t> (i)])];
    }
    for (int e = 0; e < 12; ++e)
    {
      const erkpa::CellEdge edge = erkpa::cellEdge (e);
      const bool crossed = (values[static_cast<std::size_t> (edge.corner)] < 0.0) !=
                           (values[static_cast<std::size_t> (edge.corner | 1 << edge.axis)] < 0.0);
      EXPECT_EQ (uses[static_cast<std::size_t> (e)], crossed ? 1 : 0);
    }
  }
}

TEST (MeshTopology, CountsEdgesPiecesAndBorders)
{
  erkpa::TriangleMesh mesh;
  mesh.vertices.resize (8, Eigen::Vector3f::Zero ());
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {7, 6, 5}}; // three at one edge, and one alone
  for (const int threads : {1, 3})
  {
    const erkpa::MeshTopology topology = erkpa::measureTopology (mesh, threads);
    EXPECT_EQ (topology.boundary_edges, 9u);
    EXPECT_EQ (topology.non_manifold_edges, 1u);
    EXPECT_EQ (topology.components, 2u);
    EXPECT_EQ (topology.euler, 8 - 10 + 4);
  }
}

TEST (CellLoops, RunCounterClockwiseSeenFromOutside)
{
  std::array<double, 8> values;
  values.fill (1.0);
  values[0] = -1.0;
  const erkpa::CellLoops loops = erkpa::traceLoops (values);
  ASSERT_EQ (loops.count, 1);
  ASSERT_EQ (loops.lengths[0], 3);
  std::array<Vector3d, 3> at;
  for (std::size_t i = 0; i < 3; ++i)
    at[i] = 0.5 * Vector3d::Unit (erkpa::cellEdge (loops.edges[0][i]).axis);
  EXPECT_GT ((at[1] - at[0]).cross (at[2] - at[0]).sum (), 0.0); // away from the corner inside
}

TEST (Polygonizer, MakesAClosedSphereOfTheRightVolumeAndArea)
{
  const TriangleMesh mesh = meshOf (*shapes::field (shapes::sphere (4000, 2.0, {1.0, 2.0, 3.0})));
  EXPECT_MESH_CONTRACT (mesh, true);
  const erkpa::MeshTopology topology = erkpa::measureTopology (mesh);
  EXPECT_EQ (topology.components, 1u);
  EXPECT_EQ (topology.euler, 2);
  EXPECT_NEAR (shapes::volume (mesh), 4.0 / 3.0 * M_PI * 8.0, 0.005 * 4.0 / 3.0 * M_PI * 8.0);
  EXPECT_NEAR (shapes::area (mesh), 4.0 * M_PI * 4.0, 0.005 * 4.0 * M_PI * 4.0);
  for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
  {
    const Vector3d out = mesh.vertices[v].cast<double> () - Vector3d (1.0, 2.0, 3.0);
    EXPECT_NEAR (out.norm (), 2.0, 1e-4);
    EXPECT_GT (out.normalized ().dot (mesh.normals[v].cast<double> ()), 0.9999);
  }
}

TEST (Polygonizer, MakesATorusOfGenusOne)
{
  const TriangleMesh mesh = meshOf (*shapes::field (shapes::torus (8000, 1.0, 0.4)));
  EXPECT_MESH_CONTRACT (mesh, true);
  EXPECT_EQ (erkpa::measureTopology (mesh).euler, 0);
  const double volume = 2.0 * M_PI * M_PI * 0.16, area = 4.0 * M_PI * M_PI * 0.4;
  EXPECT_NEAR (shapes::volume (mesh), volume, 0.01 * volume);
  EXPECT_NEAR (shapes::area (mesh), area, 0.01 * area);
}

TEST (Polygonizer, FillsABoxToItsEdgesWhenTheyAreSharp)
{
  const Vector3d half (1.0, 0.7, 0.5);
  const shapes::Samples box = shapes::box (8000, half);
  erkpa::FieldOptions sharp;
  for (const Eigen::Vector4d &bisector : shapes::boxBisectors (half))
    sharp.sharp_surfaces.push_back (shapes::plane (bisector));
  const TriangleMesh rounded = meshOf (*shapes::field (box), resolution (50));
  const TriangleMesh exact = meshOf (*shapes::field (box, sharp), resolution (50));
  EXPECT_MESH_CONTRACT (rounded, true);
  EXPECT_MESH_CONTRACT (exact, true);
  EXPECT_EQ (erkpa::measureTopology (exact).euler, 2);
  EXPECT_NEAR (shapes::volume (exact), 2.8, 0.01);
  const auto farthest_off = [&half] (const TriangleMesh &mesh)
  {
    double distance = 0.0;
    for (const Eigen::Vector3f &v : mesh.vertices)
      distance = std::max (distance, std::abs ((v.cast<double> ().cwiseAbs () - half).maxCoeff ()));
    return distance;
  };
  EXPECT_LT (farthest_off (exact), 2e-3); // every vertex lies on the true box
  EXPECT_GT (farthest_off (rounded), 5.0 * farthest_off (exact));
}

TEST (Polygonizer, StaysClosedAtAnyResolution)
{
  const auto field = shapes::field (shapes::box (6000, {1.0, 0.7, 0.5}));
  for (const int cells : {7, 20, 64, 150})
  {
    const TriangleMesh mesh = meshOf (*field, resolution (cells));
    EXPECT_MESH_CONTRACT (mesh, true);
    EXPECT_EQ (erkpa::measureTopology (mesh).euler, 2) << cells;
  }
}

TEST (Polygonizer, StaysClosedWhenVoxelsAreMuchLargerThanTheSpacingOfThePoints)
{
  const TriangleMesh mesh = meshOf (*shapes::field (shapes::sphere (100000)), resolution (12));
  EXPECT_MESH_CONTRACT (mesh, true);
  EXPECT_EQ (erkpa::measureTopology (mesh).euler, 2);
}

TEST (Polygonizer, TellsItsProgressFromZeroToOne)
{
  std::vector<double> told;
  TriangleMesh mesh;
  erkpa::PolygonizerReport report;
  const auto field = shapes::field (shapes::sphere (2000));
  ASSERT_TRUE (erkpa::polygonize (*field, {}, mesh, report, [&] (double done) { told.push_back (done); }).ok ());
  ASSERT_FALSE (told.empty ());
  for (const double done : told)
    EXPECT_TRUE (done >= 0.0 && done <= 1.0);
  EXPECT_EQ (told.back (), 1.0);
}

TEST (Polygonizer, KeepsTheContractWhereTheRadiusIsTooSmallForThePoints)
{
  for (const double radius : {0.13, 0.16, 0.2})
  {
    erkpa::FieldOptions options;
    options.radius = radius;
    const TriangleMesh mesh = meshOf (*shapes::field (shapes::torus (1500, 1.0, 0.4), options));
    EXPECT_MESH_CONTRACT (mesh, false);
  }
}

TEST (Polygonizer, PutsItsVerticesOnTheZeroSet)
{
  const auto field = shapes::field (shapes::torus (4000, 1.0, 0.4));
  const double voxel = erkpa::chooseVoxelSize (*field, {});
  const TriangleMesh mesh = meshOf (*field);
  int off = 0;
  for (const Eigen::Vector3f &v : mesh.vertices)
    off += std::abs (field->value (v.cast<double> ())) > 1e-3 * voxel;
  EXPECT_LT (off, 0.01 * static_cast<double> (mesh.vertices.size ())); // next to grid nodes a margin is kept
}

TEST (Polygonizer, IsoLevelOffsetsTheSurface)
{
  PolygonizerOptions options;
  const auto field = shapes::field (shapes::sphere (4000));
  for (const double iso : {-0.05, 0.05})
  {
    options.iso_level = iso;
    const TriangleMesh mesh = meshOf (*field, options);
    EXPECT_MESH_CONTRACT (mesh, true);
    for (const Eigen::Vector3f &v : mesh.vertices)
      EXPECT_NEAR (v.norm (), 1.0 + iso, 0.003);
  }
}

TEST (Polygonizer, EndsAnOpenSheetWhereItsPointsEnd)
{
  const auto wave = [] (double x, double y) { return 0.2 * std::sin (2.0 * x) * std::cos (y); };
  const auto field = shapes::field (shapes::sheet (50, wave));
  const TriangleMesh mesh = meshOf (*field);
  EXPECT_MESH_CONTRACT (mesh, false);
  const erkpa::MeshTopology topology = erkpa::measureTopology (mesh);
  EXPECT_EQ (topology.components, 1u);
  EXPECT_EQ (topology.euler, 1); // a disc: one border
  const double spacing = 2.0 / 50;
  double low = 0.0, high = 0.0;
  for (const Eigen::Vector3f &v : mesh.vertices)
  {
    EXPECT_LT (v.head<2> ().cwiseAbs ().maxCoeff (), 1.0 + 1.5 * spacing);
    EXPECT_NEAR (v.z (), wave (v.x (), v.y ()), 0.005);
    low = std::min<double> (low, v.x ());
    high = std::max<double> (high, v.x ());
  }
  EXPECT_LT (low, -1.0 + spacing);
  EXPECT_GT (high, 1.0 - spacing);
}

TEST (Polygonizer, ClosesAGapThatTheFieldCloses)
{
  shapes::Samples gap;
  const shapes::Samples sphere = shapes::sphere (6000);
  for (std::size_t i = 0; i < sphere.size (); ++i)
    if (sphere.positions[i].z () < 0.9965) // a hole of three spacings across at the pole
      gap.add (sphere.positions[i], sphere.normals[i]);
  const TriangleMesh mesh = meshOf (*shapes::field (gap));
  EXPECT_MESH_CONTRACT (mesh, true);
}

TEST (Polygonizer, KeepsSeparateObjectsAndDropsStrayPoints)
{
  shapes::Samples scene = shapes::sphere (3000);
  const shapes::Samples second = shapes::sphere (3000, 1.0, {3.0, 0.0, 0.0});
  for (std::size_t i = 0; i < second.size (); ++i)
    scene.add (second.positions[i], second.normals[i]);
  scene.add ({0.0, 2.0, 0.0}, Vector3d::UnitY ());
  scene.add ({0.3, -1.7, 0.2}, Vector3d::UnitX ());
  scene.add ({1.5, 0.0, 0.8}, Vector3d::UnitZ ());
  const TriangleMesh mesh = meshOf (*shapes::field (scene));
  EXPECT_MESH_CONTRACT (mesh, true);
  EXPECT_EQ (erkpa::measureTopology (mesh).components, 2u);
  EXPECT_NEAR (shapes::volume (mesh), 2.0 * 4.0 / 3.0 * M_PI, 0.1);
}

/** \brief So many that the nearest ones of each are strays as well: they must not hold each other up in empty space. */
TEST (Polygonizer, LosesNoTimeAtManyStrayPointsAllAround)
{
  shapes::Samples samples = shapes::sphere (3000);
  erkpa::PolygonizerReport without, with;
  const TriangleMesh clean = meshOf (*shapes::field (samples), {}, &without);
  for (int i = 0; i < 30; ++i)
  {
    const Vector3d away (std::sin (1.7 * i), std::cos (2.3 * i), std::sin (0.9 * i + 1.0));
    samples.add ((2.5 + 0.25 * i) * away, Vector3d::UnitX ());
  }
  const TriangleMesh mesh = meshOf (*shapes::field (samples), {}, &with);
  EXPECT_LT (with.evaluations, without.evaluations + without.evaluations / 5);
  EXPECT_MESH_CONTRACT (mesh, true);
  EXPECT_EQ (erkpa::measureTopology (mesh).components, 1u);
  EXPECT_NEAR (shapes::volume (mesh), shapes::volume (clean), 1e-3);
}

/** \brief The grid says as well what is sparse: where points come in heaps, most supports are small. */
TEST (Polygonizer, KeepsSurfacesOfFarSparserPointsWhereVoxelsSuitThem)
{
  shapes::Samples samples = shapes::sphere (12000, 0.1);
  const shapes::Samples large = shapes::sphere (2000, 2.0);
  for (std::size_t i = 0; i < large.size (); ++i)
    samples.add (large.positions[i] + Vector3d (4.0, 0.0, 0.0), large.normals[i]);
  PolygonizerOptions options;
  options.voxel_size = 0.1;
  const TriangleMesh mesh = meshOf (*shapes::field (samples), options);
  EXPECT_MESH_CONTRACT (mesh, true);
  EXPECT_NEAR (shapes::volume (mesh), 8.0 * 4.0 / 3.0 * M_PI, 0.2);
}

/** \brief Where supports are as large as that, it ends, though the field goes on. */
TEST (Polygonizer, FollowsTheSurfaceIntoSparsePointsButNotIntoNearlyNone)
{
  shapes::Samples samples = shapes::sheet (60, [] (double, double) { return 0.0; }); // of -1 to 1
  const auto add_row_of = [&] (double start, double spacing)
  {
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 8; ++j)
        samples.add ({start + spacing * i, spacing * (j - 4), 0.0}, Vector3d::UnitZ ());
  };
  add_row_of (1.2, 0.2); // spacing of the sheet: 0.034
  add_row_of (10.0, 3.0);
  const TriangleMesh mesh = meshOf (*shapes::field (samples));
  float farthest = 0.0f;
  for (const Eigen::Vector3f &v : mesh.vertices)
    farthest = std::max (farthest, v.x ());
  EXPECT_GT (farthest, 2.5f);
  EXPECT_LT (farthest, 3.5f);
}

TEST (Polygonizer, GivesTheSameMeshInAnyNumberOfThreads)
{
  const auto field = shapes::field (shapes::torus (4000, 1.0, 0.4));
  PolygonizerOptions options;
  options.threads = 1;
  const TriangleMesh one = meshOf (*field, options);
  options.threads = 3;
  const TriangleMesh three = meshOf (*field, options);
  EXPECT_EQ (one.vertices, three.vertices);
  EXPECT_EQ (one.normals, three.normals);
  EXPECT_EQ (one.triangles, three.triangles);
}

TEST (Polygonizer, MakesTheSameSphereOfSupportsThatAreFarLargerThanVoxels)
{
  erkpa::FieldOptions large;
  large.radius = 0.6;
  const auto field = shapes::field (shapes::sphere (3000), large);
  PolygonizerOptions options;
  options.voxel_size = 0.03; // a twentieth of the radius: cubes of blocks share their points
  options.threads = 1;
  const TriangleMesh mesh = meshOf (*field, options);
  EXPECT_MESH_CONTRACT (mesh, true);
  EXPECT_EQ (erkpa::measureTopology (mesh).euler, 2);
  EXPECT_NEAR (shapes::volume (mesh), 4.0 / 3.0 * M_PI, 0.005 * 4.0 / 3.0 * M_PI);
  options.threads = 3;
  EXPECT_EQ (mesh.vertices, meshOf (*field, options).vertices);
}

TEST (Polygonizer, EvaluatesFewNodesOfTheGridWhereSupportsAreFarLargerThanVoxels)
{
  erkpa::FieldOptions options;
  options.radius = 0.3;
  PolygonizerOptions fine;
  fine.voxel_size = 0.015;
  for (const erkpa::Constraint constraint : {erkpa::Constraint::HERMITE, erkpa::Constraint::FUNCTIONAL})
  {
    options.constraint = constraint;
    const auto field = shapes::field (shapes::torus (6000, 1.0, 0.4), options);
    erkpa::PolygonizerReport report;
    const TriangleMesh mesh = meshOf (*field, fine, &report);
    EXPECT_MESH_CONTRACT (mesh, true);
    EXPECT_EQ (erkpa::measureTopology (mesh).euler, 0);
    constexpr std::size_t STEP = 13;
    std::size_t off = 0;
    for (std::size_t i = 0; i < mesh.vertices.size (); i += STEP)
      off += std::abs (field->value (mesh.vertices[i].cast<double> ())) > 1e-3 * fine.voxel_size ? 1 : 0;
    EXPECT_LT (off, mesh.vertices.size () / STEP / 100); // next to grid nodes a margin is kept
    EXPECT_LT (report.evaluations, 5 * mesh.vertices.size () / 2);
  }
}

TEST (CubeSketch, IsExactForQuadraticFunctions)
{
  Eigen::Matrix3d bend;
  bend << 0.3, -0.2, 0.5, -0.2, -0.7, 0.1, 0.5, 0.1, 0.4;
  const Vector3d slope (0.2, -1.1, 0.6);
  const auto f = [&] (const Vector3d &x) { return 0.7 + slope.dot (x) + 0.5 * x.dot (bend * x); };
  erkpa::CubeSketch sketch (Vector3d (0.3, -0.4, 1.0), 0.8);
  for (std::size_t i = 0; i < erkpa::CubeSketch::OCTANTS; ++i)
    sketch.set (i, f (sketch.middle (i)), slope + bend * sketch.middle (i));
  for (const double y : {-0.9, -0.4, 0.1, 0.9})
    for (const double z : {0.5, 1.3, 2.2})
    {
      std::array<double, 5> values{};
      sketch.valuesOnLine ({0.0, y, z}, 0.37, values);
      for (std::size_t i = 0; i < values.size (); ++i)
        EXPECT_NEAR (values[i], f ({0.37 * static_cast<double> (i), y, z}), 1e-12);
    }
  EXPECT_GE (sketch.steepest (), (slope + bend * sketch.middle (3)).norm ());
}

TEST (SurfaceFeet, AreWhereTheSurfaceIsNearestAndMissingWhereThereIsNone)
{
  const auto field = shapes::field (shapes::sphere (3000));
  const double off = 0.5 * field->typicalRadius (), voxel = 0.02;
  std::vector<Vector3d> points;
  std::vector<Vector3d> directions;
  for (int i = 0; i < 200; ++i)
  {
    directions.push_back (field->points ().positions[static_cast<std::size_t> (10 * i)].cast<double> ().normalized ());
    points.push_back ((1.0 + (i % 2 == 0 ? off : -off)) * directions.back ());
  }
  points.emplace_back (5.0, 0.0, 0.0);
  erkpa::PolygonizerReport report;
  const std::vector<char> has_foot = erkpa::findFeet (*field, {}, voxel, nullptr, points, report);
  ASSERT_EQ (has_foot.size (), points.size ());
  for (std::size_t i = 0; i < directions.size (); ++i)
  {
    EXPECT_TRUE (has_foot[i]);
    EXPECT_LT ((points[i] - directions[i]).norm (), 0.1 * voxel);
  }
  EXPECT_FALSE (has_foot.back ());
}

TEST (PlaneMeeting, IsTheCornerOfThreePlanesAndTheNearestPointOfFewer)
{
  erkpa::PlaneMeeting meeting;
  meeting.add (Vector3d::UnitX (), 1.0);
  EXPECT_LT ((meeting.point (0.05) - Vector3d (1.0, 0.0, 0.0)).norm (), 1e-12);
  meeting.add (Vector3d (1.0, 1e-3, 0.0).normalized (), 1.0); // as good as the same
  EXPECT_LT ((meeting.point (0.05) - Vector3d (1.0, 0.0, 0.0)).norm (), 2e-3);
  meeting.add (Vector3d (1.0, 1.0, 0.0).normalized (), 3.0 / std::sqrt (2.0));
  meeting.add (Vector3d (0.0, 0.6, 0.8), 0.0);
  EXPECT_LT ((meeting.point (0.05) - Vector3d (1.0, 2.0, -1.5)).norm (), 5e-3);
}

TEST (Polygonizer, EvaluatesAboutAsOftenAsTheSurfaceIsLarge)
{
  const auto field = shapes::field (shapes::sphere (2000));
  erkpa::PolygonizerReport coarse, fine;
  meshOf (*field, resolution (30), &coarse);
  meshOf (*field, resolution (120), &fine);
  const double growth = static_cast<double> (fine.evaluations) / static_cast<double> (coarse.evaluations);
  EXPECT_NEAR (growth, 16.0, 5.0); // as the area in voxels, not as the volume
}

TEST (Polygonizer, GivesCreasesTheAttributesOfThePointsAroundThem)
{
  const Vector3d half (0.5, 0.35, 0.25);
  auto points = shapes::points (shapes::box (6000, half));
  points->channels = 3;
  for (const Eigen::Vector3f &p : points->positions)
    points->attributes.insert (points->attributes.end (), p.data (), p.data () + 3);
  erkpa::FieldOptions options;
  ASSERT_TRUE (erkpa::findSharpSurfaces (*points, erkpa::PointLayout (*points, 0), erkpa::SharpOptions (), 0,
                                         options.sharp_surfaces)
                   .ok ());
  const auto field = shapes::field (points, options);
  const TriangleMesh mesh = meshOf (*field);
  ASSERT_GE (mesh.creases.size (), 12u);
  for (const erkpa::Crease &crease : mesh.creases)
    for (const int vertex : crease.vertices)
    {
      const auto v = static_cast<std::size_t> (vertex);
      const Eigen::Map<const Eigen::Vector3f> attributes (mesh.attributes.data () + 3 * v);
      const Vector3d place = mesh.vertices[v].cast<double> () - points->origin;
      EXPECT_LT ((attributes.cast<double> () - place).norm (), 2.0 * field->spacing ());
    }
}

TEST (Polygonizer, NamesTheSettingThatMakesNoSense)
{
  const auto field = shapes::field (shapes::sphere (500));
  std::vector<std::pair<PolygonizerOptions, Status>> bad (6, {PolygonizerOptions (), Status::INVALID_SETTING});
  bad[0].first.voxel_size = -1.0;
  bad[1].first.resolution = -5;
  bad[2].first.iso_level = std::nan ("");
  bad[3].first.threads = -1;
  bad[4] = {PolygonizerOptions (), Status::GRID_TOO_FINE};
  bad[4].first.voxel_size = 1e-9;
  bad[5] = {PolygonizerOptions (), Status::NO_SURFACE};
  bad[5].first.iso_level = 40.0;
  for (const auto &[options, status] : bad)
  {
    TriangleMesh mesh;
    erkpa::PolygonizerReport report;
    const erkpa::Outcome outcome = erkpa::polygonize (*field, options, mesh, report);
    EXPECT_EQ (outcome.status, status);
    EXPECT_FALSE (outcome.message.empty ());
    EXPECT_TRUE (mesh.vertices.empty () && mesh.triangles.empty ());
  }
}
