// SPDX-License-Identifier: BSD-3-Clause
#include "field_tests.h"

#include "block_field.h"
#include "local_field.h"
#include "moment_lattice.h"

#include <erkpa/marching_cubes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

namespace
{

using erkpa::BlockField;
using erkpa::Constraint;
using erkpa::KernelType;
using erkpa::LocalField;
using erkpa::LocalSample;
using erkpa::MomentLattice;
using erkpa::PolygonizerOptions;

constexpr double VOXEL = 0.02, MESH_VOXEL = 0.03;

PolygonizerOptions
withTolerance (double tolerance)
{
  PolygonizerOptions options;
  options.moment_tolerance = tolerance;
  options.voxel_size = VOXEL;
  return options;
}

/** \brief Points of a bumpy ball, whose normals are a little off, with the same radius for all supports. */
shapes::Samples
bumpyBall (int count)
{
  shapes::Samples samples;
  for (int i = 0; i < count; ++i)
  {
    const Vector3d way = randomPoint (1.0).normalized ();
    const double height = 1.0 + 0.05 * std::sin (5.0 * way[0]) * std::cos (4.0 * way[1]);
    samples.add (height * way, (way + 0.05 * randomPoint (1.0)).normalized ());
  }
  return samples;
}

/** \brief Interpolation through the four points of a lattice with spacing 1 around u in [0, 1), by Lagrange. */
std::array<double, 4>
weightsAt (double u)
{
  std::array<double, 4> weights{1.0, 1.0, 1.0, 1.0};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      if (i != j)
        weights[static_cast<std::size_t> (i)] *= (u - (j - 1)) / (i - j);
  return weights;
}

/** \brief A kernel around a node, interpolated at x. All in cells of the lattice. */
double
interpolatedWeight (const erkpa::Kernel &kernel, double per_radius, const Vector3d &node, const Vector3d &x)
{
  const Eigen::Array3d cell = x.array ().floor ();
  std::array<std::array<double, 4>, 3> along;
  for (int a = 0; a < 3; ++a)
    along[static_cast<std::size_t> (a)] = weightsAt (x[a] - cell[a]);
  double sum = 0.0;
  for (std::size_t i = 0; i < 64; ++i)
  {
    const std::array<std::size_t, 3> p{i % 4, i / 4 % 4, i / 16};
    const Vector3d point = (cell + Eigen::Array3d (p[0], p[1], p[2]) - 1.0).matrix ();
    const double t = (point - node).norm () / per_radius;
    sum += along[0][p[0]] * along[1][p[1]] * along[2][p[2]] * (t < 1.0 ? kernel.weight (t) : 0.0);
  }
  return sum;
}

class MomentLatticeTest : public FieldTest
{
protected:
  /** \brief A lattice that covers some points. */
  static std::unique_ptr<MomentLattice>
  latticeAt (const ImplicitField &field, const PolygonizerOptions &options, const std::vector<Vector3d> &points,
             const erkpa::lanes::Engine &engine = erkpa::lanes::bestEngine ())
  {
    std::unique_ptr<MomentLattice> lattice = MomentLattice::make (field, options, VOXEL, engine);
    if (lattice == nullptr)
      return lattice;
    std::vector<MomentLattice::Cells> cells;
    for (const Vector3d &x : points)
      lattice->listCell (x, cells);
    lattice->cover (cells);
    return lattice;
  }

  /** \brief Some points within a few voxels of a node. */
  static std::vector<Vector3d>
  pointsNear (const ImplicitField &field, std::size_t node)
  {
    std::vector<Vector3d> points;
    for (int i = 0; i < 21; ++i)
      points.push_back (field.points ().positions[node].cast<double> () + 3.0 * VOXEL * randomPoint (0.57));
    return points;
  }

