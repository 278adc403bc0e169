// SPDX-License-Identifier: BSD-3-Clause
#include "field_tests.h"

#include "block_field.h"
#include "face_tree.h"
#include "face_vote.h"
#include "local_field.h"
#include "pencil.h"
#include "support.h"

#include <erkpa/face_of_points.h>
#include <erkpa/sharp_detection.h>

#include <algorithm>
#include <array>

namespace
{

using erkpa::BlockField;
using erkpa::Constraint;
using erkpa::KernelType;
using erkpa::LocalField;
using erkpa::LocalSample;

/** \brief How far the quick field is from its definition over a ball, in support radii; gradients as they are. */
struct Difference
{
  double value = 0.0, value_with_gradient = 0.0, gradient = 0.0, radius = 0.0, border = 0.0;
  int compared = 0, gradients = 0, in_reach = 0;
};

class BlockFieldTest : public FieldTest
{
protected:
  static shapes::Samples
  wavySheet ()
  {
    shapes::Samples samples;
    for (int i = 0; i < 3000; ++i)
    {
      Vector3d p = randomPoint (1.0);
      p[2] = 0.1 * std::sin (3.0 * p[0]) + 0.1 * p[1] * p[1];
      const Vector3d normal (-0.3 * std::cos (3.0 * p[0]), -0.2 * p[1], 1.0);
      samples.add (p, normal.normalized ());
    }
    return samples;
  }

  static Difference
  compare (const ImplicitField &field, const erkpa::lanes::Engine &engine)
  {
    Difference worst;
    BlockField block (field, engine);
    LocalField local (field);
    constexpr double REACH = 0.9;
    block.setReach (REACH, 0.0, 0.01);
    for (int ball = 0; ball < 40; ++ball)
    {
      const Vector3d node = field.points ().positions[static_cast<std::size_t> (50 * ball)].cast<double> ();
      const double extent = 0.6 * field.typicalRadius ();
      if (!block.gather (node, extent))
        continue;
      std::vector<Vector3d> points;
      for (int i = 0; i < 37; ++i)
        points.push_back (node + extent * randomPoint (0.57));
      for (const Vector3d &x : points)
        block.addPoint (x);
      block.evaluate (false);
      for (std::size_t i = 0; i < points.size (); ++i)
        addValue (local, points[i], block, i, worst);
      block.evaluate (true);
      for (std::size_t i = 0; i < points.size (); ++i)
        addGradient (local, points[i], block, i, worst);
    }
    return worst;
  }

  /** \brief Holds the quick field to its definition, to the digits that floats leave. */
  static void
  expectClose (const shapes::Samples &samples, const FieldOptions &options, const erkpa::lanes::Engine &engine)
  {
    const double fewer = options.flatten < 1.0 ? 2.0 : 1.0; // nodes, and so digits
    const Order order = options.order;
    const Constraint constraint = options.constraint;
    const Difference worst = compare (*shapes::field (samples, options), engine);
    const auto name = std::string (engine.name) + " order " + std::to_string (static_cast<int> (order)) +
                      " constraint " + std::to_string (static_cast<int> (constraint)) + " radius " +
                      std::to_string (options.radius) + " flatten " + std::to_string (options.flatten);
    // Functional values hang on the thickness of the nodes alone, which floats know less well.
    const double scale = constraint == Constraint::HERMITE ? 1.0 : 20.0;
    EXPECT_GT (worst.compared, 500) << name;
    EXPECT_LT (worst.value, (order == Order::QUADRATIC ? 2e-3 : 2e-5 * scale)) << name;
    EXPECT_LT (worst.value_with_gradient, 2e-5 * fewer * scale) << name;
    EXPECT_LT (worst.gradient, 5e-4 * fewer * scale) << name;
    // Those that want LocalField: squares with functional values.
    const bool has_squares = order == Order::SPHERICAL || order == Order::QUADRATIC;
    EXPECT_EQ (worst.gradients > 500, !(has_squares && constraint == Constraint::FUNCTIONAL)) << name;
    EXPECT_LT (worst.radius, 1e-5) << name;
    EXPECT_LT (worst.border, 1e-3) << name;
    EXPECT_LE (worst.in_reach, 2) << name;
  }

  /** \brief Evaluates at some points of a ball; returns them. */
  static std::vector<Vector3d>
  evaluateAround (BlockField &block, const Vector3d &middle, double extent)
  {
    const bool is_rash = middle[0] > 0.1; // takes points for such on the surface, which some are not
    EXPECT_TRUE (block.gather (middle, extent, is_rash));
    std::vector<Vector3d> points;
    for (int i = 0; i < 21; ++i)
    {
      points.push_back (middle + extent * randomPoint (0.57));
      EXPECT_TRUE (block.addPoint (points.back ()));
    }
    block.evaluate (true);
    return points;
  }

