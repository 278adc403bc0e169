// SPDX-License-Identifier: BSD-3-Clause
#include "field_tests.h"

#include "pencil.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace
{

/** \brief Σ φ_i g(x_i) + ψ_i·∇g(x_i): the approximation of g by the shape functions. */
double
approximate (const ImplicitField &field, const Function &g, const Vector3d &x)
{
  double sum = 0.0;
  for (const erkpa::ShapeFunction &shape : field.shapeFunctions (x))
  {
    const Vector3d node = field.points ().positions[static_cast<std::size_t> (shape.node)].cast<double> ();
    sum += shape.phi * g (node) + shape.psi.dot (differences (g, node));
  }
  return sum;
}

void
expectReproduced (const ImplicitField &field, const Function &g, const std::string &name, double bound = 1e-6)
{
  for (int i = 0; i < 30; ++i)
  {
    const Vector3d x = randomPoint (0.6);
    EXPECT_NEAR (approximate (field, g, x), g (x), bound) << name << " at " << x.transpose ();
  }
}

} // namespace

class Field : public FieldTest
{
};

TEST_F (Field, ReproducesEveryFunctionOfItsBasis)
{
  const shapes::Samples nodes = nodesInCube (2000);
  const std::pair<Order, std::size_t> sizes[] = {{Order::LINEAR, 4}, {Order::SPHERICAL, 5}, {Order::QUADRATIC, 11}};
  for (const auto &[order, count] : sizes)
    for (const double radius : {0.0, 0.4})
    {
      const auto field = shapes::field (nodes, optionsOf (order, 40, radius));
      for (std::size_t i = 0; i < count; ++i)
        expectReproduced (*field, MONOMIALS[i].second, MONOMIALS[i].first);
    }
}

TEST_F (Field, ConstantOrderIsAPartitionOfUnityOverTheTangentPlanesOfTheNodes)
{
  const auto field = shapes::field (nodesInCube (2000), optionsOf (Order::CONSTANT, 30));
  for (int i = 0; i < 20; ++i)
  {
    const Vector3d x = randomPoint (0.6);
    double sum = 0.0, value = 0.0;
    for (const erkpa::ShapeFunction &shape : field->shapeFunctions (x))
    {
      EXPECT_GE (shape.phi, 0.0);
      sum += shape.phi;
      const auto node = static_cast<std::size_t> (shape.node);
      value += shape.phi * (x - field->points ().positions[node].cast<double> ())
                               .dot (field->points ().normals[node].cast<double> ()); // eq. (2)
    }
    EXPECT_NEAR (sum, 1.0, 1e-12);
    EXPECT_NEAR (field->value (x), value, 1e-9);
  }
}

TEST_F (Field, ShapeFunctionsSumToOneInEveryOrder)
{
  for (const Order order : {Order::CONSTANT, Order::LINEAR, Order::SPHERICAL, Order::QUADRATIC})
  {
    const auto field = shapes::field (nodesInCube (1000), optionsOf (order, 30));
    expectReproduced (*field, MONOMIALS[0].second, "1", 1e-9);
  }
}

TEST_F (Field, ShapeFunctionsGiveTheFieldItself)
{
  FieldOptions options = optionsOf (Order::SPHERICAL, 30);
  options.sharp_surfaces.push_back (shapes::plane ({1.0, 0.3, -0.2, 0.05}));
  const auto field = shapes::field (nodesInCube (1000), options);
  for (int i = 0; i < 20; ++i)
  {
    const Vector3d x = randomPoint (0.7);
    double value = 0.0;
    for (const erkpa::ShapeFunction &shape : field->shapeFunctions (x))
      value += shape.psi.dot (field->points ().normals[static_cast<std::size_t> (shape.node)].cast<double> ());
    EXPECT_NEAR (field->value (x), value, 1e-9); // all node values are zero
  }
}

TEST_F (Field, ReproducesTheMaximumAndMinimumOfTwoPlanesAcrossTheirBisector)
{
  const Vector3d a (1.0, 0.2, 0.1), b (-0.3, 0.9, 0.2);
  const Vector3d between = b - a;
  FieldOptions options = optionsOf (Order::SPHERICAL, 60);
  options.sharp_surfaces.push_back (shapes::plane ({between[0], between[1], between[2], 0.0}));
  const auto field = shapes::field (nodesInCube (2000), options);
  expectReproduced (
      *field, [&] (const Vector3d &p) { return std::max (a.dot (p), b.dot (p)); }, "max", 1e-5);
  expectReproduced (
      *field, [&] (const Vector3d &p) { return std::min (a.dot (p), b.dot (p)); }, "min", 1e-5);
}