  /** \brief Holds the interpolated field to the definition. \param[in] close in support radii */
  static void
  expectAgreement (const ImplicitField &field, const PolygonizerOptions &options, double close, double close_gradient)
  {
    for (const erkpa::lanes::Engine *engine : allEngines ())
      for (std::size_t node = 0; node < 2000; node += 400)
      {
        const std::vector<Vector3d> points = pointsNear (field, node);
        const auto lattice = latticeAt (field, options, points, *engine);
        ASSERT_NE (lattice, nullptr);
        BlockField block (field, *engine, lattice.get ());
        block.setReach (options.reach, 0.0, VOXEL);
        ASSERT_TRUE (block.gather (field.points ().positions[node].cast<double> (), 6.0 * VOXEL));
        for (const Vector3d &x : points)
          ASSERT_TRUE (block.addPoint (x));
        block.evaluate (true);
        LocalField local (field);
        for (std::size_t i = 0; i < points.size (); ++i)
          expectSame (local, points[i], block, i, close * field.typicalRadius (), close_gradient,
                      static_cast<std::size_t> (field.points ().channels));
      }
  }

private:
  static void
  expectSame (LocalField &local, const Vector3d &x, const BlockField &block, std::size_t i, double close,
              double close_gradient, std::size_t channels)
  {
    local.gather (x, 0.0);
    const LocalSample sample = local.sample (x);
    ASSERT_TRUE (block.isSettled (i));
    EXPECT_NEAR (block.value (i), sample.value, close);
    EXPECT_LT ((block.gradient (i) - sample.gradient).norm (),
               close_gradient * std::max (1.0, sample.gradient.norm ()));
    EXPECT_NEAR (block.borderOffset (i), sample.border_offset, 0.01);
    std::vector<float> attributes (channels);
    local.blendAttributes (attributes.data ());
    for (std::size_t c = 0; c < attributes.size (); ++c)
      EXPECT_NEAR (block.attribute (i, c), attributes[c], 0.01F);
  }
};

TEST_F (MomentLatticeTest, InterpolatedWeightsAreOffByNoMoreThanIsStated)
{
  for (const KernelType type :
       {KernelType::PAPER, KernelType::WENDLAND_C2, KernelType::WENDLAND_C4, KernelType::GAUSSIAN})
    for (const double per_radius : {4.0, 6.0, 9.0, 14.0})
    {
      const auto kernel = erkpa::makeKernel (type);
      const double stated = MomentLattice::errorOf (*kernel, per_radius) * kernel->weight (0.0);
      double worst = 0.0;
      for (int i = 0; i < 3000; ++i)
      {
        const Vector3d x = Vector3d::Constant (0.5) + randomPoint (0.5),
                       node = x + (i % 3) * 0.4 * per_radius * randomPoint (1.0);
        const double t = (x - node).norm () / per_radius, weight = t < 1.0 ? kernel->weight (t) : 0.0;
        worst = std::max (worst, std::abs (interpolatedWeight (*kernel, per_radius, node, x) - weight));
      }
      EXPECT_LE (worst, stated * (1.0 + 1e-9));
      EXPECT_GT (worst, 0.7 * stated) << "a bound that nothing comes near says little";
    }
}

TEST_F (MomentLatticeTest, TheFieldIsThatOfTheNodesForEveryInstructionSetBasisAndConstraint)
{
  const auto points = shapes::points (bumpyBall (20000));
  for (const Order order : {Order::LINEAR, Order::SPHERICAL})
    for (const Constraint constraint : {Constraint::HERMITE, Constraint::OFFSURFACE, Constraint::FUNCTIONAL})
    {
      FieldOptions options = optionsOf (order, 0, 0.4);
      options.constraint = constraint;
      const bool is_functional = constraint == Constraint::FUNCTIONAL; // which hangs on the nodes' thickness
      if (is_functional && order == Order::SPHERICAL)
        continue; // its pivots are raised everywhere, and LocalField is asked
      expectAgreement (*shapes::field (points, options), withTolerance (0.0025), is_functional ? 2e-3 : 3e-4,
                       is_functional ? 0.06 : 0.01);
    }
}

TEST_F (MomentLatticeTest, TheFieldIsThatOfTheNodesForEveryKernelWithConfidencesAndAttributes)
{
  const auto points = shapes::points (bumpyBall (12000));
  points->channels = 2;
  for (const Eigen::Vector3f &p : points->positions)
  {
    points->confidences.push_back (0.6F + 0.4F * p[0]);
    points->attributes.push_back (p[1]);
    points->attributes.push_back (p[2]);
  }
  for (const KernelType kernel : {KernelType::WENDLAND_C2, KernelType::WENDLAND_C4, KernelType::GAUSSIAN})
  {
    FieldOptions options = optionsOf (Order::SPHERICAL, 0, 0.5);
    options.kernel = kernel;
    expectAgreement (*shapes::field (points, options), withTolerance (0.004), 5e-4, 0.02);
  }
}

TEST_F (MomentLatticeTest, ASphereIsReproducedHoweverCoarseTheLattice)
{
  const auto field = shapes::field (shapes::sphere (12000), optionsOf (Order::SPHERICAL, 0, 0.5));
  const std::vector<Vector3d> points = pointsNear (*field, 7);
  const auto lattice = latticeAt (*field, withTolerance (0.03), points);
  ASSERT_NE (lattice, nullptr);
  BlockField block (*field, erkpa::lanes::bestEngine (), lattice.get ());
  ASSERT_TRUE (block.gather (points.front (), 6.0 * VOXEL));
  for (const Vector3d &x : points)
    block.addPoint (x);
  block.evaluate (true);
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    const double squared = (points[i] + field->points ().origin).squaredNorm ();
    EXPECT_NEAR (block.value (i), 0.5 * (squared - 1.0), 1e-5);
    EXPECT_LT ((block.gradient (i) - points[i] - field->points ().origin).norm (), 1e-4);
  }
}

