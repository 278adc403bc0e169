// SPDX-License-Identifier: BSD-3-Clause
//
// Supports of every size and shape, and the gradients that follow from them.
#include "field_tests.h"

#include <erkpa/reconstruction.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

using erkpa::Constraint;
using erkpa::EnrichmentType;
using erkpa::Interpolation;
using erkpa::KernelType;

namespace
{

/** \brief Compares ∇f with differences of f near nodes; where f has a kink nearby it is left out. */
void
expectGradients (const ImplicitField &field, const std::string &name, double reach = 0.02)
{
  const Function f = [&] (const Vector3d &p) { return field.value (p); };
  int compared = 0;
  for (std::size_t i = 0; i < 40; ++i)
  {
    const Vector3d x = field.points ().positions[37 * i].cast<double> () + field.points ().origin + randomPoint (reach);
    const Vector3d gradient = field.sample (x).gradient;
    const Vector3d fine = differences (f, x, 1e-7), coarse = differences (f, x, 2e-7);
    if (!((fine - coarse).norm () <= 1e-4))
      continue;
    ++compared;
    EXPECT_LT ((gradient - fine).norm (), 3e-4 * (1.0 + fine.norm ())) << name << " at " << x.transpose ();
  }
  EXPECT_GT (compared, 25) << name;
}

const Vector3d HALF (1.0, 0.7, 0.5);

/** \brief Radii that grow along x. */
double
growingRadius (const Vector3d &x)
{
  return 0.3 + 0.08 * x.x ();
}

} // namespace

class SupportOf : public FieldTest
{
};

TEST_F (SupportOf, EveryConstraintHasTheGradientOfItsField)
{
  const shapes::Samples box = shapes::box (3000, HALF);
  for (const Constraint constraint : {Constraint::HERMITE, Constraint::FUNCTIONAL, Constraint::OFFSURFACE})
    for (const Order order : {Order::CONSTANT, Order::LINEAR, Order::SPHERICAL, Order::QUADRATIC})
      for (const double radius : {0.0, 0.25})
        for (const bool sharp : {false, true})
        {
          FieldOptions options = optionsOf (order, radius > 0.0 ? 0 : 20, radius);
          options.constraint = constraint;
          if (sharp)
            for (const Eigen::Vector4d &bisector : shapes::boxBisectors (HALF))
              options.sharp_surfaces.push_back (shapes::plane (bisector));
          expectGradients (*shapes::field (box, options),
                           "constraint " + std::to_string (static_cast<int> (constraint)) + " order " +
                               std::to_string (static_cast<int> (order)) + " radius " + std::to_string (radius) +
                               (sharp ? " sharp" : ""));
        }
}

TEST_F (SupportOf, EveryKernelSizeAndShapeHasTheGradientOfItsField)
{
  const shapes::Samples torus = shapes::torus (3000, 1.0, 0.4);
  std::vector<std::pair<std::string, FieldOptions>> cases;
  for (const KernelType kernel :
       {KernelType::WENDLAND_C2, KernelType::WENDLAND_C4, KernelType::GAUSSIAN, KernelType::SINGULAR})
  {
    cases.emplace_back ("kernel " + std::to_string (static_cast<int> (kernel)), optionsOf (Order::AUTOMATIC, 30));
    cases.back ().second.kernel = kernel;
  }
  cases.emplace_back ("flat", optionsOf (Order::AUTOMATIC, 40));
  cases.back ().second.flatten = 0.4;
  cases.emplace_back ("function", FieldOptions ());
  cases.back ().second.radius_function = growingRadius;
  cases.emplace_back ("ramp", FieldOptions ());
  cases.back ().second.radius_ramp = {1, 0.2, 0.5};
  for (auto &[name, options] : cases)
    for (const Constraint constraint : {Constraint::HERMITE, Constraint::FUNCTIONAL, Constraint::OFFSURFACE})
    {
      options.constraint = constraint;
      expectGradients (*shapes::field (torus, options), name);
    }
}

