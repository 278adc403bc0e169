// SPDX-License-Identifier: BSD-3-Clause
#include "noise.h"
#include "normal_flips.h"
#include "normal_sharpening.h"
#include "normal_smoothing.h"
#include "shapes.h"

#include <erkpa/normals.h>

#include <gtest/gtest.h>

using Eigen::Vector3d;
using erkpa::NeighborSearch;
using erkpa::OrientedPoints;

namespace
{

/** \brief A shape's points with normals estimated from 20 neighbours, on the side of the true ones. */
struct Estimated
{
  explicit Estimated (const shapes::Samples &samples, double noise = 0.0)
      : truth (samples.normals), points (*shapes::points (samples)),
        spacing (erkpa::measureSpacing (points.positions, *erkpa::makeKdTreeSearch (points.positions), 1))
  {
    std::mt19937 random (4);
    std::normal_distribution<float> normal (0.0f, 1.0f);
    for (Eigen::Vector3f &p : points.positions)
      p += static_cast<float> (noise * spacing) * Eigen::Vector3f (normal (random), normal (random), normal (random));
    search = erkpa::makeKdTreeSearch (points.positions);
    exact = points;
    points.normals.assign (points.size (), Eigen::Vector3f::Zero ());
    erkpa::NormalOptions options;
    options.k = K;
    erkpa::Orientation orientation = erkpa::Orientation::NONE;
    EXPECT_TRUE (erkpa::estimateNormals (points, erkpa::PointLayout (points, 0), options, orientation).ok ());
    for (std::size_t i = 0; i < points.size (); ++i)
      if (points.normals[i].cast<double> ().dot (truth[i]) < 0.0)
        points.normals[i] *= -1.0f;
  }

  void
  sharpen (int threads = 0)
  {
    erkpa::sharpenNormals (*search, {spacing, erkpa::positionNoise (*search, spacing, threads, points), K}, threads,
                           points);
  }

  /** \brief Share of the normals that are off by more than some degrees. */
  double
  shareBeyond (double degrees) const
  {
    int beyond = 0;
    for (std::size_t i = 0; i < points.size (); ++i)
      beyond += points.normals[i].cast<double> ().dot (truth[i]) < std::cos (degrees * M_PI / 180.0);
    return beyond / static_cast<double> (points.size ());
  }

  double
  meanError () const
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < points.size (); ++i)
      sum +=
          Eigen::AngleAxisd (Eigen::Quaterniond::FromTwoVectors (points.normals[i].cast<double> (), truth[i])).angle ();
    return sum / static_cast<double> (points.size ()) * 180.0 / M_PI;
  }

  static constexpr int K = 20;
  std::vector<Vector3d> truth;
  OrientedPoints points, exact;
  double spacing;
  NeighborSearch::ConstPtr search;
};

/** \brief Turns normals at random, by \a degrees in the root mean square. */
void
shake (OrientedPoints &points, double degrees)
{
  std::mt19937 random (9);
  std::normal_distribution<float> normal (0.0f, static_cast<float> (std::tan (degrees * M_PI / 180.0) / M_SQRT2));
  for (Eigen::Vector3f &n : points.normals)
    n = (n + Eigen::Vector3f (normal (random), normal (random), normal (random))).normalized ();
}

/** \brief Two faces that meet in the y axis, convex; \a degrees between their normals. */
shapes::Samples
roof (double degrees)
{
  const double slope = std::tan (0.5 * degrees * M_PI / 180.0);
  shapes::Samples samples = shapes::sheet (60, [=] (double x, double) { return -slope * std::abs (x); });
  for (std::size_t i = 0; i < samples.size (); ++i)
    samples.normals[i] = Vector3d (samples.positions[i].x () < 0.0 ? -slope : slope, 0.0, 1.0).normalized ();
  return samples;
}

} // namespace

TEST (NormalSharpening, GivesABoxTheNormalsOfItsFacesUpToItsEdges)
{
  for (const Vector3d &half : {Vector3d (1.0, 0.7, 0.5), Vector3d (1.0, 0.7, 0.05), Vector3d (1.0, 0.1, 0.1)})
  {
    Estimated box (shapes::box (6000, half));
    EXPECT_GT (box.shareBeyond (1.0), 0.15);
    box.sharpen ();
    EXPECT_LT (box.shareBeyond (1.0), 0.03); // on the edges themselves
    EXPECT_LT (box.meanError (), 1.0);
  }
}

TEST (NormalSharpening, KeepsTheFacesOfABluntEdgeApart)
{
  for (const double degrees : {30.0, 60.0, 120.0})
  {
    Estimated edge (roof (degrees));
    EXPECT_GT (edge.shareBeyond (0.1 * degrees), 0.03);
    edge.sharpen ();
    EXPECT_LT (edge.shareBeyond (0.1 * degrees), 0.003) << degrees;
  }
}