TEST_F (MomentLatticeTest, TheGradientIsThatOfTheInterpolatedField)
{
  for (const Constraint constraint : {Constraint::HERMITE, Constraint::FUNCTIONAL})
  {
    FieldOptions options = optionsOf (Order::LINEAR, 0, 0.4);
    options.constraint = constraint;
    const auto field = shapes::field (bumpyBall (24000), options);
    const Vector3d x = field->points ().positions[5].cast<double> ();
    constexpr double STEP = 1e-3;
    std::vector<Vector3d> points{x};
    for (int a = 0; a < 3; ++a)
      for (const double side : {1.0, -1.0})
        points.push_back (x + side * STEP * Vector3d::Unit (a));
    const auto lattice = latticeAt (*field, withTolerance (0.03), points);
    ASSERT_NE (lattice, nullptr);
    for (const Vector3d &point : points)
      ASSERT_TRUE ((lattice->cellOf (point) == lattice->cellOf (x)).all ()) << "the gradient may jump between cells";
    BlockField block (*field, erkpa::lanes::bestEngine (), lattice.get ());
    ASSERT_TRUE (block.gather (x, VOXEL));
    for (const Vector3d &point : points)
      block.addPoint (point);
    block.evaluate (true);
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_NEAR (block.gradient (0)[static_cast<Eigen::Index> (a)],
                   (block.value (1 + 2 * a) - block.value (2 + 2 * a)) / (2.0 * STEP), 2e-3);
  }
}