TEST_F (SupportOf, NodesWithRadiiShapesAndConfidencesHasTheGradientOfItsField)
{
  const auto points = shapes::points (shapes::torus (3000, 1.0, 0.4));
  std::uniform_real_distribution<float> factor (1.0f, 1.5f);
  for (std::size_t i = 0; i < points->size (); ++i)
  {
    points->radii.push_back (0.25f * factor (random_engine));
    points->confidences.push_back (factor (random_engine));
    Eigen::Matrix3f shape = Eigen::Vector3f (1.0f, factor (random_engine), 1.7f).asDiagonal ();
    points->shapes.push_back (shape * Eigen::AngleAxisf (factor (random_engine), points->normals[i]).matrix ());
  }
  for (const Constraint constraint : {Constraint::HERMITE, Constraint::FUNCTIONAL, Constraint::OFFSURFACE})
  {
    FieldOptions options;
    options.constraint = constraint;
    expectGradients (*shapes::field (points, options), "own supports");
  }
}

TEST_F (SupportOf, FunctionAndConstantAgreeWhereTheFunctionIsConstant)
{
  const shapes::Samples torus = shapes::torus (3000, 1.0, 0.4);
  FieldOptions by_function;
  by_function.radius_function = [] (const Vector3d &) { return 0.3; };
  const auto constant = shapes::field (torus, optionsOf (Order::AUTOMATIC, 0, 0.3));
  const auto function = shapes::field (torus, by_function);
  const auto points = shapes::points (torus);
  points->radii.assign (points->size (), 0.3f);
  const auto own = shapes::field (points);
  for (std::size_t i = 0; i < 30; ++i)
  {
    const Vector3d x = torus.positions[50 * i] + randomPoint (0.05);
    EXPECT_NEAR (function->value (x), constant->value (x), 1e-12);
    EXPECT_NEAR (own->value (x), constant->value (x), 1e-6); // 0.3 as a float
  }
}

TEST_F (SupportOf, RampGoesFromTheLowestToTheHighestNode)
{
  const shapes::Samples sphere = shapes::sphere (20000);
  FieldOptions options;
  options.radius_ramp = {2, 0.1, 0.6};
  const auto field = shapes::field (sphere, options);
  const auto nodesAt = [&] (double z) { return field->shapeFunctions ({std::sqrt (1.0 - z * z), 0.0, z}).size (); };
  const auto constant = [&] (double radius) {
    return shapes::field (sphere, optionsOf (Order::AUTOMATIC, 0, radius))->shapeFunctions ({1.0, 0.0, 0.0}).size ();
  };
  EXPECT_NEAR (static_cast<double> (nodesAt (0.0)), static_cast<double> (constant (0.35)), 5.0);
  EXPECT_NEAR (static_cast<double> (nodesAt (0.9)), static_cast<double> (constant (0.1 + 0.95 * 0.5)), 10.0);
  EXPECT_NEAR (static_cast<double> (nodesAt (-0.9)), static_cast<double> (constant (0.1 + 0.05 * 0.5)), 10.0);
}

TEST_F (SupportOf, SteepFunctionOfPositionMissesNoNode)
{
  // Steeper than one in one: a neighbourhood gathered for a ball would miss nodes that its points reach.
  const shapes::Samples sphere = shapes::sphere (5000);
  FieldOptions options;
  options.radius_function = [] (const Vector3d &x) { return 0.1 + 0.8 * std::pow (std::max (0.0, x.x ()), 4); };
  const auto field = shapes::field (sphere, options);
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < 200; ++i)
    points.push_back (sphere.positions[i * 25] + randomPoint (0.02));
  std::vector<erkpa::FieldSample> samples;
  field->evaluate (points, samples);
  for (std::size_t i = 0; i < points.size (); ++i)
    EXPECT_EQ (samples[i].value, field->value (points[i]));
}