TEST (NormalSharpening, MakesThoseOfSmoothSurfacesMoreAccurate)
{
  for (const shapes::Samples &shape :
       {shapes::torus (10000, 1.0, 0.4), shapes::sphere (5000),
        shapes::sheet (100, [] (double x, double y) { return 0.1 * std::sin (6.0 * x) * std::cos (5.0 * y); })})
  {
    Estimated smooth (shape);
    const double before = smooth.meanError ();
    smooth.sharpen ();
    EXPECT_LT (smooth.meanError (), 0.5 * before);
  }
}

TEST (NormalSharpening, HelpsWithNoisyPointsToo)
{
  Estimated box (shapes::box (10000, {1.0, 0.7, 0.5}), 0.1);
  const double mean = box.meanError (), beyond = box.shareBeyond (15.0);
  box.sharpen ();
  EXPECT_LT (box.meanError (), 0.6 * mean);
  EXPECT_LT (box.shareBeyond (15.0), 0.3 * beyond);
}

TEST (NormalSharpening, DoesNotDependOnTheNumberOfThreads)
{
  Estimated one (shapes::box (3000, {1.0, 0.7, 0.5}), 0.05), three = one;
  one.sharpen (1);
  three.sharpen (3);
  EXPECT_TRUE (one.points.normals == three.points.normals);
}

TEST (NormalSharpening, TellsSmearedNormalsFromExactAndFromRandomOnes)
{
  const Estimated box (shapes::box (6000, {1.0, 0.7, 0.5})), sphere (shapes::sphere (3000));
  const auto areSmeared = [] (const Estimated &shape, const OrientedPoints &points)
  {
    return erkpa::areNormalsSmeared (
        *shape.search, {shape.spacing, erkpa::positionNoise (*shape.search, shape.spacing, 0, points), Estimated::K}, 0,
        points);
  };
  EXPECT_TRUE (areSmeared (box, box.points));
  EXPECT_FALSE (areSmeared (box, box.exact));
  OrientedPoints shaken = box.exact;
  shake (shaken, 10.0);
  EXPECT_FALSE (areSmeared (box, shaken));
  EXPECT_FALSE (areSmeared (sphere, sphere.points)); // no edges
}

/** \brief Flips a share of normals at random. */
OrientedPoints
flipped (const shapes::Samples &samples, double share)
{
  OrientedPoints points = *shapes::points (samples);
  std::mt19937 random (7);
  std::bernoulli_distribution flip (share);
  for (Eigen::Vector3f &normal : points.normals)
    normal *= flip (random) ? -1.0f : 1.0f;
  return points;
}

/** \brief What becomes of normals whose signs do not agree, as reconstruction goes about it. */
erkpa::NormalSigns
settleSigns (OrientedPoints &points)
{
  const erkpa::PointLayout layout (points, 0);
  const erkpa::NormalSigns signs = erkpa::judgeSigns (*layout.search, 0, points);
  if (signs == erkpa::NormalSigns::CONTRADICT)
    erkpa::reorientNormals (points, layout, {});
  else if (signs != erkpa::NormalSigns::AGREE)
    erkpa::turnFlippedNormals (*layout.search, signs, 0, points);
  return signs;
}

std::size_t
countWrong (const OrientedPoints &points, const shapes::Samples &samples)
{
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < points.size (); ++i)
    wrong += points.normals[i].cast<double> ().dot (samples.normals[i]) < 0.0 ? 1 : 0;
  return wrong;
}

TEST (NormalFlips, AreTurnedWhateverTheirShare)
{
  const shapes::Samples torus = shapes::torus (8000, 1.0, 0.4), box = shapes::box (8000, {1.0, 0.7, 0.5});
  for (const auto &[share, signs] :
       {std::pair{0.0, erkpa::NormalSigns::AGREE}, std::pair{0.03, erkpa::NormalSigns::SINGLE_ONES_FLIPPED},
        std::pair{0.1, erkpa::NormalSigns::MANY_FLIPPED}, std::pair{0.2, erkpa::NormalSigns::MANY_FLIPPED},
        std::pair{0.35, erkpa::NormalSigns::CONTRADICT}, std::pair{0.5, erkpa::NormalSigns::CONTRADICT}})
    for (const shapes::Samples *samples : {&torus, &box})
    {
      OrientedPoints points = flipped (*samples, share);
      EXPECT_EQ (settleSigns (points), signs) << share;
      EXPECT_LE (countWrong (points, *samples), samples->size () / 500) << share << ", single ones at edges are let be";
    }
}

