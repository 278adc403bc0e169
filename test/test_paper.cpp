// SPDX-License-Identifier: BSD-3-Clause
//
// The method as the paper prints it (eq. 13-25), against a slow evaluation of its equations.
#include "field_tests.h"

#include <erkpa/collocation.h>

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <string>

using erkpa::Constraint;
using erkpa::EnrichmentType;
using erkpa::KernelType;

namespace
{

/** \brief What the equations need: nodes with values, weights Δx_i and support radii, and the sharp planes. */
struct PrintedMethod
{
  std::vector<Vector3d> nodes, normals;
  std::vector<double> values, weights, radii;
  int order = 1;           // n of eq. (15)
  bool functional = false; // eq. (2)
  std::vector<Eigen::Vector4d> planes;
  std::function<double (double)> kernel = [] (double t)
  { return 1.0 - 6.0 * std::pow (t, 5) + 15.0 * std::pow (t, 4) - 10.0 * std::pow (t, 3); };
};

double
theta (const Eigen::Vector4d &plane, const Vector3d &x)
{
  return plane.head<3> ().dot (x) + plane[3];
}

/** \brief R (x_i), or with \a from the B (x, x_i) of eq. (25): polynomials of x - x_i, the enrichment of x_i. */
Eigen::VectorXd
terms (const PrintedMethod &method, const std::vector<bool> &active, const Vector3d &node, const Vector3d *from)
{
  const Vector3d u = from != nullptr ? Vector3d (*from - node) : node;
  std::vector<double> r{1.0};
  for (int a = 0; a < 3 && method.order > 0; ++a)
    r.push_back (u[a]);
  for (int a = 0; a < 3 && method.order > 1; ++a)
    for (int b = a; b < 3; ++b)
      r.push_back (u[a] * u[b]);
  for (std::size_t p = 0; p < method.planes.size (); ++p)
    if (active[p])
      r.push_back (std::max (theta (method.planes[p], node), 0.0)); // θH(θ), eq. (22)
  return Eigen::Map<Eigen::VectorXd> (r.data (), static_cast<Eigen::Index> (r.size ()));
}

/** \brief φ_i (x) of all nodes by eq. (16), (17) and (19): the matrix that is not symmetric, and full pivoting. */
std::vector<double>
printedShapeFunctions (const PrintedMethod &method, const Vector3d &x)
{
  std::vector<double> weights (method.nodes.size (), 0.0);
  std::vector<bool> below (method.planes.size (), false), above = below, active = below;
  for (std::size_t i = 0; i < method.nodes.size (); ++i)
  {
    const double t = (method.nodes[i] - x).norm () / method.radii[i];
    weights[i] = t < 1.0 ? method.kernel (t) * method.weights[i] : 0.0;
    for (std::size_t p = 0; p < method.planes.size () && weights[i] > 0.0; ++p)
      (theta (method.planes[p], method.nodes[i]) < 0.0 ? below : above)[p] = true;
  }
  for (std::size_t p = 0; p < active.size (); ++p)
    active[p] = below[p] && above[p]; // else the plain RKPA (section 3.3)
  const Eigen::VectorXd at_x = terms (method, active, x, nullptr);
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero (at_x.size (), at_x.size ());
  for (std::size_t i = 0; i < method.nodes.size (); ++i)
    if (weights[i] > 0.0)
      moments += weights[i] * terms (method, active, method.nodes[i], nullptr) *
                 terms (method, active, method.nodes[i], &x).transpose ();
  const Eigen::VectorXd a = moments.fullPivLu ().solve (at_x);
  std::vector<double> phi (method.nodes.size (), 0.0);
  for (std::size_t i = 0; i < method.nodes.size (); ++i)
    if (weights[i] > 0.0)
      phi[i] = weights[i] * terms (method, active, method.nodes[i], &x).dot (a);
  return phi;
}

/** \brief f (x) by eq. (18). */
double
printedField (const PrintedMethod &method, const Vector3d &x)
{
  const std::vector<double> phi = printedShapeFunctions (method, x);
  double f = 0.0;
  for (std::size_t i = 0; i < phi.size (); ++i)
    f += phi[i] * (method.values[i] + (method.functional ? (x - method.nodes[i]).dot (method.normals[i]) : 0.0));
  return f;
}

constexpr double RADIUS = 0.45;

PrintedMethod
printedMethod (const ImplicitField &field)
{
  PrintedMethod method;
  const erkpa::OrientedPoints &points = field.points ();
  method.functional = field.options ().constraint == Constraint::FUNCTIONAL;
  for (std::size_t i = 0; i < points.size (); ++i)
    for (const int side : {0, 1, -1})
    {
      if (side != 0 && field.options ().constraint != Constraint::OFFSURFACE)
        continue;
      const Vector3d normal = points.normals[i].cast<double> ();
      const double offset = side == 0 ? 0.0 : side * field.options ().offset * RADIUS;
      method.nodes.emplace_back (points.positions[i].cast<double> () + offset * normal);
      method.normals.push_back (normal);
      method.values.push_back (offset);
      method.weights.push_back (points.confidences.empty () ? 1.0 : static_cast<double> (points.confidences[i]));
      method.radii.push_back (points.radii.empty () ? RADIUS : static_cast<double> (points.radii[i]));
    }
  return method;
}

void
expectSameField (const ImplicitField &field, const PrintedMethod &method, const std::string &name)
{
  for (int i = 0; i < 60; ++i)
  {
    const Vector3d x = randomPoint (0.6);
    const double printed = printedField (method, x);
    EXPECT_NEAR (field.value (x), printed, 1e-6 * (0.01 + std::abs (printed))) << name << " at " << x.transpose ();
  }
}

FieldOptions
paperOptions (Constraint constraint, Order order = Order::LINEAR)
{
  FieldOptions options = optionsOf (order, 0, RADIUS);
  options.constraint = constraint;
  return options;
}

/** \brief Those of a field that jumps across all edges of a box. */
FieldOptions
jumpingOptions (const Vector3d &half)
{
  FieldOptions options = paperOptions (Constraint::FUNCTIONAL);
  options.radius = 0.25;
  options.enrichment = EnrichmentType::JUMP;
  for (const Eigen::Vector4d &bisector : shapes::boxBisectors (half))
    options.sharp_surfaces.push_back (shapes::plane (bisector));
  return options;
}

const Eigen::Vector4d PLANE = [] { return Eigen::Vector4d (0.6, 0.48, 0.64, 0.1); }();

} // namespace