TEST_F (Field, ReproducesCornersOfThreePlanesWhateverTheSignAndScaleOfTheBisectors)
{
  const Vector3d a (1.0, 0.2, 0.1), b (-0.3, 0.9, 0.2), c (0.1, -0.4, 0.8);
  const Function convex = [&] (const Vector3d &p) { return std::max ({a.dot (p), b.dot (p), c.dot (p)}); };
  const Function concave = [&] (const Vector3d &p) { return std::min ({a.dot (p), b.dot (p), c.dot (p)}); };
  const Function saddle = [&] (const Vector3d &p) { return std::max (a.dot (p), std::min (b.dot (p), c.dot (p))); };
  const shapes::Samples nodes = nodesInCube (6000);
  for (int signs = 0; signs < 8; ++signs)
  {
    FieldOptions options = optionsOf (Order::LINEAR, 0, 0.45);
    int bit = 0;
    for (const Vector3d &between : {Vector3d (b - a), Vector3d (c - a), Vector3d (c - b)})
    {
      const Vector3d n = (signs >> bit++ & 1 ? -2.5 : 1.0) * between;
      options.sharp_surfaces.push_back (shapes::plane ({n[0], n[1], n[2], 0.0}));
    }
    const auto field = shapes::field (nodes, options);
    for (int i = 0; i < 10; ++i)
    {
      const Vector3d x = randomPoint (0.12); // the corner lies in the support
      EXPECT_NEAR (approximate (*field, convex, x), convex (x), 1e-4);
      EXPECT_NEAR (approximate (*field, concave, x), concave (x), 1e-4);
      EXPECT_NEAR (approximate (*field, saddle, x), saddle (x), 1e-4);
    }
  }
}

/** \brief Through a line, three planes make one corner term and five make three: they say all there is to say. */
TEST_F (Field, ReproducesEveryFanOfTenLinearPiecesBetweenFivePlanesThroughALine)
{
  constexpr int RAYS = 10;
  std::array<Vector3d, RAYS + 1> rays;
  std::array<double, RAYS + 1> heights{};
  for (int i = 0; i <= RAYS; ++i)
  {
    const double angle = M_PI * (i % 5 * 0.2 + 0.05 * std::sin (3.0 * (i % 5)) + (i % RAYS >= 5 ? 1.0 : 0.0));
    rays[i] = {std::cos (angle), std::sin (angle), 0.0};
    heights[i] = 0.6 * std::cos (5.0 * (i % RAYS)) + 0.2;
  }
  const Function fan = [&] (const Vector3d &p)
  {
    const auto cross = [] (const Vector3d &a, const Vector3d &b) { return a[0] * b[1] - a[1] * b[0]; };
    int i = 0;
    while (i + 1 < RAYS && !(cross (rays[i], p) >= 0.0 && cross (rays[i + 1], p) <= 0.0))
      ++i;
    const double all = cross (rays[i], rays[i + 1]);
    return (cross (p, rays[i + 1]) * heights[i] + cross (rays[i], p) * heights[i + 1]) / all + 0.3 * p[2];
  };
  FieldOptions options = optionsOf (Order::LINEAR, 0, 0.5);
  for (const int i : {3, 0, 4, 1, 2})
    options.sharp_surfaces.push_back (shapes::plane ({-rays[i][1], rays[i][0], 0.0, 0.0}));
  const auto field = shapes::field (nodesInCube (8000), options);
  ASSERT_EQ (field->pencils ().size (), 3u);
  for (int i = 0; i < 20; ++i)
  {
    const Vector3d x = randomPoint (0.12); // the line passes the support
    EXPECT_NEAR (approximate (*field, fan, x), fan (x), 1e-4);
  }
}