TEST_F (SupportOf, NodesOfItsOwnIsFoundHoweverMuchRadiiDiffer)
{
  const shapes::Samples sphere = shapes::sphere (4000);
  const auto points = shapes::points (sphere);
  for (std::size_t i = 0; i < points->size (); ++i)
    points->radii.push_back (i % 50 == 0 ? 1.5f : 0.12f);
  const auto field = shapes::field (points);
  for (std::size_t i = 0; i < 20; ++i)
  {
    const Vector3d x = sphere.positions[150 * i + 3];
    std::size_t reached = 0;
    for (std::size_t n = 0; n < points->size (); ++n)
      reached += (points->positions[n].cast<double> () - x).norm () < static_cast<double> (points->radii[n]);
    EXPECT_EQ (field->shapeFunctions (x).size (), reached);
  }
}

TEST_F (SupportOf, FlattenedKernelsTellThinWallsApart)
{
  // Two sheets, nearer than the support: a ball mixes them, a disc sees its own alone.
  shapes::Samples wall;
  for (const double z : {-0.03, 0.03})
    for (int i = 0; i < 60; ++i)
      for (int j = 0; j < 60; ++j)
        wall.add ({i / 30.0 - 1.0, j / 30.0 - 1.0, z}, Vector3d::UnitZ () * (z > 0.0 ? 1.0 : -1.0));
  FieldOptions options = optionsOf (Order::AUTOMATIC, 0, 0.15);
  const double ball = std::abs (shapes::field (wall, options)->value ({0.0, 0.0, 0.03}));
  options.flatten = 0.3;
  const double disc = std::abs (shapes::field (wall, options)->value ({0.0, 0.0, 0.03}));
  EXPECT_LT (disc, 1e-6);
  EXPECT_GT (ball, 1e-3);
}

TEST_F (SupportOf, OneCloudIsChosenInOneWayOnly)
{
  FieldOptions two = optionsOf (Order::AUTOMATIC, 20, 0.1), ramp, function;
  ramp.radius_ramp = {0, 0.1, -1.0};
  function.k = 10;
  function.radius_function = growingRadius;
  for (const FieldOptions &options : {two, ramp, function})
  {
    const erkpa::Outcome outcome = ImplicitField::checkOptions (options);
    EXPECT_EQ (outcome.status, erkpa::Status::INVALID_SETTING);
    EXPECT_NE (outcome.message.find ("radius"), std::string::npos);
  }
  FieldOptions flat, offset, singular;
  flat.flatten = 0.0;
  offset.offset = 1.5;
  singular.kernel = KernelType::SINGULAR;
  singular.interpolation = Interpolation::COLLOCATION;
  for (const FieldOptions &options : {flat, offset, singular})
    EXPECT_EQ (ImplicitField::checkOptions (options).status, erkpa::Status::INVALID_SETTING);
}

TEST_F (SupportOf, OneStrayPointDoesNotWidenTheOffsetsOfAll)
{
  shapes::Samples samples = shapes::sphere (3000);
  samples.add ({50.0, 0.0, 0.0}, Vector3d::UnitX ());
  FieldOptions options;
  options.constraint = Constraint::OFFSURFACE;
  const auto field = shapes::field (samples, options);
  EXPECT_LT (field->largestOffset (), field->typicalRadius ()); // every search looks that much further
}

TEST_F (SupportOf, DefaultVoxelSeesFlattenedSupports)
{
  for (const double flatten : {0.5, 0.3})
  {
    erkpa::Options options;
    options.field.flatten = flatten;
    const auto field = shapes::field (shapes::sphere (1500), options.field);
    erkpa::TriangleMesh mesh;
    erkpa::Report report;
    ASSERT_TRUE (erkpa::buildMesh (*field, options, mesh, report).ok ());
    EXPECT_MESH_CONTRACT (mesh, true);
    EXPECT_EQ (report.topology.euler, 2);
  }
}

TEST_F (SupportOf, ValuesMustBeGivenForAllNodes)
{
  const auto field = shapes::field (shapes::sphere (500));
  EXPECT_THROW (field->setNodeValues ({1.0, 2.0}), std::invalid_argument);
}
