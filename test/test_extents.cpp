// SPDX-License-Identifier: BSD-3-Clause
//
// Sharp surfaces that are in force in a region only, and smooth data that a sharp surface crosses.
#include "field_tests.h"

#include <erkpa/extent.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

using erkpa::Constraint;
using erkpa::EnrichmentType;
using erkpa::Extent;
using erkpa::SharpSurface;
using erkpa::Status;

namespace
{

Extent::ConstPtr
boxExtent (const Vector3d &low, const Vector3d &high)
{
  Extent::ConstPtr extent;
  EXPECT_TRUE (erkpa::makeBoxExtent (low, high, extent).ok ());
  return extent;
}

Extent::ConstPtr
polygonExtent (const std::vector<Vector3d> &vertices, double thickness)
{
  Extent::ConstPtr extent;
  EXPECT_TRUE (erkpa::makePolygonExtent (vertices, thickness, extent).ok ());
  return extent;
}

Extent::ConstPtr
pointsExtent (const std::vector<Vector3d> &points, double radius)
{
  Extent::ConstPtr extent;
  EXPECT_TRUE (erkpa::makePointsExtent (points, radius, extent).ok ());
  return extent;
}

/** \brief An L in a tilted plane. */
std::vector<Vector3d>
ell ()
{
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd (0.7, Vector3d (1.0, -2.0, 0.5).normalized ()).matrix ();
  std::vector<Vector3d> vertices;
  for (const auto &[x, y] : {std::pair (0.0, 0.0), {1.0, 0.0}, {1.0, 0.3}, {0.3, 0.3}, {0.3, 1.0}, {0.0, 1.0}})
    vertices.emplace_back (tilt * Vector3d (x, y, 0.2));
  return vertices;
}

std::vector<Extent::ConstPtr>
extentsOfAllKinds ()
{
  return {boxExtent ({-0.5, -0.2, 0.0}, {0.3, 0.2, 0.4}), polygonExtent (ell (), 0.0), polygonExtent (ell (), 0.1),
          pointsExtent ({{0.0, 0.0, 0.0}, {0.4, 0.1, 0.0}, {0.6, 0.5, 0.2}}, 0.15)};
}

const Vector3d HALF (1.0, 0.7, 0.5);

/** \brief The box's bisectors, each limited to what \a extent_of its edge says. */
template <typename ExtentOfT>
FieldOptions
withLimitedBisectors (FieldOptions options, ExtentOfT extent_of, double fade)
{
  for (const Eigen::Vector4d &bisector : shapes::boxBisectors (HALF))
    options.sharp_surfaces.push_back (erkpa::makeLimited (shapes::plane (bisector), extent_of (bisector), fade));
  return options;
}

/** \brief Points along the edge of the box that a bisector halves. */
std::vector<Vector3d>
edgeOf (const Eigen::Vector4d &bisector)
{
  std::vector<Vector3d> points;
  for (const Vector3d &p : shapes::boxEdgePoints (HALF, 40))
  {
    int own = 0;
    for (int axis = 0; axis < 3; ++axis)
      own += std::abs (bisector[axis]) > 0.1 && std::abs (std::abs (p[axis]) - HALF[axis]) < 1e-9;
    // not the opposite edge, which such a plane may touch at its corners only
    if (own == 2 && std::abs (bisector.head<3> ().dot (p) + bisector[3]) < 1e-9)
      points.push_back (p);
  }
  return points;
}

double
slopeMismatch (const ImplicitField &field, const Vector3d &x, int &compared)
{
  const Function f = [&] (const Vector3d &p) { return field.value (p); };
  const Vector3d fine = differences (f, x, 1e-7), coarse = differences (f, x, 2e-7);
  if (!((fine - coarse).norm () < 1e-4)) // the k-th node changes, or x lies on a sharp surface
    return 0.0;
  ++compared;
  return (field.sample (x).gradient - fine).norm () / (1.0 + fine.norm ());
}

} // namespace

class Extents : public FieldTest
{
};