TEST_F (Field, IsExactOnPlanesAndSpheres)
{
  const auto flat = shapes::field (shapes::sheet (40, [] (double, double) { return 0.0; }));
  const auto round = shapes::field (shapes::sphere (3000, 2.0));
  for (int i = 0; i < 50; ++i)
  {
    const Vector3d p = randomPoint (0.5);
    EXPECT_NEAR (flat->value ({p.x (), p.y (), 0.1 * p.z ()}), 0.1 * p.z (), 1e-6);
    const Vector3d on = 2.0 * p.normalized ();
    EXPECT_NEAR (round->value (on), 0.0, 1e-5);
    EXPECT_GT (round->value (1.05 * on), 0.0);
    EXPECT_LT (round->value (0.95 * on), 0.0);
  }
}

TEST_F (Field, GradientAgreesWithFiniteDifferences)
{
  const shapes::Samples box = shapes::box (4000, {1.0, 0.7, 0.5});
  for (const Order order : {Order::CONSTANT, Order::LINEAR, Order::SPHERICAL, Order::QUADRATIC})
    for (const double radius : {0.0, 0.25})
      for (const bool sharp : {false, true})
      {
        FieldOptions options = optionsOf (order, 20, radius);
        if (sharp)
          for (const Eigen::Vector4d &bisector : shapes::boxBisectors ({1.0, 0.7, 0.5}))
            options.sharp_surfaces.push_back (shapes::plane (bisector));
        const auto field = shapes::field (box, options);
        const Function f = [&] (const Vector3d &p) { return field->value (p); };
        int compared = 0;
        for (std::size_t i = 0; i < 40; ++i)
        {
          const Vector3d x = box.positions[97 * i] + randomPoint (0.02);
          const Vector3d gradient = field->sample (x).gradient;
          // Where the k-th node changes, or x crosses a sharp plane, f has a kink: the two sides must enclose it.
          const Vector3d fine = differences (f, x, 1e-7), coarse = differences (f, x, 2e-7);
          if ((fine - coarse).norm () > 1e-4)
            continue;
          ++compared;
          EXPECT_LT ((gradient - fine).norm (), 2e-4 * (1.0 + fine.norm ()))
              << "order " << static_cast<int> (order) << " radius " << radius << " sharp " << sharp << " at "
              << x.transpose ();
        }
        EXPECT_GT (compared, 30);
      }
}

TEST_F (Field, IsTheSameOneByOneAndInBatchesAndInAnyNumberOfThreads)
{
  FieldOptions options;
  for (const Eigen::Vector4d &bisector : shapes::boxBisectors ({1.0, 0.7, 0.5}))
    options.sharp_surfaces.push_back (shapes::plane (bisector));
  const shapes::Samples box = shapes::box (3000, {1.0, 0.7, 0.5});
  const auto field = shapes::field (box, options);
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < 300; ++i)
    points.push_back (box.positions[i] + randomPoint (0.1));
  points.emplace_back (std::nan (""), 0.0, 0.0);
  std::vector<erkpa::FieldSample> one, two;
  field->evaluate (points, one, 1);
  field->evaluate (points, two, 2);
  ASSERT_EQ (one.size (), points.size ());
  for (std::size_t i = 0; i + 1 < points.size (); ++i)
  {
    EXPECT_EQ (one[i].value, field->value (points[i]));
    EXPECT_EQ (one[i].value, two[i].value);
    EXPECT_EQ (one[i].gradient, field->sample (points[i]).gradient);
    EXPECT_EQ (one[i].gradient, two[i].gradient);
  }
  EXPECT_FALSE (one.back ().isDefined ());
}

TEST_F (Field, FollowsRotationTranslationAndScaleOfThePoints)
{
  const shapes::Samples torus = shapes::torus (3000, 1.0, 0.4);
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd (0.8, Vector3d (1.0, 2.0, -1.0).normalized ()).matrix ();
  const Vector3d offset (3.0, -2.0, 1.0);
  const auto field = shapes::field (torus), moved = shapes::field (torus.moved (rotation, 2.5, offset));
  for (std::size_t i = 0; i < 40; ++i)
  {
    const Vector3d x = torus.positions[50 * i] + randomPoint (0.03);
    const erkpa::FieldSample here = field->sample (x), there = moved->sample (2.5 * (rotation * x) + offset);
    EXPECT_NEAR (there.value, 2.5 * here.value, 1e-5);
    EXPECT_LT ((there.gradient - rotation * here.gradient).norm (), 1e-3);
  }
}

