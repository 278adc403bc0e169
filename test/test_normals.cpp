// SPDX-License-Identifier: BSD-3-Clause
#include "orientation_graph.h"
#include "shapes.h"
#include "sign_regions.h"
#include "spatial_order.h"

#include <erkpa/normals.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

using Eigen::Vector3d;
using erkpa::NormalOptions;
using erkpa::Orientation;
using erkpa::OrientedPoints;

namespace
{

/** \brief Estimates all normals of samples, whose own are not looked at. */
OrientedPoints
estimate (const shapes::Samples &samples, const NormalOptions &options, Orientation &orientation)
{
  OrientedPoints points;
  for (const Vector3d &p : samples.positions)
  {
    points.positions.emplace_back (p.cast<float> ());
    points.normals.emplace_back (Eigen::Vector3f::Zero ());
  }
  const erkpa::Outcome outcome = erkpa::estimateNormals (points, erkpa::PointLayout (points, 0), options, orientation);
  EXPECT_TRUE (outcome.ok ()) << outcome.message;
  return points;
}

double
shareThatAgrees (const OrientedPoints &points, const std::vector<Vector3d> &normals)
{
  int agree = 0;
  for (std::size_t i = 0; i < points.size (); ++i)
    agree += points.normals[i].cast<double> ().dot (normals[i]) > 0.0;
  return agree / static_cast<double> (points.size ());
}

/** \brief A cup: a cylinder of radius and height 1 with walls of a thickness, open at the top. */
shapes::Samples
cup (int count, double thickness)
{
  std::mt19937 random (11);
  std::uniform_real_distribution<double> unit (0.0, 1.0);
  const double inner = 1.0 - thickness;
  // outer wall, outer bottom, inner wall, inner bottom, rim
  std::discrete_distribution<int> face_of ({2.0, 1.0, 2.0 * inner * inner, inner * inner, 1.0 - inner * inner});
  shapes::Samples samples;
  for (int i = 0; i < count; ++i)
  {
    const int face = face_of (random);
    const double turn = 2.0 * M_PI * unit (random), share = unit (random);
    const Eigen::Vector3d out (std::cos (turn), std::sin (turn), 0.0), up = Eigen::Vector3d::UnitZ ();
    if (face == 0)
      samples.add (out + share * up, out);
    else if (face == 1)
      samples.add (std::sqrt (share) * out, -up);
    else if (face == 2)
      samples.add (inner * out + (thickness + share * inner) * up, -out);
    else if (face == 3)
      samples.add (inner * std::sqrt (share) * out + thickness * up, up);
    else
      samples.add (std::sqrt (inner * inner + share * (1.0 - inner * inner)) * out + up, up);
  }
  return samples;
}

/** \brief Samples that no other one within a distance has a different normal direction from: away from edges. */
std::vector<std::size_t>
awayFromEdges (const shapes::Samples &samples, double distance)
{
  std::vector<Eigen::Vector3f> positions;
  for (const Vector3d &p : samples.positions)
    positions.emplace_back (p.cast<float> ());
  const auto search = erkpa::makeKdTreeSearch (positions);
  std::vector<std::size_t> away;
  std::vector<int> indices;
  std::vector<float> squared;
  for (std::size_t i = 0; i < samples.size (); ++i)
  {
    search->withinRadius (positions[i], distance, indices, squared);
    if (std::all_of (indices.begin (), indices.end (),
                     [&] (int j) {
                       return std::abs (samples.normals[i].dot (samples.normals[static_cast<std::size_t> (j)])) > 0.7;
                     }))
      away.push_back (i);
  }
  return away;
}

/** \brief How many normals have the wrong sign, away from edges; there should be many that are. */
int
wrongAwayFromEdges (const OrientedPoints &points, const shapes::Samples &samples, double distance)
{
  const std::vector<std::size_t> away = awayFromEdges (samples, distance);
  EXPECT_GT (away.size (), samples.size () / 2);
  return static_cast<int> (std::count_if (
      away.begin (), away.end (),
      [&] (std::size_t i) { return points.normals[i].cast<double> ().dot (samples.normals[i]) <= 0.0; }));
}

NormalOptions
seenFrom (const Vector3d &view_point)
{
  NormalOptions options;
  options.has_view_point = true;
  options.view_point = view_point;
  return options;
}

} // namespace