TEST_F (MomentLatticeTest, IsThereForLargeSupportsOfAConstantRadiusOnly)
{
  const auto points = shapes::points (bumpyBall (24000));
  const auto lattice_for = [&] (const FieldOptions &options, double tolerance, double iso_level = 0.0)
  {
    PolygonizerOptions polygonizer = withTolerance (tolerance);
    polygonizer.iso_level = iso_level;
    return MomentLattice::make (*shapes::field (points, options), polygonizer, VOXEL) != nullptr;
  };
  FieldOptions options = optionsOf (Order::SPHERICAL, 0, 0.4);
  EXPECT_TRUE (lattice_for (options, 0.01));
  EXPECT_TRUE (lattice_for (options, 0.01, 0.03));
  EXPECT_FALSE (lattice_for (options, 0.01, 0.2)) << "far off the nodes, which are asked for there";
  EXPECT_FALSE (lattice_for (options, 0.0));
  EXPECT_FALSE (lattice_for (options, 1e-9)) << "as fine as nobody wants it";
  EXPECT_FALSE (lattice_for (optionsOf (Order::SPHERICAL, 0, 0.1), 0.01)) << "few nodes";
  EXPECT_FALSE (lattice_for (optionsOf (Order::QUADRATIC, 0, 0.4), 0.01)) << "whose gradients fit twice";
  EXPECT_FALSE (lattice_for (optionsOf (Order::SPHERICAL, 800), 0.01)) << "moments have kinks";
  options.interpolation = erkpa::Interpolation::COLLOCATION;
  EXPECT_FALSE (lattice_for (options, 0.01)) << "through the nodes, but for exact sums only";
  options.interpolation = erkpa::Interpolation::NONE;
  options.constraint = Constraint::FUNCTIONAL;
  EXPECT_FALSE (lattice_for (options, 0.01)) << "squares, whose pivots are raised everywhere";
  options.order = Order::LINEAR;
  EXPECT_TRUE (lattice_for (options, 0.01));
}

/** \brief Floats may see a point on the other side of a plane of the lattice, where the gradient is another. */
TEST_F (MomentLatticeTest, NextToPlanesOfTheLatticeTheNodesAreAsked)
{
  const auto field = shapes::field (bumpyBall (24000), optionsOf (Order::SPHERICAL, 0, 0.4));
  LocalField local (*field);
  for (std::size_t n = 0; n < 60; ++n)
  {
    Vector3d x = field->points ().positions[n].cast<double> ();
    auto lattice = latticeAt (*field, withTolerance (0.01), {x});
    ASSERT_NE (lattice, nullptr);
    const int axis = static_cast<int> (n % 3);
    x[axis] =
        (lattice->cellOf (x)[axis] + 1 - std::pow (10.0, -11.0 + static_cast<double> (n % 6))) * lattice->spacing ();
    lattice = latticeAt (*field, withTolerance (0.01), {x}); // whose cell alone it covers
    BlockField block (*field, erkpa::lanes::bestEngine (), lattice.get ());
    ASSERT_TRUE (block.gather (x + 0.5 * VOXEL * randomPoint (0.57), VOXEL));
    ASSERT_TRUE (block.addPoint (x));
    block.evaluate (true);
    local.gather (x, 0.0);
    EXPECT_LT ((block.gradient (0) - local.sample (x).gradient).norm (), 0.01);
  }
}

TEST_F (MomentLatticeTest, PointsFarApartAreLeftToTheNodes)
{
  const auto field = shapes::field (bumpyBall (24000), optionsOf (Order::SPHERICAL, 0, 0.4));
  const std::vector<Vector3d> points{field->points ().positions[5].cast<double> (),
                                     -field->points ().positions[5].cast<double> ()};
  const auto lattice = latticeAt (*field, withTolerance (0.01), points);
  ASSERT_NE (lattice, nullptr);
  BlockField block (*field, erkpa::lanes::bestEngine (), lattice.get ()), exact (*field);
  for (BlockField *one : {&block, &exact})
  {
    ASSERT_TRUE (one->gather (Vector3d::Zero (), 1.2));
    for (const Vector3d &x : points)
      ASSERT_TRUE (one->addPoint (x));
    one->evaluate (true);
  }
  for (std::size_t i = 0; i < points.size (); ++i)
    EXPECT_EQ (block.value (i), exact.value (i));
}

/** \brief The same with a coarser grid, for meshes. */
PolygonizerOptions
forMesh (double tolerance)
{
  PolygonizerOptions options = withTolerance (tolerance);
  options.voxel_size = MESH_VOXEL;
  return options;
}

/** \brief Meshes a field with and without a lattice. */
struct TwoMeshes
{
  erkpa::TriangleMesh mesh, exact;
  erkpa::PolygonizerReport report, exact_report;