class Paper : public FieldTest
{
};

TEST_F (Paper, FieldIsThatOfItsEquationsForEveryOrderPlainAndEnriched)
{
  for (const Constraint constraint : {Constraint::FUNCTIONAL, Constraint::OFFSURFACE})
    for (const int order : {0, 1, 2})
      for (const bool sharp : {false, true})
      {
        constexpr Order ORDERS[] = {Order::CONSTANT, Order::LINEAR, Order::QUADRATIC};
        FieldOptions options = paperOptions (constraint, ORDERS[order]);
        if (sharp)
          options.sharp_surfaces.push_back (shapes::plane (PLANE));
        const auto field = shapes::field (nodesInCube (900), options);
        PrintedMethod method = printedMethod (*field);
        method.order = order;
        if (sharp)
          method.planes.push_back (PLANE);
        expectSameField (*field, method, "order " + std::to_string (order) + (sharp ? " enriched" : " plain"));
      }
}

TEST_F (Paper, ShapeFunctionsAreThoseOfTheMatrixThatIsNotSymmetric)
{
  FieldOptions options = paperOptions (Constraint::FUNCTIONAL);
  options.sharp_surfaces.push_back (shapes::plane (PLANE));
  const auto field = shapes::field (nodesInCube (900), options);
  PrintedMethod method = printedMethod (*field);
  method.planes.push_back (PLANE);
  for (int i = 0; i < 20; ++i)
  {
    const Vector3d x = randomPoint (0.6);
    std::vector<double> printed = printedShapeFunctions (method, x);
    for (const erkpa::ShapeFunction &shape : field->shapeFunctions (x))
    {
      EXPECT_NEAR (shape.phi, printed[static_cast<std::size_t> (shape.node)], 1e-8);
      printed[static_cast<std::size_t> (shape.node)] = 0.0;
    }
    for (const double phi : printed)
      EXPECT_EQ (phi, 0.0); // nodes out of reach
  }
}