/** \brief Two sheets of unequal density, a distance apart, with their normals away from each other. */
shapes::Samples
unequalSheets (double thickness, int above, int below)
{
  shapes::Samples sheets;
  std::mt19937 random (3);
  std::uniform_real_distribution<double> unit (-1.0, 1.0);
  for (int i = 0; i < above + below; ++i)
  {
    const double side = i < above ? 1.0 : -1.0, x = unit (random), y = unit (random);
    sheets.add ({x, y, 0.5 * side * thickness}, {0.0, 0.0, side});
  }
  return sheets;
}

TEST (NormalFlips, AreNotTheOtherSidesOfThinWalls)
{
  constexpr double SPACING = 2.0 / 77.0; // 6000 points on 2 x 2
  for (const double thickness : {0.6, 0.3, 0.15})
    for (const int below : {6000, 1500, 300})
    {
      const shapes::Samples sheets = unequalSheets (thickness * SPACING, 6000, below);
      OrientedPoints points = *shapes::points (sheets);
      settleSigns (points);
      EXPECT_LE (countWrong (points, sheets), sheets.size () / 500) << thickness << " spacings, " << below << " points below";
    }
}

TEST (NormalFlips, AreTurnedOnASphereBesideAThinPlateThatIsLetBe)
{
  shapes::Samples both = shapes::sphere (8000);
  const shapes::Samples plate = unequalSheets (0.3 * 2.0 / std::sqrt (500.0), 500, 500);
  for (std::size_t i = 0; i < plate.size (); ++i)
    both.add (0.3 * plate.positions[i] + Vector3d (2.0, 0.0, 0.0), plate.normals[i]);
  OrientedPoints points = flipped (both, 0.08);
  const std::size_t wrong = countWrong (points, both);
  settleSigns (points);
  EXPECT_LT (countWrong (points, both), wrong / 4);
}

TEST (NormalFlips, DoNotTurnASurfaceThatMostNormalsGiveTheOtherWay)
{
  shapes::Samples room = shapes::sphere (4000);
  for (Vector3d &normal : room.normals)
    normal = -normal;
  OrientedPoints points = flipped (room, 0.3);
  EXPECT_EQ (settleSigns (points), erkpa::NormalSigns::CONTRADICT);
  EXPECT_LE (countWrong (points, room), room.size () / 500);
}

TEST (NormalSmoothing, TakesRandomErrorsOffAndKnowsTheirSize)
{
  Estimated box (shapes::box (10000, {1.0, 0.7, 0.5}));
  EXPECT_LT (erkpa::normalNoise (*box.search, box.spacing, 0, box.exact), 0.1);
  box.points = box.exact;
  shake (box.points, 10.0);
  EXPECT_NEAR (erkpa::normalNoise (*box.search, box.spacing, 0, box.points), 10.0, 1.0);
  const double before = box.meanError ();
  erkpa::smoothNormals (*box.search, box.spacing, 3, 24, 25.0, 0, box.points);
  EXPECT_LT (box.meanError (), 0.3 * before);
  EXPECT_LT (box.shareBeyond (15.0), 0.01); // the edges stay
}

TEST (NormalSmoothing, KnowsTheNoiseOfThePositionsAndTakesNoCurvatureForIt)
{
  const shapes::Samples torus = shapes::torus (10000, 1.0, 0.4);
  for (const double noise : {0.0, 0.05, 0.2, 0.4}) // in spacings
  {
    const Estimated shape (torus, noise);
    EXPECT_NEAR (erkpa::positionNoise (*shape.search, shape.spacing, 0, shape.points) / shape.spacing, noise,
                 0.15 * noise + 0.005);
  }
}

/** \brief More neighbours would round edges, where these are not known. */
TEST (PointLayout, TakesMoreNeighborsAgainstNoiseWhereFacesAreFittedApart)
{
  int more = 0;
  for (const double noise : {0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3})
  {
    const Estimated box (shapes::box (4000, {1.0, 0.7, 0.5}), noise);
    const erkpa::PointLayout layout (box.points, 0);
    EXPECT_GE (layout.k_within_faces, layout.k);
    EXPECT_TRUE (noise > 0.0 || layout.k_within_faces == erkpa::CLEAN_SUPPORT);
    more += layout.k_within_faces > layout.k ? 1 : 0;
  }
  EXPECT_GT (more, 0);
}

/** \brief The other side of a wall thinner than the points are apart lies in the middle of every neighbourhood. */
TEST (PointLayout, TakesNoOtherSideOfAThinWallForNoise)
{
  const erkpa::PointLayout layout (*shapes::points (shapes::box (8000, {1.0, 0.7, 0.008})), 0);
  EXPECT_LE (layout.k, 2 * erkpa::CLEAN_SUPPORT); // as many on each side
  EXPECT_LE (layout.k_within_faces, 2 * erkpa::CLEAN_SUPPORT);
}
