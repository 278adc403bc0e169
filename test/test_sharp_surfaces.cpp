// SPDX-License-Identifier: BSD-3-Clause
//
// Discontinuity surfaces of every kind, and the field in a warped space.
#include "field_tests.h"

#include <erkpa/reconstruction.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

using erkpa::SharpSurface;
using erkpa::SpaceWarp;
using erkpa::SurfaceModel;

namespace
{

SharpSurface::ConstPtr
surfaceOf (SurfaceModel model, const std::vector<float> &coefficients)
{
  SharpSurface::ConstPtr surface;
  EXPECT_TRUE (erkpa::makeSharpSurface (model, coefficients, surface).ok ());
  return surface;
}

/** \brief Turns space about the z axis, by an angle that grows with z. */
SpaceWarp::ConstPtr
twist (double per_length)
{
  const auto turn = [per_length] (double z) { return Eigen::AngleAxisd (per_length * z, Vector3d::UnitZ ()); };
  return erkpa::makeSpaceWarp ([turn] (const Vector3d &x) { return Vector3d (turn (x.z ()) * x); },
                               [turn, per_length] (const Vector3d &x)
                               {
                                 Eigen::Matrix3d jacobian = turn (x.z ()).toRotationMatrix ();
                                 jacobian.col (2) += per_length * Vector3d::UnitZ ().cross (turn (x.z ()) * x);
                                 return jacobian;
                               });
}

/** \brief Bends the z axis into a circle of radius 1 / curvature around an axis parallel to y. */
SpaceWarp::ConstPtr
bend (double curvature)
{
  return erkpa::makeSpaceWarp (
      [curvature] (const Vector3d &x)
      {
        const double r = 1.0 / curvature - x.x (), angle = curvature * x.z ();
        return Vector3d (1.0 / curvature - r * std::cos (angle), x.y (), r * std::sin (angle));
      },
      [curvature] (const Vector3d &x)
      {
        const double r = 1.0 / curvature - x.x (), angle = curvature * x.z ();
        Eigen::Matrix3d jacobian;
        jacobian << std::cos (angle), 0.0, curvature * r * std::sin (angle), 0.0, 1.0, 0.0, -std::sin (angle), 0.0,
            curvature * r * std::cos (angle);
        return jacobian;
      });
}

const Vector3d HALF (0.4, 0.3, 1.0);

FieldOptions
withBisectors (const SpaceWarp::ConstPtr &back = nullptr)
{
  FieldOptions options = optionsOf (Order::AUTOMATIC, 0, 0.16);
  for (const Eigen::Vector4d &bisector : shapes::boxBisectors (HALF))
  {
    const SharpSurface::ConstPtr plane = shapes::plane (bisector);
    options.sharp_surfaces.push_back (back ? erkpa::makeWarpedSharpSurface (plane, back) : plane);
  }
  return options;
}

/** \brief Points on a box that is warped, with the normals of the warped surface. */
shapes::Samples
warped (const shapes::Samples &samples, const SpaceWarp &warp)
{
  shapes::Samples result;
  for (std::size_t i = 0; i < samples.size (); ++i)
    result.add (warp.map (samples.positions[i]),
                (warp.jacobian (samples.positions[i]).inverse ().transpose () * samples.normals[i]).normalized ());
  return result;
}

} // namespace

class SharpSurfaces : public FieldTest
{
};

TEST_F (SharpSurfaces, ThetaIsTheSignedDistanceToEveryModel)
{
  const auto sphere = surfaceOf (SurfaceModel::SPHERE, {1.0f, 0.0f, 0.0f, 2.0f});
  EXPECT_NEAR (sphere->theta ({1.0, 5.0, 0.0}), 3.0, 1e-6);
  const auto cylinder = surfaceOf (SurfaceModel::CYLINDER, {0.0f, 0.0f, 7.0f, 0.0f, 0.0f, -3.0f, 0.5f});
  EXPECT_NEAR (cylinder->theta ({0.3, 0.4, 2.0}), 0.0, 1e-6);
  EXPECT_NEAR (cylinder->theta ({0.0, 0.1, 2.0}), -0.4, 1e-6);
  const auto cone = surfaceOf (SurfaceModel::CONE, {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.0f, static_cast<float> (M_PI / 6)});
  EXPECT_NEAR (cone->theta ({std::tan (M_PI / 6), 0.0, 2.0}), 0.0, 1e-6);
  EXPECT_NEAR (cone->theta ({0.0, 0.0, 2.0}), -0.5, 1e-6); // sin 30° of the height
  const auto plane = surfaceOf (SurfaceModel::PLANE, {0.0f, 2.0f, 0.0f, -1.0f});
  EXPECT_NEAR (plane->theta ({9.0, 1.0, 9.0}), 0.5, 1e-6);
}