  /** \brief Holds the quick field against its definition around some places.
   * \param[in] least_settled share of the points that must not be left to the definition
   */
  static void
  expectAgreement (const ImplicitField &field, const std::vector<Vector3d> &middles, double least_settled = 0.9)
  {
    const double spacing = field.spacing ();
    const bool is_functional = field.options ().constraint == Constraint::FUNCTIONAL;
    for (const erkpa::lanes::Engine *engine : allEngines ())
    {
      BlockField block (field, *engine);
      LocalField local (field);
      int compared = 0, settled = 0, keys = 0;
      for (const Vector3d &middle : middles)
      {
        const std::vector<Vector3d> points = evaluateAround (block, middle, spacing);
        for (std::size_t i = 0; i < points.size (); ++i)
        {
          local.gather (points[i], 0.0);
          const LocalSample sample = local.sample (points[i]);
          ++compared;
          if (!block.isSettled (i))
            continue;
          ++settled;
          keys += local.sideKey () == block.sideKey (i) ? 1 : 0;
          // Functional values hang on the thickness of the nodes alone, which floats know less well, the farther off.
          const double scale = is_functional ? 10.0 * std::max (1.0, std::abs (sample.value) / spacing) : 1.0;
          EXPECT_NEAR (sample.value, block.value (i), 1e-4 * scale * spacing) << engine->name;
          EXPECT_LT ((sample.gradient - block.gradient (i)).norm (),
                     2e-3 * scale * std::max (1.0, sample.gradient.norm ()))
              << engine->name;
        }
      }
      EXPECT_GT (settled, least_settled * compared) << engine->name;
      EXPECT_GT (keys, settled - settled / 100) << "a node on the very rim of a support may count or not";
    }
  }

  /** \brief The same of the pieces of f on sides of sharp surfaces, seen from places around. */
  static void
  expectAgreementOnSides (const ImplicitField &field, const std::vector<Vector3d> &middles, LocalField::Slope slope)
  {
    const double spacing = field.spacing ();
    for (const erkpa::lanes::Engine *engine : allEngines ())
    {
      BlockField block (field, *engine);
      LocalField local (field);
      int compared = 0, settled = 0;
      for (const Vector3d &middle : middles)
      {
        ASSERT_TRUE (block.gather (middle, spacing, true));
        std::vector<Vector3d> points;
        std::vector<std::vector<erkpa::Side>> sides;
        for (int i = 0; i < 7; ++i)
        {
          points.push_back (middle + spacing * randomPoint (0.57));
          sides.push_back ({{-1, middle + spacing * randomPoint (2.0)}, {-1, middle + spacing * randomPoint (2.0)}});
          ASSERT_TRUE (block.addSides (points.back (), sides.back ()));
        }
        std::vector<BlockField::SideAnswer> answers;
        block.sampleSides (slope, answers);
        ASSERT_EQ (answers.size (), 2 * points.size ());
        for (std::size_t a = 0; a < answers.size (); ++a)
        {
          ++compared;
          if (!answers[a].is_settled)
            continue;
          ++settled;
          std::vector<LocalSample> samples;
          local.sampleOnSides (points[a / 2], {sides[a / 2][a % 2]}, samples, slope);
          const double scale = field.options ().constraint == Constraint::FUNCTIONAL ? 10.0 : 1.0;
          EXPECT_NEAR (samples[0].value, answers[a].sample.value, 1e-4 * scale * spacing) << engine->name;
          EXPECT_LT ((samples[0].gradient - answers[a].sample.gradient).norm (),
                     2e-3 * scale * std::max (1.0, samples[0].gradient.norm ()))
              << engine->name;
        }
      }
      EXPECT_GT (settled, 0.9 * compared) << engine->name;
    }
  }

private:
  static void
  addValue (LocalField &local, const Vector3d &x, const BlockField &block, std::size_t i, Difference &worst)
  {
    local.gather (x, 0.0);
    const double value = local.value (x), radius = local.support ().radius ();
    EXPECT_EQ (!std::isnan (value), block.isSettled (i));
    if (std::isnan (value))
      return;
    ++worst.compared;
    worst.value = std::max (worst.value, std::abs (value - block.value (i)) / radius);
    worst.radius = std::max (worst.radius, std::abs (radius - block.radius (i)) / radius);
    const erkpa::Support &support = local.support ();
    const bool in_reach = support.quartileDistance () <= 0.9 * radius || support.nearestDistance () <= 0.01;
    worst.in_reach += in_reach == block.isInReach (i) ? 0 : 1;
  }