TEST_F (Paper, ShapeFunctionsReproduceTheBasisAndTheEnrichment)
{
  for (const Constraint constraint : {Constraint::FUNCTIONAL, Constraint::OFFSURFACE})
    for (const Order order : {Order::LINEAR, Order::QUADRATIC})
    {
      FieldOptions options = paperOptions (constraint, order);
      options.sharp_surfaces.push_back (shapes::plane (PLANE));
      const auto field = shapes::field (nodesInCube (1500), options);
      const std::size_t count = order == Order::LINEAR ? 4 : MONOMIALS.size ();
      std::vector<std::pair<std::string, Function>> functions (
          MONOMIALS.begin (), MONOMIALS.begin () + static_cast<std::ptrdiff_t> (count));
      functions.emplace_back ("θH(θ)", [] (const Vector3d &p) { return std::max (theta (PLANE, p), 0.0); });
      for (const auto &[name, g] : functions)
        for (int i = 0; i < 20; ++i)
        {
          const Vector3d x = randomPoint (0.6);
          double sum = 0.0;
          for (const erkpa::ShapeFunction &shape : field->shapeFunctions (x))
          {
            const auto node = static_cast<std::size_t> (shape.node);
            const Vector3d normal = field->points ().normals[node].cast<double> ();
            sum += shape.phi *
                   g (field->points ().positions[node].cast<double> () + shape.side * options.offset * RADIUS * normal);
          }
          EXPECT_NEAR (sum, g (x), 1e-6) << name;
        }
    }
}

TEST_F (Paper, PointsOfLargerConfidenceCountForMore)
{
  const shapes::Samples nodes = nodesInCube (900);
  const auto points = shapes::points (nodes);
  for (std::size_t i = 0; i < points->size (); ++i)
    points->confidences.push_back (i % 3 == 0 ? 5.0f : 0.5f);
  for (const Constraint constraint : {Constraint::FUNCTIONAL, Constraint::OFFSURFACE})
  {
    const auto field = shapes::field (points, paperOptions (constraint));
    expectSameField (*field, printedMethod (*field), "confidences"); // Δx_i of eq. (13)
  }
}

TEST_F (Paper, EveryNodeMayHaveASupportOfItsOwn)
{
  const auto points = shapes::points (nodesInCube (900));
  std::uniform_real_distribution<float> radius (0.2f, 0.9f);
  for (std::size_t i = 0; i < points->size (); ++i)
    points->radii.push_back (radius (random_engine));
  FieldOptions options = paperOptions (Constraint::FUNCTIONAL);
  options.radius = 0.0;
  const auto field = shapes::field (points, options);
  expectSameField (*field, printedMethod (*field), "radii");
}

TEST_F (Paper, KernelsAreTheirFormulasAndDerivativesAgree)
{
  const auto square = [] (double t) { return t * t; };
  const std::vector<std::pair<KernelType, std::function<double (double)>>> kernels = {
      {KernelType::WENDLAND_C2, [&] (double t) { return square (square (1.0 - t)) * (4.0 * t + 1.0); }},
      {KernelType::WENDLAND_C4,
       [&] (double t) { return std::pow (1.0 - t, 6) * (35.0 * t * t + 18.0 * t + 3.0) / 3.0; }},
      {KernelType::GAUSSIAN, [&] (double t) { return std::exp (-4.0 * t * t) * std::pow (1.0 - t * t, 3); }},
      {KernelType::SINGULAR, [&] (double t) { return PrintedMethod ().kernel (t) / square (t); }},
  };
  for (const auto &[type, formula] : kernels)
  {
    const erkpa::Kernel::ConstPtr kernel = erkpa::makeKernel (type);
    EXPECT_TRUE (erkpa::checkKernel (*kernel).ok ());
    for (double t = 0.05; t < 1.0; t += 0.05)
    {
      constexpr double STEP = 1e-6;
      EXPECT_NEAR (kernel->weight (t), formula (t), 1e-12 * (1.0 + formula (t)));
      const double slope = (formula (t + STEP) - formula (t - STEP)) / (2.0 * STEP);
      EXPECT_NEAR (t * kernel->derivativeOverT (t), slope, 1e-6 * (1.0 + std::abs (slope)));
    }
    FieldOptions options = paperOptions (Constraint::FUNCTIONAL);
    options.kernel = type;
    const auto field = shapes::field (nodesInCube (900), options);
    PrintedMethod method = printedMethod (*field);
    method.kernel = formula;
    expectSameField (*field, method, "kernel");
  }
}