TEST_F (SharpSurfaces, GradientsAgreeWithDifferences)
{
  const auto plane = surfaceOf (SurfaceModel::PLANE, {1.0f, 2.0f, -1.0f, 0.3f});
  const SharpSurface::ConstPtr surfaces[] = {
      plane,
      surfaceOf (SurfaceModel::SPHERE, {0.1f, 0.2f, 0.3f, 0.7f}),
      surfaceOf (SurfaceModel::CYLINDER, {0.1f, 0.0f, 0.0f, 1.0f, 1.0f, 0.0f, 0.5f}),
      surfaceOf (SurfaceModel::CONE, {0.0f, 2.0f, 0.0f, 0.3f, 1.0f, 0.0f, 0.4f}),
      erkpa::makeWarpedSharpSurface (plane, twist (0.8)),
      erkpa::makeReversed (surfaceOf (SurfaceModel::CYLINDER, {0.1f, 0.0f, 0.0f, 1.0f, 1.0f, 0.0f, 0.5f})),
      erkpa::makeSharpFunction ([] (const Vector3d &x) { return x.x () * x.y () - x.z (); },
                                [] (const Vector3d &x) { return Vector3d (x.y (), x.x (), -1.0); })};
  for (const SharpSurface::ConstPtr &surface : surfaces)
    for (int i = 0; i < 20; ++i)
    {
      const Vector3d x = randomPoint (1.0);
      const Vector3d gradient = differences ([&] (const Vector3d &p) { return surface->theta (p); }, x);
      EXPECT_LT ((surface->thetaGradient (x) - gradient).norm (), 1e-6);
    }
}

TEST_F (SharpSurfaces, ReversedSurfaceHasItsOtherSideOutside)
{
  const auto plane = surfaceOf (SurfaceModel::PLANE, {1.0f, 2.0f, -1.0f, 0.3f});
  const auto sphere = surfaceOf (SurfaceModel::SPHERE, {0.1f, 0.2f, 0.3f, 0.7f});
  for (const SharpSurface::ConstPtr &surface : {plane, sphere})
    for (int i = 0; i < 10; ++i)
    {
      const Vector3d x = randomPoint (1.0);
      EXPECT_EQ (erkpa::makeReversed (surface)->theta (x), -surface->theta (x));
    }
  EXPECT_NE (erkpa::planeBehind (*erkpa::makeReversed (plane)), nullptr);
  EXPECT_EQ (erkpa::makeReversed (nullptr), nullptr);
}

TEST_F (SharpSurfaces, CoefficientsThatMakeNoSurfaceAreRefusedWithTheirReason)
{
  const std::pair<SurfaceModel, std::vector<float>> bad[] = {
      {SurfaceModel::PLANE, {0.0f, 0.0f, 0.0f, 1.0f}},
      {SurfaceModel::PLANE, {1.0f, 0.0f, 0.0f}},
      {SurfaceModel::SPHERE, {0.0f, 0.0f, 0.0f, -1.0f}},
      {SurfaceModel::SPHERE, {0.0f, 0.0f, std::nanf (""), 1.0f}},
      {SurfaceModel::CYLINDER, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f}},
      {SurfaceModel::CYLINDER, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}},
      {SurfaceModel::CONE, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 2.0f}}};
  for (const auto &[model, coefficients] : bad)
  {
    SharpSurface::ConstPtr surface;
    const erkpa::Outcome outcome = erkpa::makeSharpSurface (model, coefficients, surface);
    EXPECT_EQ (outcome.status, erkpa::Status::INVALID_SETTING);
    EXPECT_FALSE (outcome.message.empty ());
    EXPECT_EQ (surface, nullptr);
  }
}