  static void
  addGradient (LocalField &local, const Vector3d &x, const BlockField &block, std::size_t i, Difference &worst)
  {
    if (!block.isSettled (i))
      return;
    local.gather (x, 0.0);
    const LocalSample sample = local.sample (x);
    ++worst.gradients;
    worst.value_with_gradient =
        std::max (worst.value_with_gradient, std::abs (sample.value - block.value (i)) / sample.radius);
    worst.gradient = std::max (worst.gradient, (sample.gradient - block.gradient (i)).norm ());
    worst.border = std::max (worst.border, std::abs (sample.border_offset - block.borderOffset (i)));
  }
};

TEST_F (BlockFieldTest, AgreesWithTheDefinitionForEveryInstructionSetBasisAndConstraint)
{
  const shapes::Samples samples = wavySheet ();
  for (const erkpa::lanes::Engine *engine : allEngines ())
    for (const Order order : {Order::CONSTANT, Order::LINEAR, Order::SPHERICAL, Order::QUADRATIC})
      for (const Constraint constraint : {Constraint::HERMITE, Constraint::FUNCTIONAL, Constraint::OFFSURFACE})
        for (const bool constant_radius : {false, true})
        {
          FieldOptions options;
          options.order = order;
          options.constraint = constraint;
          options.k = constant_radius ? 0 : 30;
          options.radius = constant_radius ? 0.15 : 0.0;
          expectClose (samples, options, *engine);
        }
}

TEST_F (BlockFieldTest, AgreesWithTheDefinitionWhereSupportsAreFlattened)
{
  const shapes::Samples samples = wavySheet ();
  for (const erkpa::lanes::Engine *engine : allEngines ())
    for (const Order order : {Order::CONSTANT, Order::LINEAR, Order::SPHERICAL, Order::QUADRATIC})
      for (const Constraint constraint : {Constraint::HERMITE, Constraint::FUNCTIONAL, Constraint::OFFSURFACE})
      {
        // Each with one of the ways to choose the radius.
        const KernelType kernel = constraint == Constraint::OFFSURFACE ? KernelType::WENDLAND_C2 : KernelType::PAPER;
        FieldOptions options = optionsOf (order, kernel == KernelType::PAPER ? 30 : 0);
        options.radius = kernel == KernelType::PAPER ? 0.0 : 0.2; // flattened, it holds fewer nodes
        options.constraint = constraint;
        options.kernel = kernel;
        options.flatten = 0.6;
        expectClose (samples, options, *engine);
      }
}

/** \brief There all nodes of the support lie near its rim, and their weights are what floats leave of differences. */
TEST_F (BlockFieldTest, AgreesWithTheDefinitionFarFromTheNodes)
{
  const auto field = shapes::field (wavySheet (), optionsOf (Order::SPHERICAL, 20));
  const double far = 10.0 * field->typicalRadius ();
  for (const erkpa::lanes::Engine *engine : allEngines ())
  {
    BlockField block (*field, *engine);
    LocalField local (*field);
    for (int i = 0; i < 200; ++i)
    {
      const Vector3d node = field->points ().positions[static_cast<std::size_t> (10 * i)].cast<double> ();
      const Vector3d x = node + far * (i % 2 == 0 ? 1.0 : -1.0) * Vector3d::UnitZ ();
      ASSERT_TRUE (block.gather (x, 0.0));
      block.addPoint (x);
      block.evaluate (false);
      local.gather (x, 0.0);
      const double value = local.value (x);
      EXPECT_NEAR (block.value (0), value, 2e-3 * local.support ().radius ()) << engine->name;
    }
  }
}

/** \brief Sums are taken about the middle of the ball, which is many supports away from most points here. */
TEST_F (BlockFieldTest, AgreesWithTheDefinitionInABallOfManySupports)
{
  for (const Order order : {Order::LINEAR, Order::SPHERICAL, Order::QUADRATIC})
    for (const bool is_fixed : {false, true})
    {
      const auto field = shapes::field (wavySheet (), is_fixed ? optionsOf (order, 0, 0.1) : optionsOf (order, 20));
      const double radius = field->typicalRadius (), extent = 9.0 * radius;
      for (const erkpa::lanes::Engine *engine : allEngines ())
      {
        BlockField block (*field, *engine);
        LocalField local (*field);
        ASSERT_TRUE (block.gather (Vector3d::Zero (), extent));
        std::vector<Vector3d> points;
        for (const Eigen::Vector3f &position : field->points ().positions)
          if (const Vector3d node = position.cast<double> (); node.norm () < extent - radius && points.size () < 300)
            points.push_back (node + 0.3 * radius * randomPoint (0.57));
        ASSERT_GT (points.size (), 100u);
        for (const Vector3d &x : points)
          ASSERT_TRUE (block.addPoint (x));
        block.evaluate (false);
        for (std::size_t i = 0; i < points.size (); ++i)
        {
          local.gather (points[i], 0.0);
          EXPECT_NEAR (block.value (i), local.value (points[i]), 2e-4 * radius)
              << engine->name << (is_fixed ? ", fixed radius, " : ", nearest, ") << static_cast<int> (order);
        }
      }
    }
}

/** \brief A box with the faces that are found on it; its points are denser where x is small. */
std::shared_ptr<erkpa::ImplicitField>
boxWithFaces (Order order, double radius = 0.0)
{
  const Vector3d half (0.5, 0.35, 0.25);
  shapes::Samples samples = shapes::box (6000, half);
  const shapes::Samples more = shapes::box (12000, half, 6);
  for (std::size_t i = 0; i < more.size (); ++i)
    if (more.positions[i][0] < 0.0)
      samples.add (more.positions[i], more.normals[i]);
  const auto points = shapes::points (samples);
  FieldOptions options = optionsOf (order, 20);
  options.radius = radius; // 0: by the nearest nodes
  EXPECT_TRUE (erkpa::findSharpSurfaces (*points, erkpa::PointLayout (*points, 0), erkpa::SharpOptions (), 0,
                                         options.sharp_surfaces)
                   .ok ());
  EXPECT_GE (options.sharp_surfaces.size (), 12u);
  return shapes::field (points, options);
}

/** \brief Where points are far sparser on one side of a ball, supports reach farther than its middle says. */
TEST_F (BlockFieldTest, AgreesWithTheDefinitionWhereTheDensityOfThePointsJumps)
{
  shapes::Samples samples;
  for (int i = 0; i < 6000; ++i)
  {
    const Vector3d p = randomPoint (1.0);
    if (p[0] < 0.0 || i % 40 == 0)
      samples.add ({p[0], p[1], 0.0}, Vector3d::UnitZ ());
  }
  const auto field = shapes::field (samples, optionsOf (Order::SPHERICAL, 20));
  for (const erkpa::lanes::Engine *engine : allEngines ())
  {
    BlockField block (*field, *engine);
    LocalField local (*field);
    double least = HUGE_VAL, most = 0.0;
    for (double y = -0.6; y <= 0.6; y += 0.3)
    {
      const std::vector<Vector3d> points = evaluateAround (block, {-0.05, y, 0.0}, 4.0 * field->spacing ());
      for (std::size_t i = 0; i < points.size (); ++i)
      {
        local.gather (points[i], 0.0);
        const LocalSample sample = local.sample (points[i]);
        ASSERT_TRUE (block.isSettled (i));
        EXPECT_NEAR (sample.radius, block.radius (i), 1e-5 * sample.radius);
        EXPECT_NEAR (sample.value, block.value (i), 1e-4 * sample.radius);
        least = std::min (least, sample.radius);
        most = std::max (most, sample.radius);
      }
    }
    EXPECT_GT (most, 2.0 * least) << "or nothing was tried";
  }
}

/** \brief Around edges and corners values come from two and three faces, and walls are thickened. */
TEST_F (BlockFieldTest, AgreesWithTheDefinitionWhereFacesMeet)
{
  for (const auto &[order, radius] : {std::pair{Order::LINEAR, 0.0}, std::pair{Order::SPHERICAL, 0.0},
                                      std::pair{Order::QUADRATIC, 0.0}, std::pair{Order::SPHERICAL, 0.06}})
  {
    const auto field = boxWithFaces (order, radius);
    const double spacing = field->spacing (), least_wall = 1.2 * spacing;
    for (const erkpa::lanes::Engine *engine : allEngines ())
    {
      BlockField block (*field, *engine);
      LocalField local (*field);
      block.thicken (least_wall);
      local.thicken (least_wall);
      int compared = 0, faces = 0, slopes = 0;
      for (const Vector3d &middle : shapes::boxEdgePoints ({0.5, 0.35, 0.25}, 4))
      {
        const std::vector<Vector3d> points = evaluateAround (block, middle, spacing);
        for (std::size_t i = 0; i < points.size (); ++i)
        {
          local.gather (points[i], 0.0);
          const LocalSample sample = local.sample (points[i]);
          ASSERT_TRUE (sample.isDefined ());
          ASSERT_TRUE (block.isSettled (i));
          ++compared;
          EXPECT_NEAR (sample.value, block.value (i), 1e-4 * spacing);
          EXPECT_NEAR (local.thickening (), block.thickening (i), 1e-3 * spacing);
          faces += local.face () == block.face (i) ? 1 : 0;
          slopes += (sample.gradient - block.gradient (i)).norm () < 1e-3 ? 1 : 0;
        }
      }
      // At equal values of two faces either may be taken.
      EXPECT_GT (faces, compared - compared / 100) << engine->name;
      EXPECT_GT (slopes, compared - compared / 100) << engine->name;
    }
  }
}

/** \brief The piece of f of every face goes on beyond its edges, as far as its nodes reach. */
TEST_F (BlockFieldTest, AgreesWithTheDefinitionOnTheSidesOfCreases)
{
  const auto by_nearest = boxWithFaces (Order::SPHERICAL), by_radius = boxWithFaces (Order::SPHERICAL, 0.06);
  for (const auto &[field, slope] :
       {std::pair{by_nearest, LocalField::Slope::EXACT}, std::pair{by_nearest, LocalField::Slope::OF_THE_FIT},
        std::pair{by_radius, LocalField::Slope::EXACT}})
    for (const erkpa::lanes::Engine *engine : allEngines ())
    {
      const double spacing = field->spacing ();
      BlockField block (*field, *engine);
      LocalField local (*field);
      int compared = 0, undefined = 0;
      for (const Vector3d &middle : shapes::boxEdgePoints ({0.5, 0.35, 0.25}, 4))
      {
        ASSERT_TRUE (block.gather (middle, spacing, true));
        std::vector<Vector3d> points;
        std::vector<erkpa::Side> sides;
        for (int face = 0; face < 6; ++face)
          sides.push_back ({face, middle});
        EXPECT_FALSE (block.addSides (middle + Vector3d::Constant (spacing), sides)) << "not in the ball";
        for (std::size_t i = 0; i < 9; ++i)
        {
          points.push_back (middle + spacing * randomPoint (0.57));
          ASSERT_TRUE (block.addSides (points.back (), sides));
        }
        std::vector<BlockField::SideAnswer> answers;
        block.sampleSides (slope, answers);
        ASSERT_EQ (answers.size (), points.size () * sides.size ());
        for (std::size_t q = 0; q < answers.size (); ++q)
        {
          std::vector<LocalSample> samples;
          local.sampleOnSides (points[q / sides.size ()], {sides[q % sides.size ()]}, samples, slope);
          ASSERT_TRUE (answers[q].is_settled);
          const erkpa::FieldSample &quick = answers[q].sample, &exact = samples.front ();
          ASSERT_EQ (quick.isDefined (), exact.isDefined ());
          undefined += exact.isDefined () ? 0 : 1;
          if (!exact.isDefined ())
            continue;
          ++compared;
          EXPECT_NEAR (exact.value, quick.value, 1e-4 * spacing) << engine->name;
          EXPECT_LT ((exact.gradient - quick.gradient).norm (), 1e-3) << engine->name;
        }
      }
      EXPECT_GT (compared, 1000);
      EXPECT_GT (undefined, 1000) << "faces that are out of reach";
    }
}

/** \brief Fits to one face reach farther than those to all nodes, and meet sharp surfaces there. */
TEST_F (BlockFieldTest, LeavesPointsToTheDefinitionWhereAFitToOneFaceReachesASharpSurface)
{
  const auto with_faces = boxWithFaces (Order::SPHERICAL);
  FieldOptions options = with_faces->options ();
  options.sharp_surfaces.push_back (shapes::plane ({1.0, 0.0, 0.0, 0.0}));
  const auto field = shapes::field (shapes::points (shapes::box (6000, {0.5, 0.35, 0.25})), options);
  const double radius = field->typicalRadius ();
  BlockField block (*field);
  const auto can_tell = [&] (double away)
  {
    const Vector3d edge (away, 0.35, 0.25);
    EXPECT_TRUE (block.gather (edge, 0.1 * radius));
    return block.addPoint (edge) && block.addSides (edge, {{0, edge}});
  };
  EXPECT_FALSE (can_tell (0.9 * radius));
  EXPECT_FALSE (can_tell (1.5 * radius));
  EXPECT_TRUE (can_tell (4.5 * radius));
}

/** \brief Where only the side of the surface is asked for, it is that of the faces, with values of fewer fits. */
TEST_F (BlockFieldTest, TellsTheSideOfTheSurfaceWithoutAskingTheFacesFarFromIt)
{
  const auto field = boxWithFaces (Order::SPHERICAL);
  const double spacing = field->spacing ();
  BlockField exact (*field), quick (*field);
  quick.setLevel (0.0);
  int compared = 0, others = 0;
  for (const Vector3d &middle : shapes::boxEdgePoints ({0.5, 0.35, 0.25}, 4))
  {
    const std::vector<Vector3d> points = evaluateAround (exact, middle, 1.5 * spacing);
    ASSERT_TRUE (quick.gather (middle, 1.5 * spacing));
    for (const Vector3d &x : points)
      EXPECT_TRUE (quick.addPoint (x));
    exact.evaluate (false);
    quick.evaluate (false);
    for (std::size_t i = 0; i < points.size (); ++i)
    {
      EXPECT_EQ (exact.value (i) > 0.0, quick.value (i) > 0.0);
      ++compared;
      others += exact.value (i) != quick.value (i) ? 1 : 0;
    }
  }
  EXPECT_GT (others, compared / 20) << "or nothing was saved";
  EXPECT_LT (others, 3 * compared / 4) << "near edges the faces are asked";
  EXPECT_LT (quick.evaluations (), exact.evaluations ());
}

/** \brief Places on a box at which sharp surfaces along its edges meet in all ways. */
std::vector<Vector3d>
placesOnBox (const Vector3d &half)
{
  std::vector<Vector3d> places = shapes::boxEdgePoints (half, 5);
  for (int i = 0; i < 8; ++i)
    places.emplace_back (i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1], i & 4 ? half[2] : -half[2]);
  for (int i = 0; i < 12; ++i)
    places.emplace_back (half[0], 0.2 * std::sin (0.5 * i), 0.2 * std::cos (0.5 * i));
  return places;
}