TEST_F (Field, IsZeroOnTheEdgesAndCornersOfABoxWithSharpPlanes)
{
  const Vector3d half (1.0, 0.7, 0.5);
  const Eigen::Matrix3d attitude = Eigen::AngleAxisd (1.1, Vector3d (0.3, -0.7, 0.5).normalized ()).matrix ();
  const Vector3d offset (0.3, -0.2, 0.5);
  FieldOptions options = optionsOf (Order::SPHERICAL, 0, 0.25);
  for (const Eigen::Vector4d &bisector : shapes::boxBisectors (half))
  {
    const Vector3d n = attitude * bisector.head<3> ();
    options.sharp_surfaces.push_back (shapes::plane ({n[0], n[1], n[2], bisector[3] - n.dot (offset)}));
  }
  const auto field = shapes::field (shapes::box (20000, half).moved (attitude, 1.0, offset), options);
  std::vector<Vector3d> points;
  for (const Vector3d &p : shapes::boxEdgePoints (half, 40))
    points.push_back (attitude * p + offset);
  std::vector<erkpa::FieldSample> samples;
  field->evaluate (points, samples);
  for (const erkpa::FieldSample &sample : samples)
    EXPECT_NEAR (sample.value, 0.0, 1e-4);
}

TEST_F (Field, SharpPlaneDropsOutWithoutAJumpWhereItsSupportLiesOnOneSide)
{
  // A roof along y = 0, and a path that leaves its ridge until all nodes in reach lie on one slope.
  const auto roof = [] (double, double y) { return -0.6 * std::abs (y); };
  FieldOptions options = optionsOf (Order::SPHERICAL, 0, 0.3);
  options.sharp_surfaces.push_back (shapes::plane ({0.0, 1.0, 0.0, 0.0}));
  const auto field = shapes::field (shapes::sheet (60, roof), options);
  for (const double height : {-0.05, 0.0, 0.05})
  {
    double last = field->value ({0.0, 0.0, roof (0, 0.0) + height});
    for (double y = 1e-4; y < 0.5; y += 1e-4)
    {
      const double value = field->value ({0.0, y, roof (0, y) + height});
      EXPECT_LT (std::abs (value - last), 4e-4) << "y = " << y;
      last = value;
    }
  }
}

TEST_F (Field, IsUndefinedWhereTooFewNodesAreInReach)
{
  const auto field = shapes::field (shapes::sphere (500), optionsOf (Order::SPHERICAL, 0, 0.2));
  EXPECT_TRUE (field->sample ({1.0, 0.0, 0.0}).isDefined ());
  EXPECT_FALSE (field->sample ({0.0, 0.0, 0.0}).isDefined ());
  EXPECT_TRUE (std::isnan (field->value ({9.0, 0.0, 0.0})));
  EXPECT_TRUE (field->shapeFunctions ({9.0, 0.0, 0.0}).empty ());
}

TEST_F (Field, StaysDefinedAndFiniteFarFromThePointsWithANeighbourSupport)
{
  const auto field = shapes::field (shapes::sphere (500));
  for (const double far : {1e1, 1e3, 1e6})
    EXPECT_TRUE (std::isfinite (field->value ({far, 0.0, 0.0})));
  EXPECT_FALSE (field->sample ({1e30, 0.0, 0.0}).isDefined ());
}

TEST_F (Field, NamesTheSettingThatMakesNoSense)
{
  for (const auto &options : {optionsOf (Order::LINEAR, 4), optionsOf (Order::LINEAR, -1),
                              optionsOf (Order::LINEAR, 0, -0.1), optionsOf (Order::LINEAR, 0, std::nan (""))})
  {
    const erkpa::Outcome outcome = ImplicitField::checkOptions (options);
    EXPECT_EQ (outcome.status, erkpa::Status::INVALID_SETTING);
    EXPECT_FALSE (outcome.message.empty ());
  }
  EXPECT_TRUE (ImplicitField::checkOptions ({}).ok ());
}

TEST_F (Field, SupportGrowsWithTheNoiseOfThePoints)
{
  const auto flat = [] (double, double) { return 0.0; };
  shapes::Samples noisy = shapes::sheet (60, flat);
  std::normal_distribution<double> noise (0.0, 0.02);
  for (Vector3d &p : noisy.positions)
    p.z () += noise (random_engine);
  const int clean_k = shapes::field (shapes::sheet (60, flat))->options ().k;
  const int noisy_k = shapes::field (noisy)->options ().k;
  EXPECT_GT (noisy_k, clean_k);
}
