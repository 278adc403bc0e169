// SPDX-License-Identifier: BSD-3-Clause
//
// Which faces of a segmentation meet in sharp edges, and the edges they make.
#include "field_tests.h"

#include <erkpa/sharp_edges_from_faces.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

using erkpa::FaceModel;
using erkpa::SharpSurface;
using erkpa::Status;
using erkpa::SurfaceModel;
using Surfaces = std::vector<SharpSurface::ConstPtr>;

namespace
{

const Vector3d HALF (1.0, 0.7, 0.5);

/** \brief The six planes of the box, of any scale and side, as PCL's segmentation gives them. */
std::vector<FaceModel>
boxFaces ()
{
  std::vector<FaceModel> faces;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f})
    {
      std::vector<float> plane (4, 0.0f);
      plane[static_cast<std::size_t> (axis)] = axis == 1 ? -2.0f : 1.0f;
      plane[3] = -side * plane[static_cast<std::size_t> (axis)] * static_cast<float> (HALF[axis]);
      faces.push_back ({SurfaceModel::PLANE, plane});
    }
  return faces;
}

/** \brief A tin with lid and bottom, or the hole of that shape: radius 0.5, z from -0.5 to 0.5. */
shapes::Samples
tin (int count, double outside)
{
  shapes::Samples samples;
  std::uniform_real_distribution<double> unit (0.0, 1.0);
  for (int i = 0; i < count; ++i)
  {
    const double turn = 2.0 * M_PI * unit (random_engine), z = i % 2 == 0 ? 0.5 : -0.5;
    const Vector3d out (std::cos (turn), std::sin (turn), 0.0), up = Vector3d::UnitZ ();
    if (i % 3 == 0)
      samples.add (0.5 * std::sqrt (unit (random_engine)) * out + z * up, outside * 2.0 * z * up);
    else
      samples.add (0.5 * out + (unit (random_engine) - 0.5) * up, outside * out);
  }
  return samples;
}

std::vector<FaceModel>
tinFaces ()
{
  return {{SurfaceModel::CYLINDER, {0.0f, 0.0f, 3.0f, 0.0f, 0.0f, 1.0f, 0.5f}},
          {SurfaceModel::PLANE, {0.0f, 0.0f, 1.0f, -0.5f}},
          {SurfaceModel::PLANE, {0.0f, 0.0f, 1.0f, 0.5f}}};
}

Surfaces
edgesOf (const shapes::Samples &samples, const std::vector<FaceModel> &faces, double tolerance = 0.0)
{
  Surfaces surfaces;
  const erkpa::Outcome outcome = erkpa::sharpEdgesFromFaces (*shapes::points (samples), faces, tolerance, surfaces);
  EXPECT_TRUE (outcome.ok ()) << outcome.message;
  return surfaces;
}

/** \brief The largest |f| at some points of a field with those edges. */
double
largestValue (const shapes::Samples &samples, const Surfaces &edges, const std::vector<Vector3d> &points)
{
  FieldOptions options;
  options.sharp_surfaces = edges;
  const auto field = shapes::field (samples, options);
  double largest = 0.0;
  for (const Vector3d &p : points)
    largest = std::max (largest, std::abs (field->value (p)));
  return largest;
}

std::vector<Vector3d>
rimPoints ()
{
  std::vector<Vector3d> points;
  for (double turn = 0.0; turn < 2.0 * M_PI; turn += 0.1)
    for (const double z : {-0.5, 0.5})
      points.emplace_back (0.5 * std::cos (turn), 0.5 * std::sin (turn), z);
  return points;
}

} // namespace

class SharpEdgesFromFaces : public FieldTest
{
};

TEST_F (SharpEdgesFromFaces, SixPlanesOfABoxGiveItsTwelveEdgesAndNoOthers)
{
  const shapes::Samples box = shapes::box (20000, HALF);
  const Surfaces edges = edgesOf (box, boxFaces (), 0.01);
  EXPECT_EQ (edges.size (), 12u);
  const std::vector<Vector3d> on_edges = shapes::boxEdgePoints (HALF, 40);
  for (const SharpSurface::ConstPtr &edge : edges)
  {
    int own = 0;
    for (const Vector3d &p : on_edges)
      own += std::abs (edge->theta (p)) < 1e-6 && edge->presence (p, 0.01) > 0.5;
    EXPECT_GE (own, 41);
    EXPECT_LT (own, 60) << "its own edge, and the ends of others";
    SharpSurface::ConstPtr face, other;
    erkpa::Extent::ConstPtr extent;
    ASSERT_TRUE (erkpa::facesBehind (*edge, face, other, extent));
    EXPECT_LT (face->theta (Vector3d::Zero ()), 0.0) << "turned outside";
    EXPECT_LT (other->theta (Vector3d::Zero ()), 0.0);
    EXPECT_NE (extent, nullptr);
  }
  EXPECT_LT (largestValue (box, edges, on_edges), 1e-6);
}