/** \brief Across sharp surfaces the field has kinks and their squares, which fade where few nodes lie beyond. */
TEST_F (BlockFieldTest, AgreesWithTheDefinitionWhereSharpSurfacesPass)
{
  const Vector3d half (0.5, 0.35, 0.25);
  const erkpa::RadiusFunction growing = [] (const Vector3d &x) { return 0.08 + 0.01 * x[0]; };
  for (const Order order : {Order::LINEAR, Order::SPHERICAL})
    for (const char *const support : {"nearest", "radius", "function"}) // some 20 nodes each
    {
      const bool by_nearest = support[0] == 'n', by_radius = support[0] == 'r';
      FieldOptions options = optionsOf (order, by_nearest ? 20 : 0, by_radius ? 0.08 : 0.0);
      if (!by_nearest && !by_radius)
        options.radius_function = growing;
      for (const Eigen::Vector4d &plane : shapes::boxBisectors (half))
        options.sharp_surfaces.push_back (shapes::plane (plane));
      erkpa::SharpSurface::ConstPtr ball; // curved: its kink looks one way only
      ASSERT_TRUE (erkpa::makeSharpSurface (erkpa::SurfaceModel::SPHERE, {0.5f, 0.0f, 0.0f, 0.2f}, ball).ok ());
      options.sharp_surfaces.push_back (ball);
      SCOPED_TRACE (support);
      expectAgreement (*shapes::field (shapes::box (6000, half), options), placesOnBox (half));
    }
}

