// SPDX-License-Identifier: BSD-3-Clause
//
// Fields that pass through their nodes: collocation (eq. 26-27) and singular kernels.
#include "field_tests.h"

#include <erkpa/collocation.h>
#include <erkpa/reconstruction.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

using erkpa::Constraint;
using erkpa::Interpolation;
using erkpa::KernelType;

namespace
{

constexpr Constraint CONSTRAINTS[] = {Constraint::HERMITE, Constraint::FUNCTIONAL, Constraint::OFFSURFACE};

FieldOptions
interpolating (Constraint constraint, Interpolation interpolation)
{
  FieldOptions options;
  options.constraint = constraint;
  options.interpolation = interpolation;
  return options;
}

/** \brief The largest |f| at the nodes, displaced by \a way along a random direction, in typical radii. */
double
largestMiss (const ImplicitField &field, double way = 0.0)
{
  std::vector<Vector3d> points;
  for (const Eigen::Vector3f &p : field.points ().positions)
    points.emplace_back (p.cast<double> () + field.points ().origin + way * randomPoint (1.0).normalized ());
  std::vector<erkpa::FieldSample> samples;
  field.evaluate (points, samples);
  double largest = 0.0;
  for (const erkpa::FieldSample &sample : samples)
    largest = std::max (largest, std::abs (sample.value));
  return largest / field.typicalRadius ();
}

shapes::Samples
roughTorus ()
{
  shapes::Samples torus = shapes::torus (2500, 1.0, 0.4);
  std::normal_distribution<double> noise (0.0, 0.01);
  for (std::size_t i = 0; i < torus.size (); ++i)
    torus.positions[i] += noise (random_engine) * torus.normals[i];
  return torus;
}

} // namespace

class Interpolating : public FieldTest
{
};

TEST_F (Interpolating, CollocationPassesThroughTheNodesForEveryConstraint)
{
  for (const Constraint constraint : CONSTRAINTS)
    for (const double radius : {0.0, 0.22})
    {
      FieldOptions options = interpolating (constraint, Interpolation::COLLOCATION);
      options.radius = radius;
      const auto field = shapes::field (roughTorus (), options);
      const double before = largestMiss (*field);
      erkpa::CollocationReport report;
      ASSERT_TRUE (erkpa::interpolateNodes (*field, 0, report).ok ());
      EXPECT_LE (largestMiss (*field), 1e-6);
      EXPECT_GT (before, 1e-3); // there was something to do
      EXPECT_LE (report.residual, 1e-6);
      EXPECT_EQ (report.unknowns, 2500u * static_cast<std::size_t> (field->valuesPerNode ()));
      EXPECT_GT (report.iterations, 0);
    }
}

TEST_F (Interpolating, CollocationSolvesSmallSystemsDirectly)
{
  const auto field = shapes::field (shapes::box (600, {1.0, 0.7, 0.5}),
                                    interpolating (Constraint::HERMITE, Interpolation::COLLOCATION));
  erkpa::CollocationReport report;
  ASSERT_TRUE (erkpa::interpolateNodes (*field, 0, report).ok ());
  EXPECT_EQ (report.iterations, 0);
  EXPECT_LE (largestMiss (*field), 1e-9);
}

TEST_F (Interpolating, CollocationKeepsTheValuesUserGave)
{
  // The system is for any λ: nodes asked for f = 0.05 x get it.
  const auto field =
      shapes::field (shapes::sphere (3000), interpolating (Constraint::HERMITE, Interpolation::COLLOCATION));
  std::vector<double> values;
  for (const Eigen::Vector3f &p : field->points ().positions)
    values.push_back (0.05 * static_cast<double> (p.x ()));
  field->setNodeValues (values);
  erkpa::CollocationReport report;
  ASSERT_TRUE (erkpa::interpolateNodes (*field, 0, report).ok ());
  for (std::size_t i = 0; i < 50; ++i)
    EXPECT_NEAR (field->value (field->points ().positions[i].cast<double> ()), values[i], 1e-6);
}

TEST_F (Interpolating, CollocationIsTheSameInAnyNumberOfThreads)
{
  const shapes::Samples torus = roughTorus ();
  std::vector<double> values[2];
  for (const int threads : {1, 2})
  {
    const auto field = shapes::field (torus, interpolating (Constraint::HERMITE, Interpolation::COLLOCATION));
    erkpa::CollocationReport report;
    ASSERT_TRUE (erkpa::interpolateNodes (*field, threads, report).ok ());
    for (int i = 0; i < 100; ++i)
      values[threads - 1].push_back (field->nodeValue (i));
  }
  EXPECT_EQ (values[0], values[1]);
}

TEST_F (Interpolating, CollocationThatDoesNotConvergeIsAnErrorAndLeavesTheFieldAlone)
{
  // The paper's kernel has zeros in its Fourier transform; with a wide support the system is next to singular.
  FieldOptions options = interpolating (Constraint::HERMITE, Interpolation::COLLOCATION);
  options.kernel = KernelType::PAPER;
  options.k = 90;
  const auto field = shapes::field (roughTorus (), options);
  erkpa::CollocationReport report;
  const erkpa::Outcome outcome = erkpa::interpolateNodes (*field, 0, report);
  EXPECT_EQ (outcome.status, erkpa::Status::NOT_CONVERGED);
  EXPECT_NE (outcome.message.find ("wendland_c2"), std::string::npos);
  EXPECT_EQ (field->nodeValue (0), 0.0);
}

TEST_F (Interpolating, SingularKernelsPassThroughTheNodes)
{
  for (const Constraint constraint : CONSTRAINTS)
  {
    const auto field = shapes::field (roughTorus (), interpolating (constraint, Interpolation::SINGULAR));
    EXPECT_LE (largestMiss (*field), 1e-8);
    // 1e-4 of the spacing away f is as small as the way is, and not what the neighbours say.
    EXPECT_LE (largestMiss (*field, 1e-4 * field->spacing ()), 1e-4);
  }
}

TEST_F (Interpolating, MeshesOfASphereStayClosedAndRoundForEveryConstraint)
{
  for (const Constraint constraint : CONSTRAINTS)
    for (const Interpolation interpolation : {Interpolation::SINGULAR, Interpolation::COLLOCATION})
    {
      erkpa::Options options;
      options.field = interpolating (constraint, interpolation);
      options.polygonizer.resolution = 40;
      const shapes::Samples sphere = shapes::sphere (3000);
      const auto field = shapes::field (sphere, options.field);
      erkpa::Report report;
      if (interpolation == Interpolation::COLLOCATION)
      {
        ASSERT_TRUE (erkpa::interpolateNodes (*field, 0, report.collocation).ok ());
      }
      erkpa::TriangleMesh mesh;
      ASSERT_TRUE (erkpa::buildMesh (*field, options, mesh, report).ok ());
      EXPECT_MESH_CONTRACT (mesh, true);
      EXPECT_EQ (report.topology.euler, 2);
      EXPECT_NEAR (shapes::volume (mesh), 4.0 / 3.0 * M_PI, 0.02);
    }
}