TEST (Normals, PointOutwardsWhereNoViewPointIsKnown)
{
  Orientation orientation = Orientation::NONE;
  for (const shapes::Samples &shape : {shapes::sphere (3000, 1.0, {0.2, 5.0, 1.0}), shapes::torus (5000, 1.0, 0.4),
                                       shapes::box (6000, {1.0, 0.7, 0.5})})
  {
    const OrientedPoints points = estimate (shape, {}, orientation);
    EXPECT_EQ (orientation, Orientation::PROPAGATION);
    EXPECT_GT (shareThatAgrees (points, shape.normals), 0.999);
  }
}

TEST (Normals, FaceTheViewPointThatSawTheSurface)
{
  const shapes::Samples sheet = shapes::sheet (40, [] (double x, double) { return 0.2 * std::sin (3.0 * x); });
  Orientation orientation = Orientation::NONE;
  const OrientedPoints above = estimate (sheet, seenFrom ({0.0, 0.0, 5.0}), orientation);
  EXPECT_EQ (orientation, Orientation::VIEW_POINT);
  EXPECT_EQ (shareThatAgrees (above, sheet.normals), 1.0);
  const OrientedPoints below = estimate (sheet, seenFrom ({0.0, 0.0, -5.0}), orientation);
  EXPECT_EQ (shareThatAgrees (below, sheet.normals), 0.0);
}

TEST (Normals, FaceTheSensorInTheMiddleOfARoom)
{
  const shapes::Samples room = shapes::box (6000, {2.0, 3.0, 1.0});
  Orientation orientation = Orientation::NONE;
  const OrientedPoints points = estimate (room, seenFrom ({0.1, 0.2, 0.0}), orientation);
  EXPECT_EQ (orientation, Orientation::VIEW_POINT);
  EXPECT_LT (shareThatAgrees (points, room.normals), 0.001);
}

TEST (Normals, PointOutwardsWhereTheViewPointCannotHaveSeenTheSurface)
{
  const shapes::Samples sphere = shapes::sphere (4000);
  Orientation orientation = Orientation::NONE;
  const OrientedPoints points = estimate (sphere, seenFrom ({0.0, 0.0, 3.0}), orientation);
  EXPECT_EQ (orientation, Orientation::PROPAGATION);
  EXPECT_EQ (shareThatAgrees (points, sphere.normals), 1.0);
}

TEST (Normals, HoldTogetherAcrossTheLayersOfANoisyScan)
{
  shapes::Samples sphere = shapes::sphere (20000);
  std::mt19937 random (2);
  std::normal_distribution<double> noise (0.0, 0.01); // a third of the spacing
  for (Vector3d &p : sphere.positions)
    p *= 1.0 + noise (random);
  Orientation orientation = Orientation::NONE;
  EXPECT_GT (shareThatAgrees (estimate (sphere, {}, orientation), sphere.normals), 0.999);
}

TEST (Normals, AreRightOnBothSidesOfThinWalls)
{
  Orientation orientation = Orientation::NONE;
  constexpr double SPACING = 0.032; // of the cup
  for (const double thickness : {0.8 * SPACING, SPACING, 2.0 * SPACING})
  {
    const shapes::Samples walls = cup (18000, thickness);
    const OrientedPoints points = estimate (walls, {}, orientation);
    EXPECT_LE (wrongAwayFromEdges (points, walls, 2.0 * SPACING), 5) << thickness; // single points of 18000
    EXPECT_GT (shareThatAgrees (points, walls.normals), 0.99) << thickness;
  }
  const shapes::Samples plate = shapes::box (12000, {1.0, 1.0, 0.02}); // its rim is 1.5 spacings wide
  const OrientedPoints points = estimate (plate, {}, orientation);
  EXPECT_EQ (wrongAwayFromEdges (points, plate, 0.052), 0);
  EXPECT_GT (shareThatAgrees (points, plate.normals), 0.995);
}

TEST (Normals, PointIntoTheCavityOfAHollowBox)
{
  shapes::Samples hollow = shapes::box (8000, {1.0, 0.7, 0.5});
  const shapes::Samples cavity = shapes::box (3000, {0.6, 0.3, 0.25});
  for (std::size_t i = 0; i < cavity.size (); ++i)
    hollow.add (cavity.positions[i], -cavity.normals[i]);
  Orientation orientation = Orientation::NONE;
  EXPECT_GT (shareThatAgrees (estimate (hollow, {}, orientation), hollow.normals), 0.999);
}