/** \brief A twist about the z axis, and back. */
class Twist : public erkpa::SpaceWarp
{
public:
  Vector3d
  map (const Vector3d &x) const override
  {
    return Eigen::AngleAxisd (0.4 * x[2], Vector3d::UnitZ ()) * x;
  }

  Eigen::Matrix3d
  jacobian (const Vector3d &x) const override
  {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd (0.4 * x[2], Vector3d::UnitZ ()).toRotationMatrix ();
    Eigen::Matrix3d all = turn;
    all.col (2) += 0.4 * Vector3d::UnitZ ().cross (turn * x);
    return all;
  }
};

/** \brief Functions, surfaces seen through a warp, faces of points and what lies between faces, limited or not. */
TEST_F (BlockFieldTest, AgreesWithTheDefinitionWhereSharpSurfacesOfAnyKindPass)
{
  const Vector3d half (0.5, 0.35, 0.25);
  erkpa::Extent::ConstPtr extent;
  ASSERT_TRUE (erkpa::makeBoxExtent ({-0.6, -0.4, -0.2}, {0.3, 0.2, 0.3}, extent).ok ());
  const auto twist = std::make_shared<const Twist> ();
  const auto across = [] (double x) { return shapes::plane ({1.0, 0.1, -0.05, -x}); };
  erkpa::SharpSurface::ConstPtr ball;
  ASSERT_TRUE (erkpa::makeSharpSurface (erkpa::SurfaceModel::SPHERE, {0.3f, 0.0f, 0.25f, 0.2f}, ball).ok ());
  const shapes::Samples cap = shapes::sphere (600, 0.3);
  std::vector<Eigen::Vector3f> positions, normals;
  for (std::size_t i = 0; i < cap.positions.size (); ++i)
  {
    positions.push_back (cap.positions[i].cast<float> ());
    normals.push_back (cap.normals[i].cast<float> ());
  }
  const auto wave = [] (const Vector3d &x) { return x[1] - 0.1 * std::sin (4.0 * x[0]); };
  const auto slope = [] (const Vector3d &x) { return Vector3d (-0.4 * std::cos (4.0 * x[0]), 1.0, 0.0); };
  const std::vector<erkpa::SharpSurface::ConstPtr> surfaces = {
      erkpa::makeSharpFunction (wave, slope),
      erkpa::makeWarpedSharpSurface (across (0.2), twist),
      erkpa::makeWarpedSharpSurface (erkpa::makeLimited (across (-0.1), extent), twist),
      erkpa::makeLimited (erkpa::makeWarpedSharpSurface (across (-0.3), twist), extent, 0.1),
      erkpa::makeReversed (ball),
      erkpa::makeSharpBetween (ball, shapes::plane ({0.6, 0.0, 0.8, -0.2})),
      erkpa::makeFaceOfPoints (positions, normals, Vector3d (-0.3, 0.0, 0.1), 0)};
  for (const erkpa::SharpSurface::ConstPtr &surface : surfaces)
  {
    FieldOptions options = optionsOf (Order::SPHERICAL, 20);
    options.sharp_surfaces.push_back (surface);
    SCOPED_TRACE (&surface - surfaces.data ());
    const auto field = shapes::field (shapes::box (3000, half), options);
    EXPECT_TRUE (BlockField::canSampleSides (*field));
    expectAgreement (*field, placesOnBox (half));
  }
}