TEST_F (Paper, TakesAKernelOfTheUser)
{
  class Tent : public erkpa::Kernel
  {
  public:
    double
    weight (double t) const override
    {
      return (1.0 - t) * (1.0 - t);
    }

    double
    derivativeOverT (double t) const override
    {
      return -2.0 * (1.0 - t) / std::max (t, 1e-9);
    }
  };
  FieldOptions options = paperOptions (Constraint::FUNCTIONAL);
  options.user_kernel = std::make_shared<Tent> ();
  ASSERT_TRUE (ImplicitField::checkOptions (options).ok ());
  const auto field = shapes::field (nodesInCube (900), options);
  PrintedMethod method = printedMethod (*field);
  method.kernel = [] (double t) { return (1.0 - t) * (1.0 - t); };
  expectSameField (*field, method, "user's kernel");
}

TEST_F (Paper, FlatPatchesAndPerfectEdgesDoNotMakeTheMatrixSingular)
{
  const auto flat = [] (double, double) { return 0.0; };
  const auto roof = [] (double, double y) { return -std::abs (y); };
  FieldOptions options = paperOptions (Constraint::FUNCTIONAL);
  options.radius = 0.2;
  options.sharp_surfaces.push_back (shapes::plane ({0.0, 1.0, 0.0, 0.0}));
  const auto over_flat = shapes::field (shapes::sheet (60, flat), options);
  const auto over_roof = shapes::field (shapes::sheet (60, roof), options);
  for (int i = 0; i < 200; ++i)
  {
    const Vector3d p = randomPoint (0.7);
    EXPECT_NEAR (over_flat->value ({p.x (), p.y (), 0.1 * p.z ()}), 0.1 * p.z (), 1e-6);
    const double y = p.y ();
    EXPECT_NEAR (over_roof->value ({p.x (), y, roof (0.0, y)}), 0.0, 0.1 * options.radius);
  }
}

TEST_F (Paper, JumpEnrichmentMakesFunctionalConstraintsExactOnEdgesAndCorners)
{
  const Vector3d half (1.0, 0.7, 0.5);
  const FieldOptions options = jumpingOptions (half);
  const shapes::Samples box = shapes::box (12000, half);
  const auto field = shapes::field (box, options);
  int compared = 0;
  for (std::size_t i = 0; i < 600; ++i)
  {
    const Vector3d x = box.positions[i] + randomPoint (0.04);
    const double distance = (x.cwiseAbs () - half).maxCoeff (); // to the nearest face, as the bisectors divide them
    compared += std::abs (field->value (x) - distance) < 1e-5;
  }
  EXPECT_GT (compared, 590); // a few lie where a face is seen by hardly a node
}

/** \brief Newton's steps lead nowhere where a field that noise makes jump changes its sign in the jump. */
TEST_F (Paper, VerticesLieWhereTheFieldChangesItsSignEvenWhereItJumps)
{
  const Vector3d half (1.0, 0.7, 0.5);
  const FieldOptions options = jumpingOptions (half);
  shapes::Samples box = shapes::box (12000, half);
  for (Vector3d &position : box.positions)
    position += randomPoint (0.02);
  const auto field = shapes::field (box, options);
  erkpa::PolygonizerOptions grid;
  grid.voxel_size = 0.08;
  erkpa::TriangleMesh mesh;
  erkpa::PolygonizerReport report;
  ASSERT_TRUE (erkpa::polygonize (*field, grid, mesh, report).ok ());
  std::size_t off = 0, near = 0;
  for (const Eigen::Vector3f &vertex : mesh.vertices)
  {
    // Beyond the corners of noisy points jumps make sheets of their own, where f hangs on its last digits.
    if (std::abs ((vertex.cast<double> ().cwiseAbs () - half).maxCoeff ()) > 0.06)
      continue;
    ++near;
    bool changes = false;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Vector3d x = vertex.cast<double> (), step = 3e-3 * grid.voxel_size * Vector3d::Unit (axis);
      changes = changes || (field->value (x - step) < 0.0) != (field->value (x + step) < 0.0);
    }
    off += changes ? 0 : 1;
  }
  EXPECT_GT (near, 9 * mesh.vertices.size () / 10);
  EXPECT_LT (off, near / 400) << "of those in the middle of cells some may be";
}

TEST_F (Paper, JumpEnrichmentIsRefusedForConstraintsWithoutJumps)
{
  for (const Constraint constraint : {Constraint::HERMITE, Constraint::OFFSURFACE})
  {
    FieldOptions options = paperOptions (constraint);
    options.enrichment = EnrichmentType::JUMP;
    EXPECT_EQ (ImplicitField::checkOptions (options).status, erkpa::Status::INVALID_SETTING);
  }
}