TEST_F (Extents, DistanceIsThatToTheRegion)
{
  const auto box = boxExtent ({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
  EXPECT_EQ (box->distance ({0.9, -0.9, 0.2}), 0.0);
  EXPECT_NEAR (box->distance ({4.0, 5.0, 0.0}), 5.0, 1e-12);
  const std::vector<Vector3d> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_EQ (polygonExtent (square, 0.0)->distance ({0.5, 0.5, 99.0}), 0.0);
  EXPECT_NEAR (polygonExtent (square, 0.0)->distance ({1.5, 0.5, 99.0}), 0.5, 1e-12);
  EXPECT_NEAR (polygonExtent (square, 2.0)->distance ({4.0, 0.5, -6.0}), 5.0, 1e-12);
  const auto points = pointsExtent ({{0, 0, 0}, {2, 0, 0}}, 0.5);
  EXPECT_EQ (points->distance ({1.6, 0.0, 0.0}), 0.0);
  EXPECT_NEAR (points->distance ({2.0, 3.0, 0.0}), 2.5, 1e-6);
}

TEST_F (Extents, DistanceGrowsByAtMostOneInOneWithTheGradientOfDifferences)
{
  for (const Extent::ConstPtr &extent : extentsOfAllKinds ())
    for (int i = 0; i < 300; ++i)
    {
      const Vector3d x = randomPoint (1.5), y = x + randomPoint (0.2);
      EXPECT_LE (std::abs (extent->distance (x) - extent->distance (y)), (x - y).norm () + 1e-6);
      Vector3d gradient;
      const double distance = extent->distance (x, &gradient);
      const Vector3d other = differences ([&] (const Vector3d &p) { return extent->distance (p); }, x, 1e-5);
      EXPECT_LT ((gradient - other).norm (), 2e-2);
      EXPECT_EQ (distance == 0.0, gradient.norm () == 0.0);
      EXPECT_GE (distance + 1e-6, extent->bounds ().exteriorDistance (x)) << "the bounds hold the region";
    }
}

TEST_F (Extents, ThatMakeNoRegionAreRefusedWithTheirReason)
{
  Extent::ConstPtr extent;
  const auto refused = [&] (const erkpa::Outcome &outcome)
  { return outcome.status == Status::INVALID_SETTING && !outcome.message.empty () && extent == nullptr; };
  const double nan = std::nan ("");
  EXPECT_TRUE (refused (erkpa::makeBoxExtent ({0, 0, 1}, {1, 1, 0}, extent)));
  EXPECT_TRUE (refused (erkpa::makeBoxExtent ({nan, 0, 0}, {1, 1, 1}, extent)));
  EXPECT_TRUE (refused (erkpa::makePolygonExtent ({{0, 0, 0}, {1, 0, 0}}, 0.0, extent)));
  EXPECT_TRUE (refused (erkpa::makePolygonExtent ({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 0.0, extent)));
  EXPECT_TRUE (refused (erkpa::makePolygonExtent ({{0, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 1, 1}}, 0.0, extent)));
  EXPECT_TRUE (refused (erkpa::makePolygonExtent ({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 1, 0}}, 0.0, extent)));
  EXPECT_TRUE (refused (erkpa::makePolygonExtent (ell (), -1.0, extent)));
  EXPECT_TRUE (refused (erkpa::makePointsExtent ({}, 1.0, extent)));
  EXPECT_TRUE (refused (erkpa::makePointsExtent ({{0, 0, 0}}, 0.0, extent)));
  EXPECT_TRUE (refused (erkpa::makePointsExtent ({{0, nan, 0}}, 1.0, extent)));
}

TEST_F (Extents, PresenceFadesFromOneToZeroOverTheFade)
{
  const SharpSurface::ConstPtr plane = shapes::plane ({1.0, 0.0, 0.0, 0.0});
  const auto box = boxExtent ({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
  EXPECT_EQ (plane->presence ({9.0, 9.0, 9.0}, 0.1), 1.0);
  for (const auto &[fade, radius] : {std::pair (0.5, 0.3), {0.0, 0.6}})
  {
    const double start = fade > 0.0 ? 1.0 : 1.0 + 0.5 * radius, end = fade > 0.0 ? 1.0 + fade : 1.0 + radius;
    const auto limited = erkpa::makeLimited (plane, box, fade);
    EXPECT_EQ (limited->presence ({start - 1e-9, 0.0, 0.0}, radius), 1.0);
    EXPECT_NEAR (limited->presence ({0.5 * (start + end), 0.0, 0.0}, radius), 0.5, 1e-12);
    EXPECT_EQ (limited->presence ({end + 1e-9, 0.0, 0.0}, radius), 0.0);
    EXPECT_EQ (limited->theta ({0.3, 2.0, 0.0}), 0.3);
  }
  EXPECT_EQ (erkpa::makeLimited (nullptr, box), nullptr);
  EXPECT_EQ (erkpa::makeLimited (plane, nullptr), nullptr);
  EXPECT_EQ (erkpa::makeLimited (plane, box, -1.0), nullptr);
}

TEST_F (Extents, SlopeOfThePresenceAgreesWithDifferences)
{
  const auto turn = erkpa::makeSpaceWarp ([] (const Vector3d &x) { return Vector3d (x.y (), 2.0 * x.x (), x.z ()); },
                                          [] (const Vector3d &)
                                          {
                                            Eigen::Matrix3d jacobian;
                                            jacobian << 0, 1, 0, 2, 0, 0, 0, 0, 1;
                                            return jacobian;
                                          });
  const SharpSurface::ConstPtr plane = shapes::plane ({1.0, 0.0, 0.0, 0.0});
  for (const double fade : {0.0, 0.4})
    for (const Extent::ConstPtr &extent : extentsOfAllKinds ())
    {
      const auto limited = erkpa::makeLimited (plane, extent, fade);
      const auto twice = erkpa::makeLimited (limited, boxExtent ({-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}), 0.7);
      for (const SharpSurface::ConstPtr &surface : {limited, twice, erkpa::makeWarpedSharpSurface (limited, turn)})
        for (int i = 0; i < 30; ++i)
        {
          const Vector3d x = randomPoint (1.0);
          erkpa::PresenceSlope slope;
          EXPECT_EQ (surface->presence (x, 0.6, &slope), surface->presence (x, 0.6));
          const Function presence = [&] (const Vector3d &p) { return surface->presence (p, 0.6); };
          EXPECT_LT ((slope.by_position - differences (presence, x, 1e-4)).norm (), 1e-2);
          const double by_radius = (surface->presence (x, 0.6001) - surface->presence (x, 0.5999)) / 2e-4;
          EXPECT_NEAR (slope.by_radius, by_radius, 1e-2);
        }
    }
}

TEST_F (Extents, PlanesAndFacesAreSeenBehindLimits)
{
  const SharpSurface::ConstPtr a = shapes::plane ({1.0, 0.0, 0.0, 0.0}), b = shapes::plane ({0.0, 1.0, 0.0, 0.0});
  SharpSurface::ConstPtr sphere, face, other;
  ASSERT_TRUE (erkpa::makeSharpSurface (erkpa::SurfaceModel::SPHERE, {0, 0, 0, 1}, sphere).ok ());
  const auto box = boxExtent ({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
  const auto between = erkpa::makeSharpBetween (a, b), rim = erkpa::makeSharpBetween (a, sphere);
  EXPECT_EQ (erkpa::planeBehind (*erkpa::makeLimited (a, box)), a.get ());
  EXPECT_EQ (erkpa::planeBehind (*erkpa::makeLimited (between, box)), between.get ());
  EXPECT_EQ (erkpa::planeBehind (*erkpa::makeLimited (rim, box)), nullptr);
  Extent::ConstPtr extent = box;
  ASSERT_TRUE (erkpa::facesBehind (*between, face, other, extent));
  EXPECT_EQ (face, a);
  EXPECT_EQ (other, b);
  EXPECT_EQ (extent, nullptr);
  ASSERT_TRUE (erkpa::facesBehind (*erkpa::makeLimited (rim, box), face, other, extent));
  EXPECT_EQ (other, sphere);
  EXPECT_EQ (extent, box);
  EXPECT_FALSE (erkpa::facesBehind (*erkpa::makeLimited (a, box), face, other, extent));
}

TEST_F (Extents, KeepAnEdgeSharpInsideAndLeaveTheFieldAsItIsOutside)
{
  // Half of each edge is in force.
  const shapes::Samples box = shapes::box (20000, HALF);
  const FieldOptions plain = optionsOf (Order::SPHERICAL, 20);
  const auto half_space = boxExtent ({-9.0, -9.0, 0.0}, {9.0, 9.0, 9.0});
  const auto extent_of = [&] (const Eigen::Vector4d &) { return half_space; };
  const auto limited = shapes::field (box, withLimitedBisectors (plain, extent_of, 0.0));
  const auto round = shapes::field (box, plain);
  double largest_round = 0.0;
  for (const Vector3d &p : shapes::boxEdgePoints (HALF, 40))
    if (p.z () >= 0.0)
      EXPECT_NEAR (limited->value (p), 0.0, 1e-6);
    else if (p.z () < -0.15) // more than a support radius
    {
      EXPECT_EQ (limited->value (p), round->value (p));
      largest_round = std::max (largest_round, std::abs (round->value (p)));
    }
  EXPECT_GT (largest_round, 5e-3);
}

TEST_F (Extents, AlongTheEdgesOfABoxMakeItsCornersSharp)
{
  const auto extent_of = [] (const Eigen::Vector4d &bisector) { return pointsExtent (edgeOf (bisector), 0.05); };
  const FieldOptions options = withLimitedBisectors (optionsOf (Order::SPHERICAL, 20), extent_of, 0.0);
  const auto field = shapes::field (shapes::box (20000, HALF), options);
  for (const Vector3d &p : shapes::boxEdgePoints (HALF, 40))
    EXPECT_NEAR (field->value (p), 0.0, 1e-6);
}

TEST_F (Extents, FadeOutWithoutAJump)
{
  const shapes::Samples box = shapes::box (20000, HALF);
  const auto extent_of = [] (const Eigen::Vector4d &) { return boxExtent ({-9.0, -9.0, 0.0}, {9.0, 9.0, 9.0}); };
  for (const Constraint constraint : {Constraint::HERMITE, Constraint::FUNCTIONAL, Constraint::OFFSURFACE})
    for (const double fade : {0.0, 0.1})
    {
      FieldOptions options = optionsOf (Order::AUTOMATIC, 0, 0.15);
      options.constraint = constraint;
      const auto field = shapes::field (box, withLimitedBisectors (options, extent_of, fade));
      const Vector3d start (HALF.x () + 0.002, HALF.y () - 0.004, 0.05), step (0.0, 0.0, -1e-4);
      double last = field->value (start), largest = 0.0;
      for (int i = 1; i < 2500; ++i)
      {
        const double value = field->value (start + i * step);
        largest = std::max (largest, std::abs (value - last));
        last = value;
      }
      EXPECT_LT (largest, 1e-4) << "constraint " << static_cast<int> (constraint) << " fade " << fade;
    }
}

TEST_F (Extents, FadeOutWithoutAJumpAtCorners)
{
  // Across the bisectors of a corner, where they fade, from one side to the other.
  const auto extent_of = [] (const Eigen::Vector4d &) { return boxExtent ({-9.0, -9.0, -9.0}, {9.0, 9.0, 0.45}); };
  const FieldOptions options = withLimitedBisectors (optionsOf (Order::SPHERICAL, 0, 0.15), extent_of, 0.1);
  const auto field = shapes::field (shapes::box (20000, HALF), options);
  for (const Eigen::Vector4d &bisector : shapes::boxBisectors (HALF))
  {
    const Vector3d n = bisector.head<3> ();
    if (std::abs (n.dot (HALF) + bisector[3]) > 1e-9)
      continue; // of another corner
    for (int i = 0; i < 20; ++i)
    {
      const Vector3d near = HALF + randomPoint (0.03), x = near - (n.dot (near) + bisector[3]) * n;
      EXPECT_NEAR (field->value (x + 1e-9 * n), field->value (x - 1e-9 * n), 1e-7);
    }
  }
}

TEST_F (Extents, GradientAgreesWithDifferencesWhereSurfacesFade)
{
  const shapes::Samples box = shapes::box (4000, HALF);
  const auto extent_of = [] (const Eigen::Vector4d &) { return boxExtent ({-9.0, -9.0, 0.0}, {9.0, 9.0, 0.3}); };
  const auto along_edges = [] (const Eigen::Vector4d &bisector) { return pointsExtent (edgeOf (bisector), 0.01); };
  for (const Constraint constraint : {Constraint::HERMITE, Constraint::FUNCTIONAL, Constraint::OFFSURFACE})
    for (const Order order : {Order::CONSTANT, Order::LINEAR, Order::SPHERICAL, Order::QUADRATIC})
      for (const int k : {0, 20})
        for (const EnrichmentType enrichment : {EnrichmentType::KINK, EnrichmentType::JUMP})
          for (const double fade : {0.0, 0.2})
          {
            if (enrichment == EnrichmentType::JUMP && constraint != Constraint::FUNCTIONAL)
              continue;
            FieldOptions options = optionsOf (order, k, k > 0 ? 0.0 : 0.25);
            options.constraint = constraint;
            options.enrichment = enrichment;
            const auto field = shapes::field (box, fade > 0.0 ? withLimitedBisectors (options, extent_of, fade)
                                                              : withLimitedBisectors (options, along_edges, 0.0));
            int compared = 0;
            for (std::size_t i = 0; i < 25; ++i)
            {
              const Vector3d x = box.positions[97 * i] + randomPoint (0.02);
              EXPECT_LT (slopeMismatch (*field, x, compared), 1e-3)
                  << "constraint " << static_cast<int> (constraint) << " order " << static_cast<int> (order) << " k "
                  << k << " fade " << fade << " jump " << (enrichment == EnrichmentType::JUMP) << " at "
                  << x.transpose ();
            }
            EXPECT_GT (compared, 15);
          }
}

TEST_F (Extents, GiveTheSameFieldOneByOneAndInBatches)
{
  const auto extent_of = [] (const Eigen::Vector4d &bisector) { return pointsExtent (edgeOf (bisector), 0.01); };
  const shapes::Samples box = shapes::box (3000, HALF);
  for (const double fade : {0.0, 0.05})
    for (const FieldOptions &options : {optionsOf (Order::SPHERICAL, 20), optionsOf (Order::SPHERICAL, 0, 0.2)})
    {
      const auto field = shapes::field (box, withLimitedBisectors (options, extent_of, fade));
      std::vector<Vector3d> points;
      for (std::size_t i = 0; i < 300; ++i)
        points.push_back (box.positions[i] + randomPoint (0.1));
      std::vector<erkpa::FieldSample> samples;
      field->evaluate (points, samples);
      for (std::size_t i = 0; i < points.size (); ++i)
      {
        EXPECT_EQ (samples[i].value, field->value (points[i]));
        EXPECT_EQ (samples[i].gradient, field->sample (points[i]).gradient);
      }
    }
}

class SmoothData : public FieldTest
{
};

TEST_F (SmoothData, KeepsNoCreaseWhereASharpPlaneCrossesIt)
{
  shapes::Samples ellipsoid;
  const Vector3d axes (1.0, 0.6, 0.4);
  const shapes::Samples sphere = shapes::sphere (5000);
  for (std::size_t i = 0; i < sphere.size (); ++i)
    ellipsoid.add (sphere.positions[i].cwiseProduct (axes), sphere.normals[i].cwiseQuotient (axes).normalized ());
  for (const shapes::Samples &samples : {sphere, ellipsoid})
    for (const Vector3d &tilted : {Vector3d (1.0, 0.1, 0.2), Vector3d (0.2, 0.1, 1.0)})
      for (const FieldOptions &plain : {optionsOf (Order::AUTOMATIC, 20), optionsOf (Order::AUTOMATIC, 0, 0.2)})
      {
        FieldOptions options = plain;
        const Vector3d n = tilted.normalized ();
        options.sharp_surfaces.push_back (shapes::plane ({n[0], n[1], n[2], 0.0}));
        const auto field = shapes::field (samples, options);
        double sum = 0.0;
        int count = 0;
        for (const Vector3d &p : samples.positions)
          if (std::abs (n.dot (p)) < 0.02)
          {
            const Vector3d x = p - n.dot (p) * n;
            const Vector3d a = field->sample (x + 1e-6 * n).gradient, b = field->sample (x - 1e-6 * n).gradient;
            sum += std::atan2 (a.cross (b).norm (), a.dot (b)) * 180.0 / M_PI;
            ++count;
          }
        EXPECT_LT (sum / count, 1.0) << "degrees"; // without θ² about 3 by neighbours, and 10 by radius
      }
}