/** \brief Blocks see more surfaces than a vector takes; only where too many pass one place the definition is asked. */
TEST_F (BlockFieldTest, AgreesWithTheDefinitionWhereManySharpSurfacesPass)
{
  const Vector3d half (0.5, 0.35, 0.25);
  FieldOptions options = optionsOf (Order::SPHERICAL, 0, 0.08);
  for (int i = 0; i < 5; ++i)
    options.sharp_surfaces.push_back (shapes::plane ({std::sin (0.6 * i), std::cos (0.6 * i), 0.0, 0.0}));
  for (const double x : {-0.45, -0.4, -0.35, -0.3, -0.25, -0.2, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45})
    options.sharp_surfaces.push_back (shapes::plane ({1.0, 0.0, 0.2, -x}));
  const shapes::Samples box = shapes::box (3000, half);
  std::vector<Vector3d> places;
  for (int i = 0; i < 33; ++i)
    places.emplace_back (0.025 * i - 0.4, 0.0, half[2]);
  const auto field = shapes::field (box, options);
  ASSERT_EQ (field->pencils ().size (), 3u);
  expectAgreement (*field, places);
  for (int i = 5; i < 8; ++i) // one place is passed by eight of them
    options.sharp_surfaces.push_back (shapes::plane ({std::sin (0.7 * i), std::cos (0.7 * i), 0.0, 0.0}));
  const auto open_at = [&] (const Vector3d &middle)
  {
    const auto crowded = shapes::field (box, options);
    BlockField block (*crowded);
    const std::vector<Vector3d> points = evaluateAround (block, middle, crowded->spacing ());
    int open = 0;
    for (std::size_t i = 0; i < points.size (); ++i)
      open += block.isUnsettled (i) ? 1 : 0;
    return open;
  };
  EXPECT_EQ (open_at ({0.0, 0.0, half[2]}), 21);
  EXPECT_EQ (open_at ({0.0, half[1], 0.1}), 0);
  for (int i = 0; i < 25; ++i) // more than a call takes, all along the top
    options.sharp_surfaces.push_back (shapes::plane ({0.0, 0.002 * i, 1.0, -half[2]}));
  EXPECT_EQ (open_at ({0.0, 0.0, half[2]}), 21);
  EXPECT_EQ (open_at ({0.0, half[1], 0.1}), 0);
}