TEST (Normals, DoNotDependOnTheNumberOfThreads)
{
  const shapes::Samples walls = cup (6000, 0.05);
  Orientation orientation = Orientation::NONE;
  NormalOptions options;
  options.threads = 1;
  const OrientedPoints one = estimate (walls, options, orientation);
  options.threads = 3;
  EXPECT_EQ (one.normals, estimate (walls, options, orientation).normals);
}

TEST (Normals, ThatWereGivenStayAndGiveTheOthersTheirSign)
{
  const shapes::Samples sphere = shapes::sphere (3000);
  OrientedPoints points;
  for (std::size_t i = 0; i < sphere.size (); ++i)
  {
    points.positions.emplace_back (sphere.positions[i].cast<float> ());
    const bool given = i % 10 == 0;
    points.normals.emplace_back (given ? Eigen::Vector3f (-sphere.normals[i].cast<float> ())
                                       : Eigen::Vector3f (Eigen::Vector3f::Zero ()));
  }
  const std::vector<Eigen::Vector3f> before = points.normals;
  Orientation orientation = Orientation::NONE;
  ASSERT_TRUE (erkpa::estimateNormals (points, erkpa::PointLayout (points, 0), {}, orientation).ok ());
  for (std::size_t i = 0; i < points.size (); i += 10)
    EXPECT_EQ (points.normals[i], before[i]);
  EXPECT_EQ (shareThatAgrees (points, sphere.normals), 0.0); // all inwards, as those that were given
}

TEST (Signs, FollowSureLinksButNotThoseThatOthersContradict)
{
  // A strip of nodes that are sure of each other, and one link, the surest, that says the contrary of all around it.
  constexpr int COUNT = 40;
  std::vector<erkpa::SignedLink> links;
  for (int i = 0; i < COUNT; ++i)
    for (int j = std::max (0, i - 3); j <= std::min (COUNT - 1, i + 3); ++j)
      if (i != j)
      {
        const float same = i % 2 == j % 2 ? 1.0f : -1.0f; // every other node is turned
        const bool is_wrong = std::min (i, j) == 20 && std::max (i, j) == 21;
        links.push_back ({i, j, is_wrong ? -0.95f * same : 0.7f * same});
      }
  const std::size_t between_neighbors = links.size ();
  links.push_back ({5, COUNT, 0.1f}); // the outside is no neighbour
  const std::vector<char> flips = erkpa::agreeOnSigns (COUNT + 1, links, between_neighbors, 2);
  for (int i = 1; i < COUNT; ++i)
    EXPECT_NE (flips[static_cast<std::size_t> (i)], flips[static_cast<std::size_t> (i) - 1]) << i;
  EXPECT_EQ (flips[5], flips[COUNT]);
}

TEST (Normals, OfLandSeenFromTheAirLookUpOnRoofsAsWellAsBetweenThem)
{
  const auto height = [] (double x, double y)
  {
    return 0.1 * std::sin (2.0 * x) +
           (std::abs (std::sin (5.0 * x)) > 0.7 && std::abs (std::cos (5.0 * y)) > 0.7 ? 0.3 : 0.0);
  };
  Orientation orientation = Orientation::NONE;
  const OrientedPoints points = estimate (shapes::sheet (100, height), {}, orientation);
  EXPECT_EQ (orientation, Orientation::ONE_SIDE);
  for (const Eigen::Vector3f &normal : points.normals)
    EXPECT_GE (normal.z (), 0.0f);
}

TEST (Normals, OfALidOverASheetLookDownBelowIt)
{
  shapes::Samples lid = shapes::box (9000, {0.8, 0.8, 0.1}), both = lid;
  for (Vector3d &p : both.positions)
    p += Vector3d (0.0, 0.0, 0.5);
  const shapes::Samples sheet = shapes::sheet (60, [] (double, double) { return 0.0; });
  for (std::size_t i = 0; i < sheet.size (); ++i)
    both.add (sheet.positions[i], sheet.normals[i]);
  Orientation orientation = Orientation::NONE;
  OrientedPoints points = estimate (both, {}, orientation);
  EXPECT_EQ (orientation, Orientation::PROPAGATION);
  points.positions.resize (lid.size ());
  points.normals.resize (lid.size ());
  EXPECT_GT (shareThatAgrees (points, lid.normals), 0.999);
}