namespace
{

/** \brief A tin without bottom: wall r = 0.5, lid z = 0.5. */
shapes::Samples
tin ()
{
  shapes::Samples samples;
  std::uniform_real_distribution<double> unit (0.0, 1.0);
  for (int i = 0; i < 12000; ++i)
  {
    const double turn = 2.0 * M_PI * unit (random_engine);
    const Vector3d out (std::cos (turn), std::sin (turn), 0.0);
    if (i % 3 == 0)
      samples.add (0.5 * std::sqrt (unit (random_engine)) * out + 0.5 * Vector3d::UnitZ (), Vector3d::UnitZ ());
    else
      samples.add (0.5 * out + (unit (random_engine) - 0.5) * Vector3d::UnitZ (), out);
  }
  return samples;
}

/** \brief The largest |f| on its rim, with a sharp surface or null. */
double
missOnRim (const shapes::Samples &samples, const SharpSurface::ConstPtr &surface)
{
  FieldOptions options = optionsOf (Order::QUADRATIC, 0, 0.15);
  if (surface)
    options.sharp_surfaces.push_back (surface);
  const auto field = shapes::field (samples, options);
  double largest = 0.0;
  for (double turn = 0.0; turn < 2.0 * M_PI; turn += 0.05)
    largest = std::max (largest, std::abs (field->value ({0.5 * std::cos (turn), 0.5 * std::sin (turn), 0.5})));
  return largest;
}

} // namespace

TEST_F (SharpSurfaces, ConeOrTheFacesThemselvesMakeTheRimOfACylinderSharp)
{
  const shapes::Samples samples = tin ();
  const double round = missOnRim (samples, nullptr);
  EXPECT_GT (round, 0.01);
  // the cone of 45 degrees that halves wall and lid all around
  const auto cone = surfaceOf (SurfaceModel::CONE, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, static_cast<float> (M_PI_4)});
  EXPECT_LT (missOnRim (samples, cone), 0.05 * round);
  const auto wall = surfaceOf (SurfaceModel::CYLINDER, {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.5f});
  const auto lid = surfaceOf (SurfaceModel::PLANE, {0.0f, 0.0f, 1.0f, -0.5f});
  EXPECT_LT (missOnRim (samples, erkpa::makeSharpBetween (wall, lid)), 0.05 * round);
}

TEST_F (SharpSurfaces, BetweenTwoPlanesIsThePlaneThatHalvesThem)
{
  const auto a = surfaceOf (SurfaceModel::PLANE, {1.0f, 0.0f, 0.0f, -1.0f});
  const auto b = surfaceOf (SurfaceModel::PLANE, {0.0f, 1.0f, 0.0f, -2.0f});
  const auto between = erkpa::makeSharpBetween (a, b);
  ASSERT_NE (between, nullptr);
  EXPECT_NE (erkpa::planeBehind (*between), nullptr); // corners are found among planes
  for (int i = 0; i < 10; ++i)
  {
    const Vector3d x = randomPoint (2.0);
    EXPECT_NEAR (between->theta (x), M_SQRT1_2 * (b->theta (x) - a->theta (x)), 1e-12);
    EXPECT_NEAR (between->thetaGradient (x).norm (), 1.0, 1e-12);
  }
  EXPECT_EQ (erkpa::makeSharpBetween (a, a), nullptr);
  EXPECT_EQ (erkpa::makeSharpBetween (a, nullptr), nullptr);
}

TEST_F (SharpSurfaces, TwistedPlanesMakeTheEdgesOfATwistedBoxSharp)
{
  const SpaceWarp::ConstPtr there = twist (0.8), back = twist (-0.8);
  const shapes::Samples box = warped (shapes::box (20000, HALF), *there);
  const auto sharp = shapes::field (box, withBisectors (back));
  const auto round = shapes::field (box, optionsOf (Order::AUTOMATIC, 0, 0.16));
  double largest_sharp = 0.0, largest_round = 0.0;
  for (const Vector3d &p : shapes::boxEdgePoints (HALF, 20))
  {
    largest_sharp = std::max (largest_sharp, std::abs (sharp->value (there->map (p))));
    largest_round = std::max (largest_round, std::abs (round->value (there->map (p))));
  }
  EXPECT_LT (largest_sharp, 2e-3);
  EXPECT_GT (largest_round, 10.0 * largest_sharp);
}

class WarpedField : public FieldTest
{
};