/** \brief Seen from elsewhere, the piece of f is meant that holds there: kinks go on as if they did not bend. */
TEST_F (BlockFieldTest, AgreesWithTheDefinitionOnTheSidesOfSharpSurfaces)
{
  const Vector3d half (0.5, 0.35, 0.25);
  erkpa::Extent::ConstPtr extent;
  ASSERT_TRUE (erkpa::makeBoxExtent ({-0.45, -0.4, -0.2}, {0.3, 0.2, 0.3}, extent).ok ());
  erkpa::SharpSurface::ConstPtr ball; // curved: its kink looks one way only
  ASSERT_TRUE (erkpa::makeSharpSurface (erkpa::SurfaceModel::SPHERE, {0.5f, 0.0f, 0.0f, 0.2f}, ball).ok ());
  for (const Constraint constraint : {Constraint::HERMITE, Constraint::FUNCTIONAL})
    for (const erkpa::EnrichmentType enrichment : {erkpa::EnrichmentType::KINK, erkpa::EnrichmentType::JUMP})
    {
      if (constraint == Constraint::HERMITE && enrichment == erkpa::EnrichmentType::JUMP)
        continue;
      FieldOptions options = optionsOf (Order::LINEAR, 0, 0.12);
      options.constraint = constraint;
      options.enrichment = enrichment;
      options.sharp_surfaces.push_back (ball);
      for (const Eigen::Vector4d &plane : shapes::boxBisectors (half))
        options.sharp_surfaces.push_back (plane[3] < 0.0 ? shapes::plane (plane)
                                                         : erkpa::makeLimited (shapes::plane (plane), extent));
      const auto field = shapes::field (shapes::box (6000, half), options);
      for (const LocalField::Slope slope : {LocalField::Slope::EXACT, LocalField::Slope::OF_THE_FIT})
        expectAgreementOnSides (*field, shapes::boxEdgePoints (half, 3), slope);
    }
}

/** \brief The paper's own way, eq. (2) and (22), and with H(θ) in its place: no squares, and pivots that are raised
 * where nodes are flat. */