TEST (Normals, OfLandAboveTheOriginLookUp)
{
  const shapes::Samples land = shapes::sheet (60, [] (double x, double y) { return 3.0 + 0.5 * x * x * y; });
  Orientation orientation = Orientation::NONE;
  EXPECT_EQ (shareThatAgrees (estimate (land, {}, orientation), land.normals), 1.0);
  EXPECT_EQ (orientation, Orientation::ONE_SIDE);
}

TEST (Normals, FaceASensorCloseAboveAFloorThatItSeesAtAGrazingAngle)
{
  for (const double height : {0.05, -0.05}) // below a ceiling, too
  {
    const shapes::Samples floor = shapes::sheet (80, [] (double, double) { return 0.0; });
    Orientation orientation = Orientation::NONE;
    const OrientedPoints points = estimate (floor, seenFrom ({0.0, -1.2, height}), orientation);
    EXPECT_EQ (shareThatAgrees (points, floor.normals), height > 0.0 ? 1.0 : 0.0) << height;
  }
}

TEST (Normals, OfWallsOfAHouseSeenFromAboveLookOutwards)
{
  shapes::Samples scene;
  const shapes::Samples house = shapes::box (4000, {0.3, 0.2, 0.25}),
                        land = shapes::sheet (100, [] (double, double) { return 0.0; });
  for (std::size_t i = 0; i < house.size (); ++i)
    if (house.normals[i].z () > -0.5)
      scene.add (house.positions[i] + Vector3d (0.0, 0.0, 0.25), house.normals[i]);
  const std::size_t of_house = scene.size ();
  for (std::size_t i = 0; i < land.size (); ++i)
    if (std::abs (land.positions[i].x ()) > 0.3 || std::abs (land.positions[i].y ()) > 0.2)
      scene.add (land.positions[i], land.normals[i]);
  Orientation orientation = Orientation::NONE;
  const OrientedPoints points = estimate (scene, {}, orientation);
  EXPECT_GT (of_house, 1000u);
  EXPECT_GT (shareThatAgrees (points, scene.normals), 0.995);
}

TEST (Normals, OfABallOverLandPointOutOfItBelowAsWell)
{
  shapes::Samples scene = shapes::sphere (2000, 0.3), ball = scene;
  for (Vector3d &p : scene.positions)
    p += Vector3d (0.0, 0.0, 0.6);
  const shapes::Samples land = shapes::sheet (130, [] (double, double) { return 0.0; });
  for (std::size_t i = 0; i < land.size (); ++i)
    scene.add (land.positions[i], land.normals[i]);
  Orientation orientation = Orientation::NONE;
  OrientedPoints points = estimate (scene, {}, orientation);
  points.positions.resize (ball.size ());
  points.normals.resize (ball.size ());
  EXPECT_EQ (shareThatAgrees (points, ball.normals), 1.0);
}

TEST (Normals, OfFewPointsOfAClosedSurfacePointOutwards)
{
  for (const int count : {40, 80, 150})
  {
    const shapes::Samples sphere = shapes::sphere (count);
    Orientation orientation = Orientation::NONE;
    EXPECT_EQ (shareThatAgrees (estimate (sphere, {}, orientation), sphere.normals), 1.0) << count;
    EXPECT_EQ (orientation, Orientation::PROPAGATION);
  }
}

TEST (Normals, AreIndifferentToAViewPointThatIsFartherThanFloatsCanTell)
{
  const shapes::Samples sphere = shapes::sphere (2000);
  Orientation orientation = Orientation::NONE;
  for (const double far : {1e8, 1e20, 1e300})
    EXPECT_EQ (shareThatAgrees (estimate (sphere, seenFrom ({far, 1.0, 1.0}), orientation), sphere.normals), 1.0)
        << far;
}

TEST (Normals, OfTheOuterSideOfHalfASphereLookOutwards)
{
  shapes::Samples half;
  const shapes::Samples sphere = shapes::sphere (6000);
  for (std::size_t i = 0; i < sphere.size (); ++i)
    if (sphere.positions[i].x () < -0.3)
      half.add (sphere.positions[i], sphere.normals[i]);
  Orientation orientation = Orientation::NONE;
  EXPECT_EQ (shareThatAgrees (estimate (half, {}, orientation), half.normals), 1.0);
}