TEST_F (SharpEdgesFromFaces, ParallelFacesAndFacesThatAreFarFromEachOtherGiveNone)
{
  const std::vector<FaceModel> faces = boxFaces ();
  EXPECT_TRUE (edgesOf (shapes::box (5000, HALF), {faces[0], faces[1]}).empty ());
  EXPECT_TRUE (edgesOf (shapes::box (5000, HALF), {faces[0], faces[0]}).empty ());
  EXPECT_TRUE (edgesOf (shapes::box (5000, HALF), {}).empty ());
  // Only the middles of the faces are seen.
  shapes::Samples middles;
  const shapes::Samples box = shapes::box (20000, HALF);
  for (std::size_t i = 0; i < box.size (); ++i)
    if ((box.positions[i].cwiseQuotient (HALF).cwiseAbs ().array () > 0.85).count () == 1)
      middles.add (box.positions[i], box.normals[i]);
  EXPECT_TRUE (edgesOf (middles, faces).empty ());
}

TEST_F (SharpEdgesFromFaces, ATinAndAHoleGiveTheirTwoRims)
{
  for (const double outside : {1.0, -1.0})
  {
    const shapes::Samples samples = tin (15000, outside);
    const Surfaces edges = edgesOf (samples, tinFaces ());
    EXPECT_EQ (edges.size (), 2u);
    const double round = largestValue (samples, {}, rimPoints ());
    EXPECT_LT (largestValue (samples, edges, rimPoints ()), 0.1 * round) << "outside " << outside;
  }
}

TEST_F (SharpEdgesFromFaces, AreFoundInNoisyDataAndFarFromTheOrigin)
{
  shapes::Samples box = shapes::box (20000, HALF);
  std::normal_distribution<double> noise (0.0, 0.003); // a sixth of the spacing
  for (std::size_t i = 0; i < box.size (); ++i)
  {
    box.positions[i] += noise (random_engine) * box.normals[i];
    box.normals[i] =
        (box.normals[i] + 50.0 * Vector3d (noise (random_engine), noise (random_engine), 0.0)).normalized ();
  }
  EXPECT_EQ (edgesOf (box, boxFaces (), 0.01).size (), 12u);
  const auto points = shapes::points (box);
  points->origin = {3e5, 5e6, 100.0};
  std::vector<FaceModel> faces = boxFaces ();
  for (FaceModel &face : faces) // as floats can have it: multiples of 1/2 at most
    for (std::size_t axis = 0; axis < 3; ++axis)
      face.coefficients[3] -= face.coefficients[axis] * static_cast<float> (points->origin[static_cast<int> (axis)]);
  Surfaces surfaces;
  ASSERT_TRUE (erkpa::sharpEdgesFromFaces (*points, {faces[0], faces[4], faces[5]}, 0.05, surfaces).ok ());
  EXPECT_EQ (surfaces.size (), 2u);
}

TEST_F (SharpEdgesFromFaces, AChamferKeepsTheFacesItCutsApart)
{
  // z = 0 for x < -w, the chamfer down to x = 0, then x = 0: w is about three spacings.
  const double w = 0.06;
  shapes::Samples samples;
  std::uniform_real_distribution<double> unit (0.0, 1.0);
  for (int i = 0; i < 12000; ++i)
  {
    const double a = unit (random_engine), y = unit (random_engine), part = unit (random_engine);
    if (part < 0.05)
      samples.add ({-w * a, y, -w * (1.0 - a)}, Vector3d (1.0, 0.0, 1.0).normalized ());
    else if (i % 2 == 0)
      samples.add ({-w - a, y, 0.0}, Vector3d::UnitZ ());
    else
      samples.add ({0.0, y, -w - a}, Vector3d::UnitX ());
  }
  const FaceModel top{SurfaceModel::PLANE, {0.0f, 0.0f, 1.0f, 0.0f}},
      side{SurfaceModel::PLANE, {1.0f, 0.0f, 0.0f, 0.0f}};
  const FaceModel chamfer{SurfaceModel::PLANE, {1.0f, 0.0f, 1.0f, static_cast<float> (w)}};
  EXPECT_EQ (edgesOf (samples, {top, side}).size (), 0u);
  EXPECT_EQ (edgesOf (samples, {top, side, chamfer}).size (), 2u);
}

TEST_F (SharpEdgesFromFaces, RefusesWhatMakesNoSenseWithItsReason)
{
  const auto points = shapes::points (shapes::box (500, HALF));
  Surfaces surfaces = {nullptr};
  const auto refused = [&] (const erkpa::Outcome &outcome, const std::string &part)
  { return !outcome.ok () && outcome.message.find (part) != std::string::npos && surfaces.size () == 1; };
  EXPECT_TRUE (refused (erkpa::sharpEdgesFromFaces (*points, boxFaces (), -1.0, surfaces), "tolerance"));
  std::vector<FaceModel> faces = boxFaces ();
  faces[3].coefficients.pop_back ();
  EXPECT_TRUE (refused (erkpa::sharpEdgesFromFaces (*points, faces, 0.01, surfaces), "face 3"));
  std::fill (points->normals.begin (), points->normals.end (), Eigen::Vector3f::Zero ());
  const erkpa::Outcome outcome = erkpa::sharpEdgesFromFaces (*points, boxFaces (), 0.01, surfaces);
  EXPECT_EQ (outcome.status, Status::NO_NORMALS);
}