TEST_F (BlockFieldTest, AgreesWithTheDefinitionWhereSharpSurfacesPassFunctionalValues)
{
  const Vector3d half (0.5, 0.35, 0.25);
  erkpa::Extent::ConstPtr extent;
  ASSERT_TRUE (erkpa::makeBoxExtent ({-0.45, -0.4, -0.2}, {0.3, 0.2, 0.3}, extent).ok ());
  erkpa::SharpSurface::ConstPtr ball;
  ASSERT_TRUE (erkpa::makeSharpSurface (erkpa::SurfaceModel::SPHERE, {0.5f, 0.0f, 0.0f, 0.2f}, ball).ok ());
  std::vector<Vector3d> places; // some of them, for there are many ways to combine settings
  for (const Vector3d &place : placesOnBox (half))
    if (places.empty () || (place - places.back ()).norm () > 0.25)
      places.push_back (place);
  for (const erkpa::EnrichmentType enrichment : {erkpa::EnrichmentType::KINK, erkpa::EnrichmentType::JUMP})
    for (const Order order : {Order::LINEAR, Order::SPHERICAL})
      for (const bool by_nearest : {true, false})
        for (const bool is_limited : {false, true})
        {
          FieldOptions options = optionsOf (order, by_nearest ? 20 : 0, by_nearest ? 0.0 : 0.12);
          options.constraint = Constraint::FUNCTIONAL;
          options.enrichment = enrichment;
          options.sharp_surfaces.push_back (ball);
          for (const Eigen::Vector4d &plane : shapes::boxBisectors (half))
            options.sharp_surfaces.push_back (is_limited ? erkpa::makeLimited (shapes::plane (plane), extent)
                                                         : shapes::plane (plane));
          SCOPED_TRACE (std::string (by_nearest ? "nearest" : "radius") + (is_limited ? " limited" : "") +
                        (enrichment == erkpa::EnrichmentType::JUMP ? " jump" : "") +
                        (order == Order::LINEAR ? " linear" : ""));
          // Pivots that are raised turn squares, of which the spherical basis has one: many places want the definition.
          expectAgreement (*shapes::field (shapes::box (6000, half), options), places,
                           order == Order::LINEAR ? 0.9 : 0.1);
        }
}

/** \brief Limited ones fade around the ends of their extents, and so do the corners that they make with others. */
TEST_F (BlockFieldTest, AgreesWithTheDefinitionWhereLimitedSharpSurfacesFade)
{
  const Vector3d half (0.5, 0.35, 0.25);
  for (const double fade : {0.0, 0.1})
  {
    FieldOptions options = optionsOf (Order::SPHERICAL, 20);
    for (const Eigen::Vector4d &plane : shapes::boxBisectors (half))
    {
      erkpa::Extent::ConstPtr extent;
      ASSERT_TRUE (erkpa::makeBoxExtent ({-0.45, -0.4, -0.2}, {0.3, 0.2, 0.3}, extent).ok ());
      options.sharp_surfaces.push_back (erkpa::makeLimited (shapes::plane (plane), extent, fade));
    }
    expectAgreement (*shapes::field (shapes::box (6000, half), options), placesOnBox (half));
  }
}

/** \brief Its continuation would close gaps and make flaps where the data ends. */
TEST (FaceVote, AFaceHasNoSayFartherOutThanItsNodesReach)
{
  const auto vote_with = [] (double near, double far)
  {
    erkpa::FaceVote vote;
    vote.start (1.0);
    vote.addVoter ({0, Vector3d::Zero (), 1.0});
    vote.addFace (7, -0.5, Vector3d::UnitX (), near, {0.0});
    vote.addFace (8, 0.5, Vector3d::UnitY (), far, {0.5});
    vote.dropFarFaces ();
    return vote;
  };
  const auto groups_of = [] (const erkpa::FaceVote &vote) { return vote.electTree ().faces; };
  EXPECT_EQ (groups_of (vote_with (0.2, 0.9)), 2);
  EXPECT_EQ (groups_of (vote_with (0.2, 1.4)), 1);
  EXPECT_EQ (vote_with (0.2, 1.4).groupOf (0), 7);
  EXPECT_EQ (vote_with (1.4, 0.2).groupOf (0), 8);
  EXPECT_EQ (groups_of (vote_with (1.4, 1.5)), 2) << "unless there is no other";
}

} // namespace

TEST (FaceTree, SaysEveryWayToNestMaximaAndMinimaOnce)
{
  // As many as there are series-parallel networks of so many labelled resistors.
  const std::array<std::size_t, 4> expected{1, 2, 8, 52};
  for (int faces = 1; faces <= erkpa::FaceTree::MAX_FACES; ++faces)
    EXPECT_EQ (erkpa::treesOf (faces).size (), expected[static_cast<std::size_t> (faces) - 1]);
}

TEST (FaceTree, TakesTheValueThatItsStepsSay)
{
  for (const erkpa::FaceTree &tree : erkpa::treesOf (4))
    for (int time = 0; time < 100; ++time)
    {
      std::array<double, 4> values{};
      for (double &value : values)
        value = randomPoint (1.0)[0];
      std::array<double, 4> left = values;
      std::size_t last = 0;
      for (const erkpa::FaceTree::Step &step : tree.steps)
      {
        last = static_cast<std::size_t> (step.face);
        const double other = left[static_cast<std::size_t> (step.other)];
        left[last] = step.larger ? std::max (left[last], other) : std::min (left[last], other);
      }
      EXPECT_EQ (values[static_cast<std::size_t> (tree.winner (values.data ()))], left[last]);
    }
}