TEST (Normals, OfAScanAreTurnedLikeThoseThatWereGiven)
{
  const shapes::Samples sheet = shapes::sheet (40, [] (double x, double) { return 0.2 * std::sin (3.0 * x); });
  OrientedPoints points;
  for (std::size_t i = 0; i < sheet.size (); ++i)
  {
    points.positions.emplace_back (sheet.positions[i].cast<float> ());
    points.normals.emplace_back (i % 3 == 0 ? Eigen::Vector3f (-sheet.normals[i].cast<float> ())
                                            : Eigen::Vector3f (Eigen::Vector3f::Zero ()));
  }
  Orientation orientation = Orientation::NONE;
  EXPECT_TRUE (erkpa::estimateNormals (points, erkpa::PointLayout (points, 0), {}, orientation).ok ());
  EXPECT_EQ (shareThatAgrees (points, sheet.normals), 0.0);
}

/** \brief A square grid whose nodes all have the same sign, as links say in one direction only, but for a wrong one. */
std::vector<erkpa::SignedLink>
linksOfGrid (int side)
{
  std::vector<erkpa::SignedLink> links;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
    {
      const int node = side * y + x;
      if (x + 1 < side)
        links.push_back ({node, node + 1, x == 9 && y == 12 ? -0.9f : 0.6f});
      if (y + 1 < side)
        links.push_back ({node, node + side, 0.6f});
    }
  return links;
}

TEST (SignRegions, AreTurnedWhereMostLinksAroundThemSpeakAgainstTheirSigns)
{
  constexpr int SIDE = 30;
  const std::vector<erkpa::SignedLink> links = linksOfGrid (SIDE);
  std::vector<char> flips (SIDE * SIDE + 1, 0);
  for (int y = 10; y < 15; ++y)
    for (int x = 10; x < 14; ++x)
      flips[static_cast<std::size_t> (SIDE * y + x)] = 1;
  erkpa::turnRegions (links, flips);
  EXPECT_EQ (std::count (flips.begin (), flips.end (), 1), 0);
  erkpa::turnRegions (links, flips);
  EXPECT_EQ (std::count (flips.begin (), flips.end (), 1), 0) << "what is right stays";
}

TEST (SignRegions, OnlyRaiseTheAgreementOfAllLinksWhereMuchIsContradictory)
{
  constexpr int SIDE = 60;
  std::mt19937 random (5);
  std::uniform_real_distribution<float> unit (0.0f, 1.0f);
  std::vector<erkpa::SignedLink> links = linksOfGrid (SIDE);
  for (erkpa::SignedLink &link : links)
    link.weight *= unit (random) < 0.3f ? -unit (random) : 1.0f;
  std::vector<char> flips (SIDE * SIDE + 1, 0);
  for (char &flip : flips)
    flip = unit (random) < 0.2f ? 1 : 0;
  const auto agreement = [&]
  {
    double sum = 0.0;
    for (const erkpa::SignedLink &link : links)
      sum += flips[static_cast<std::size_t> (link.from)] == flips[static_cast<std::size_t> (link.to)] ? link.weight
                                                                                                      : -link.weight;
    return sum;
  };
  for (double before = agreement (), call = 0; call < 3; before = agreement (), ++call)
  {
    erkpa::turnRegions (links, flips);
    EXPECT_GE (agreement (), before);
  }
}

TEST (SpatialOrder, TakesAllThatAPointHasAlong)
{
  OrientedPoints points;
  points.channels = 3;
  for (int i = 0; i < 4; ++i)
  {
    const auto v = static_cast<float> (i);
    points.positions.emplace_back (v, 0.0f, 0.0f);
    points.normals.emplace_back (0.0f, v, 0.0f);
    points.confidences.push_back (v);
    points.attributes.insert (points.attributes.end (), {v, v + 10.0f, v + 20.0f});
  }
  const std::array<std::uint32_t, 4> order{2, 0, 3, 1};
  erkpa::reorder (order.data (), points);
  for (std::size_t i = 0; i < order.size (); ++i)
  {
    const auto v = static_cast<float> (order[i]);
    EXPECT_EQ (points.positions[i].x (), v);
    EXPECT_EQ (points.normals[i].y (), v);
    EXPECT_EQ (points.confidences[i], v);
    EXPECT_EQ (points.attributes[3 * i + 2], v + 20.0f);
  }
  EXPECT_TRUE (points.radii.empty ());
}