  explicit TwoMeshes (const ImplicitField &field)
  {
    EXPECT_TRUE (erkpa::polygonize (field, forMesh (0.01), mesh, report).ok ());
    EXPECT_TRUE (erkpa::polygonize (field, forMesh (0.0), exact, exact_report).ok ());
    EXPECT_GT (report.moment_sums, 0U);
    EXPECT_LT (3 * report.moment_sums, 2 * exact_report.evaluations) << "or it spares nothing";
    EXPECT_EQ (exact_report.moment_sums, 0U);
  }
};

TEST_F (MomentLatticeTest, TheMeshIsClosedAndLiesWhereTheNodesPutIt)
{
  FieldOptions options = optionsOf (Order::LINEAR, 0, 0.35);
  options.constraint = Constraint::FUNCTIONAL; // which suffers most
  const auto field = shapes::field (bumpyBall (24000), options);
  const TwoMeshes meshes (*field);
  EXPECT_MESH_CONTRACT (meshes.mesh, true);
  EXPECT_NEAR (shapes::volume (meshes.mesh), shapes::volume (meshes.exact), 1e-3);
  LocalField local (*field);
  double sum = 0.0, worst = 0.0;
  constexpr std::size_t STEP = 19; // the definition takes its time
  for (std::size_t v = 0; v < meshes.mesh.vertices.size (); v += STEP)
  {
    const Vector3d x = meshes.mesh.vertices[v].cast<double> () - field->points ().origin;
    local.gather (x, 0.0);
    const LocalSample sample = local.sample (x);
    const double off = std::abs (sample.value) / sample.gradient.norm () / MESH_VOXEL;
    sum += off;
    worst = std::max (worst, off);
  }
  EXPECT_LT (STEP * sum / static_cast<double> (meshes.mesh.vertices.size ()), 0.01);
  EXPECT_LT (worst, 0.15);
}

TEST_F (MomentLatticeTest, AnOpenSurfaceEndsWhereItDoesWithoutALattice)
{
  shapes::Samples samples;
  for (int i = 0; i < 9000; ++i)
  {
    Vector3d p = randomPoint (1.0);
    p[2] = 0.1 * std::sin (3.0 * p[0]);
    samples.add (p, Vector3d (-0.3 * std::cos (3.0 * p[0]), 0.0, 1.0).normalized ());
  }
  const TwoMeshes meshes (*shapes::field (samples, optionsOf (Order::SPHERICAL, 0, 0.35)));
  EXPECT_NEAR (shapes::area (meshes.mesh) / shapes::area (meshes.exact), 1.0, 2e-3);
}

TEST_F (MomentLatticeTest, TheMeshDoesNotDependOnTheNumberOfThreads)
{
  const auto field = shapes::field (bumpyBall (24000), optionsOf (Order::SPHERICAL, 0, 0.35));
  std::array<erkpa::TriangleMesh, 2> meshes;
  for (std::size_t i = 0; i < 2; ++i)
  {
    PolygonizerOptions options = forMesh (0.01);
    options.threads = 1 + 2 * static_cast<int> (i);
    erkpa::PolygonizerReport report;
    ASSERT_TRUE (erkpa::polygonize (*field, options, meshes[i], report).ok ());
  }
  EXPECT_TRUE (meshes[0].vertices == meshes[1].vertices);
  EXPECT_TRUE (meshes[0].normals == meshes[1].normals);
  EXPECT_TRUE (meshes[0].triangles == meshes[1].triangles);
}

TEST_F (MomentLatticeTest, ToleranceThatMakesNoSenseIsRefused)
{
  const auto field = shapes::field (shapes::sphere (500));
  for (const double tolerance : {-0.1, 1.0, std::numeric_limits<double>::quiet_NaN ()})
  {
    erkpa::TriangleMesh mesh;
    erkpa::PolygonizerReport report;
    const erkpa::Outcome outcome = erkpa::polygonize (*field, withTolerance (tolerance), mesh, report);
    EXPECT_EQ (outcome.status, erkpa::Status::INVALID_SETTING);
    EXPECT_NE (outcome.message.find ("moments"), std::string::npos);
  }
}

} // namespace
