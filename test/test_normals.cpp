// SPDX-License-Identifier: BSD-3-Clause
#include "shapes.h"

#include <erkpa/normals.h>

#include <gtest/gtest.h>

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
  const auto search = erkpa::makeKdTreeSearch (points.positions);
  const erkpa::Outcome outcome = erkpa::estimateNormals (points, *search, options, orientation);
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
  ASSERT_TRUE (erkpa::estimateNormals (points, *erkpa::makeKdTreeSearch (points.positions), {}, orientation).ok ());
  for (std::size_t i = 0; i < points.size (); i += 10)
    EXPECT_EQ (points.normals[i], before[i]);
  EXPECT_EQ (shareThatAgrees (points, sphere.normals), 0.0); // all inwards, as those that were given
}