TEST_F (WarpedField, IsTheFieldWhereTheWarpComesFrom)
{
  const shapes::Samples box = shapes::box (8000, HALF);
  FieldOptions options = withBisectors ();
  const auto straight = shapes::field (box, options);
  for (const SpaceWarp::ConstPtr &warp : {twist (0.8), bend (0.6)})
  {
    options.warp = warp;
    const auto field = shapes::field (box, options);
    for (std::size_t i = 0; i < 60; ++i)
    {
      const Vector3d x = box.positions[i] + randomPoint (0.04), y = warp->map (x);
      EXPECT_NEAR (field->value (y), straight->value (x), 1e-9);
      const Vector3d fine = differences ([&] (const Vector3d &p) { return field->value (p); }, y, 1e-6);
      if ((fine - differences ([&] (const Vector3d &p) { return field->value (p); }, y, 2e-6)).norm () < 1e-4)
      {
        EXPECT_LT ((field->sample (y).gradient - fine).norm (), 1e-3);
      }
    }
    for (const Vector3d &p : shapes::boxEdgePoints (HALF, 20))
      EXPECT_NEAR (field->value (warp->map (p)), 0.0, 1e-4);
  }
}

TEST_F (WarpedField, PolygonizesClosedWithTheNormalsOfTheWarpedSurface)
{
  const shapes::Samples torus = shapes::torus (6000, 0.8, 0.3);
  const auto straight = shapes::field (torus);
  erkpa::Options options;
  options.field.warp = bend (0.6);
  options.polygonizer.voxel_size = 0.05;
  const auto field = shapes::field (torus, options.field);
  erkpa::TriangleMesh mesh;
  erkpa::Report report;
  ASSERT_TRUE (erkpa::buildMesh (*field, options, mesh, report).ok ());
  EXPECT_MESH_CONTRACT (mesh, true);
  EXPECT_EQ (report.topology.euler, 0);
  for (std::size_t v = 0; v < mesh.vertices.size (); v += 7)
  {
    Vector3d from = mesh.vertices[v].cast<double> ();
    ASSERT_TRUE (options.field.warp->invert (mesh.vertices[v].cast<double> (), from, 1e-6));
    const Vector3d ring = 0.8 * Vector3d (from.x (), from.y (), 0.0).normalized ();
    EXPECT_NEAR ((from - ring).norm (), 0.3, 3e-3);
    const Vector3d normal =
        options.field.warp->jacobian (from).inverse ().transpose () * straight->sample (from).gradient;
    EXPECT_LT ((normal.normalized () - mesh.normals[v].cast<double> ()).norm (), 1e-3);
  }
}

TEST_F (WarpedField, IsUndefinedWhereTheWarpHasNoOrigin)
{
  FieldOptions options = optionsOf (Order::AUTOMATIC, 20);
  options.warp = erkpa::makeSpaceWarp ([] (const Vector3d &x) { return Vector3d (std::tanh (x.x ()), x.y (), x.z ()); },
                                       [] (const Vector3d &x)
                                       {
                                         const double c = std::cosh (x.x ());
                                         return Eigen::Matrix3d (Vector3d (1.0 / (c * c), 1.0, 1.0).asDiagonal ());
                                       });
  const auto field = shapes::field (shapes::sphere (500), options);
  EXPECT_TRUE (field->sample ({std::tanh (1.0), 0.0, 0.0}).isDefined ());
  EXPECT_FALSE (field->sample ({1.5, 0.0, 0.0}).isDefined ());
}

TEST_F (WarpedField, KeepsItsBordersWhereTheWarpEnlargesOrShrinks)
{
  // Half a sphere is scanned: no scale of space may make it a whole one.
  shapes::Samples half;
  const shapes::Samples sphere = shapes::sphere (4000);
  for (std::size_t i = 0; i < sphere.size (); ++i)
    if (sphere.positions[i].z () > 0.0)
      half.add (sphere.positions[i], sphere.normals[i]);
  const auto areaOf = [&] (double scale)
  {
    erkpa::Options options;
    if (scale != 1.0)
      options.field.warp =
          erkpa::makeSpaceWarp ([scale] (const Vector3d &x) { return Vector3d (scale * x); }, [scale] (const Vector3d &)
                                { return Eigen::Matrix3d (scale * Eigen::Matrix3d::Identity ()); });
    const auto field = shapes::field (half, options.field);
    erkpa::TriangleMesh mesh;
    erkpa::Report report;
    EXPECT_TRUE (erkpa::buildMesh (*field, options, mesh, report).ok ());
    EXPECT_MESH_CONTRACT (mesh, false);
    EXPECT_GT (report.topology.boundary_edges, 0u);
    return shapes::area (mesh) / (scale * scale);
  };
  const double area = areaOf (1.0);
  EXPECT_NEAR (areaOf (100.0), area, 0.01 * area);
  EXPECT_NEAR (areaOf (0.01), area, 0.01 * area);
}
