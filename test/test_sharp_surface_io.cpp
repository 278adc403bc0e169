// SPDX-License-Identifier: BSD-3-Clause
//
// Sharp surfaces as JSON: what is saved is loaded exactly, and what is wrong is named.
#include "field_tests.h"

#include <erkpa/face_of_points.h>
#include <erkpa/sharp_surface_io.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

using erkpa::Extent;
using erkpa::Outcome;
using erkpa::SharpSurface;
using erkpa::Status;
using erkpa::SurfaceModel;
using Surfaces = std::vector<SharpSurface::ConstPtr>;

namespace
{

SharpSurface::ConstPtr
model (SurfaceModel model, const std::vector<float> &coefficients)
{
  SharpSurface::ConstPtr surface;
  EXPECT_TRUE (erkpa::makeSharpSurface (model, coefficients, surface).ok ());
  return surface;
}

SharpSurface::ConstPtr
faceOfPoints (int count, double radius)
{
  const auto points = shapes::points (shapes::sphere (count, radius));
  return erkpa::makeFaceOfPoints (points->positions, points->normals, Vector3d (0.1, 1e6, 1.0 / 3.0), 20);
}

std::vector<Extent::ConstPtr>
extents ()
{
  Extent::ConstPtr box, polygon, points;
  EXPECT_TRUE (erkpa::makeBoxExtent ({-1.0 / 3.0, 0.0, -2e-300}, {1.0, M_PI, 1e300}, box).ok ());
  EXPECT_TRUE (erkpa::makePolygonExtent ({{0, 0, 0.1}, {1, 0, 0}, {1, 1.0 / 3.0, 0}}, 1.0 / 7.0, polygon).ok ());
  EXPECT_TRUE (erkpa::makePointsExtent ({{0.1, 0.2, 0.3}, {1.0 / 3.0, 2e6, -1e-6}}, 0.3, points).ok ());
  return {box, polygon, points};
}

/** \brief One of each kind, some of them sharing faces. */
Surfaces
allKinds ()
{
  const auto plane = model (SurfaceModel::PLANE, {0.1f, -0.2f, 0.3f, 0.7f});
  const auto cylinder = model (SurfaceModel::CYLINDER, {0.1f, 0.2f, 0.3f, 1.0f, 2.0f, -3.0f, 0.3f});
  const auto cone = model (SurfaceModel::CONE, {0.1f, 0.2f, 0.3f, 1.0f, 2.0f, -3.0f, 0.3f});
  const auto ball = faceOfPoints (60, 0.7);
  Surfaces surfaces = {plane,
                       model (SurfaceModel::SPHERE, {0.1f, 0.2f, 0.3f, 0.9f}),
                       cone,
                       ball,
                       erkpa::makeSharpBetween (plane, cylinder),
                       erkpa::makeSharpBetween (cylinder, ball),
                       erkpa::makeSharpBetween (plane, model (SurfaceModel::PLANE, {0.9f, -0.2f, 0.3f, 0.1f}))};
  surfaces.push_back (erkpa::makeSharpBetween (surfaces[4], erkpa::makeReversed (cone)));
  for (const Extent::ConstPtr &extent : extents ())
    surfaces.push_back (erkpa::makeLimited (surfaces[surfaces.size () - 4], extent, 1.0 / 3.0));
  surfaces.push_back (erkpa::makeLimited (surfaces.back (), extents ()[0])); // limited twice
  return surfaces;
}

void
expectSame (const SharpSurface &a, const SharpSurface &b)
{
  for (int i = 0; i < 20; ++i)
  {
    const Vector3d x = randomPoint (2.0);
    EXPECT_EQ (a.theta (x), b.theta (x));
    EXPECT_EQ (a.thetaGradient (x), b.thetaGradient (x));
    EXPECT_EQ (a.presence (x, 0.3), b.presence (x, 0.3));
  }
}

/** \brief Why a text is refused; empty where it is not. */
std::string
refusalOf (const std::string &text)
{
  Surfaces surfaces = {nullptr};
  const Outcome outcome = erkpa::readSharpSurfaces (text, surfaces);
  EXPECT_EQ (outcome.ok (), outcome.message.empty ());
  EXPECT_TRUE (outcome.ok () || (outcome.status == Status::INVALID_SETTING && surfaces.size () == 1));
  return outcome.message;
}

std::string
fileWith (const std::string &surfaces, const std::string &faces = "")
{
  return R"({"format": "erkpa sharp surfaces", "version": 1, "faces": [)" + faces + R"(], "surfaces": [)" + surfaces +
         "]}";
}

bool
contains (const std::string &text, const std::string &part)
{
  return text.find (part) != std::string::npos;
}

/** \brief A folder of the test's own, removed with all in it. */
class Folder
{
public:
  Folder ()
      : path_ (std::filesystem::temp_directory_path () / ("erkpa_io_" + std::to_string (std::random_device () ())))
  {
    std::filesystem::create_directory (path_);
  }

  ~Folder ()
  {
    std::filesystem::remove_all (path_);
  }

  std::string
  file (const std::string &name) const
  {
    return (path_ / name).string ();
  }

  std::ptrdiff_t
  count () const
  {
    return std::distance (std::filesystem::directory_iterator (path_), std::filesystem::directory_iterator ());
  }

private:
  std::filesystem::path path_;
};

} // namespace

class SharpSurfaceIo : public FieldTest
{
};

TEST_F (SharpSurfaceIo, SurfacesOfAllKindsAreLoadedExactlyAsTheyWereSaved)
{
  const Surfaces saved = allKinds ();
  Surfaces loaded;
  std::string text, again;
  ASSERT_TRUE (erkpa::writeSharpSurfaces (saved, text).ok ());
  const Outcome outcome = erkpa::readSharpSurfaces (text, loaded);
  ASSERT_TRUE (outcome.ok ()) << outcome.message << "\n" << text.substr (0, 3000);
  ASSERT_EQ (loaded.size (), saved.size ());
  for (std::size_t i = 0; i < saved.size (); ++i)
    expectSame (*saved[i], *loaded[i]);
  ASSERT_TRUE (erkpa::writeSharpSurfaces (loaded, again).ok ());
  EXPECT_EQ (text, again);
}

TEST_F (SharpSurfaceIo, FacesThatSurfacesShareAreSharedAgain)
{
  Surfaces loaded;
  std::string text;
  ASSERT_TRUE (erkpa::writeSharpSurfaces (allKinds (), text).ok ());
  ASSERT_TRUE (erkpa::readSharpSurfaces (text, loaded).ok ());
  SharpSurface::ConstPtr plane, cylinder, other_cylinder, ball, face, other;
  Extent::ConstPtr extent;
  ASSERT_TRUE (erkpa::facesBehind (*loaded[4], plane, cylinder, extent));
  ASSERT_TRUE (erkpa::facesBehind (*loaded[5], other_cylinder, ball, extent));
  EXPECT_EQ (cylinder, other_cylinder);
  EXPECT_EQ (plane, loaded[0]);
  EXPECT_EQ (ball, loaded[3]);
  ASSERT_TRUE (erkpa::facesBehind (*loaded[7], face, other, extent));
  EXPECT_EQ (face, loaded[4]);
  ASSERT_TRUE (erkpa::facesBehind (*loaded[8], face, other, extent));
  EXPECT_EQ (face, plane);
  EXPECT_NE (extent, nullptr);
  ASSERT_NE (erkpa::pointsBehind (*ball), nullptr);
  EXPECT_EQ (erkpa::pointsBehind (*ball)->positions, erkpa::pointsBehind (*allKinds ()[3])->positions);
  EXPECT_EQ (erkpa::pointsBehind (*ball)->k, 20);
}

TEST_F (SharpSurfaceIo, AFaceOfPointsIsTheSignedDistanceToThem)
{
  const auto ball = faceOfPoints (2000, 0.7);
  const Vector3d center (0.1, 1e6, 1.0 / 3.0);
  for (int i = 0; i < 20; ++i)
  {
    const Vector3d way = randomPoint (1.0).normalized ();
    EXPECT_NEAR (ball->theta (center + 0.75 * way), 0.05, 3e-3);
    EXPECT_LT ((ball->thetaGradient (center + 0.7 * way) - way).norm (), 1e-3);
  }
  EXPECT_EQ (erkpa::makeFaceOfPoints ({}, {}, center), nullptr);
  const std::vector<Eigen::Vector3f> five (5, Eigen::Vector3f::UnitX ()), four (4, Eigen::Vector3f::UnitX ());
  EXPECT_NE (erkpa::makeFaceOfPoints (five, five, center), nullptr);
  EXPECT_EQ (erkpa::makeFaceOfPoints (five, four, center), nullptr);
  EXPECT_EQ (erkpa::makeFaceOfPoints (five, std::vector<Eigen::Vector3f> (5, Eigen::Vector3f::Zero ()), center),
             nullptr);
  EXPECT_EQ (erkpa::makeFaceOfPoints (five, five, center, 3), nullptr);
  EXPECT_EQ (erkpa::pointsBehind (*shapes::plane ({1.0, 0.0, 0.0, 0.0})), nullptr);
}

TEST_F (SharpSurfaceIo, FunctionsAndWarpedSurfacesAreRefusedByTheirPlace)
{
  const auto plane = shapes::plane ({1.0, 0.0, 0.0, 0.0});
  const auto function = erkpa::makeSharpFunction ([] (const Vector3d &x) { return x.x (); },
                                                  [] (const Vector3d &) { return Vector3d (1.0, 0.0, 0.0); });
  const auto warp = erkpa::makeSpaceWarp ([] (const Vector3d &x) { return x; }, [] (const Vector3d &)
                                          { return Eigen::Matrix3d (Eigen::Matrix3d::Identity ()); });
  const SharpSurface::ConstPtr bad[] = {function, erkpa::makeWarpedSharpSurface (plane, warp), nullptr,
                                        erkpa::makeLimited (function, extents ()[0]),
                                        erkpa::makeSharpBetween (plane, function)};
  for (const SharpSurface::ConstPtr &surface : bad)
  {
    std::string text = "as it was";
    const Outcome outcome = erkpa::writeSharpSurfaces ({plane, surface}, text);
    EXPECT_EQ (outcome.status, Status::INVALID_SETTING);
    EXPECT_TRUE (contains (outcome.message, "sharp surface 1 ")) << outcome.message;
    EXPECT_EQ (text, "as it was");
  }
}

TEST_F (SharpSurfaceIo, TextWrittenByHandIsRead)
{
  const std::string text = fileWith (R"({"type": "between", "other": 1, "face": 0,
      "extents": [{"type": "polygon", "vertices": [[0,0,0], [1,0,0], [0,1,0]]}]},
    {"type": "face", "face": 1})",
                                     R"({"type": "plane", "normal": [0, 0, 2], "offset": -1},
    {"type": "sphere", "center": [0, 0, 0], "radius": 1e0})");
  Surfaces surfaces;
  const Outcome outcome = erkpa::readSharpSurfaces (text, surfaces);
  ASSERT_TRUE (outcome.ok ()) << outcome.message;
  ASSERT_EQ (surfaces.size (), 2u);
  EXPECT_NEAR (surfaces[0]->theta ({0.0, 0.0, 2.0}), 1.0 - 1.5, 1e-12);
  EXPECT_EQ (surfaces[0]->presence ({5.0, 5.0, 0.0}, 0.1), 0.0);
  EXPECT_NEAR (surfaces[1]->theta ({0.0, 0.0, 2.0}), 1.0, 1e-12);
  EXPECT_EQ (refusalOf (fileWith ("")), "");
}

TEST_F (SharpSurfaceIo, WhatIsWrongInATextIsNamed)
{
  const std::string plane = R"({"type": "plane", "normal": [0, 0, 1], "offset": 0})";
  const std::pair<std::string, std::string> wrong[] = {
      {"", "line 1"},
      {"{\n \"format\": \n}", "line 3"},
      {"[]", "format"},
      {R"({"format": "else"})", "format"},
      {R"({"format": "erkpa sharp surfaces", "version": 2, "surfaces": []})", "version"},
      {R"({"format": "erkpa sharp surfaces", "version": 1})", "\"surfaces\""},
      {R"({"format": "erkpa sharp surfaces", "version": 1, "surfaces": 5})", "list"},
      {fileWith (plane) + "x", "line 1"},
      {std::string (100000, '['), "deep"},
      {fileWith (plane + R"(, {"type": "torus"})"), "surface 1 has the type \"torus\""},
      {fileWith (R"({"normal": [0, 0, 1]})"), "surface 0 has no \"type\""},
      {fileWith (R"({"type": "plane", "normal": [0, 0, 1]})"), "\"offset\""},
      {fileWith (R"({"type": "plane", "normal": [0, 0], "offset": 1})"), "3 numbers"},
      {fileWith (R"({"type": "plane", "normal": [0, 0, "a"], "offset": 1})"), "\"normal\""},
      {fileWith (R"({"type": "plane", "normal": [0, 0, 1], "offset": 1e999})"), "\"offset\""},
      {fileWith (R"({"type": "plane", "normal": [0, 0, 0], "offset": 1})"), "normal a, b, c is zero"},
      {fileWith (R"({"type": "plane", "normal": [0, 0, 1], "offset": 1, "ofset": 2})"), "\"ofset\""},
      {fileWith (R"({"type": "between", "face": 0, "other": 1})", plane), "is 1"},
      {fileWith (R"({"type": "between", "face": -1, "other": 0})", plane), "is -1"},
      {fileWith (R"({"type": "between", "face": 0, "other": 0.5})", plane), "whole number"},
      {fileWith (R"({"type": "between", "face": 0, "other": 1})", plane + "," + plane), "parallel"},
      {fileWith ("", R"({"type": "face", "face": 0})"), "face 0"},
      {fileWith (R"({"type": "points", "origin": [0, 0, 0], "points": [[0, 0, 0, 0, 0, 1]]})"), "five points"},
      {fileWith (R"({"type": "face", "face": 0, "extents": [{"type": "box", "low": [0, 0, 1], "high": [0, 0, 0]}]})",
                 plane),
       "\"extents\", 0"},
      {fileWith (R"({"type": "face", "face": 0, "extents": [{"type": "ball"}]})", plane), "\"ball\""},
      {fileWith (R"({"type": "face", "face": 0, "extents": [{"type": "points", "points": [[0, 0, 0]], "radius": 1,
                 "fade": -1}]})",
                 plane),
       "\"fade\""}};
  for (const auto &[text, part] : wrong)
    EXPECT_TRUE (contains (refusalOf (text), part)) << refusalOf (text) << " should have " << part;
}

TEST_F (SharpSurfaceIo, FilesAppearWholeOrNotAtAll)
{
  const Folder folder;
  const std::string path = folder.file ("edges.json");
  const auto plane = shapes::plane ({1.0, 0.0, 0.0, 0.25});
  ASSERT_TRUE (erkpa::saveSharpSurfaces (path, allKinds ()).ok ());
  ASSERT_TRUE (erkpa::saveSharpSurfaces (path, {plane}).ok ()); // takes the place of the older one
  EXPECT_EQ (folder.count (), 1);
  Surfaces surfaces;
  ASSERT_TRUE (erkpa::loadSharpSurfaces (path, surfaces).ok ());
  ASSERT_EQ (surfaces.size (), 1u);
  expectSame (*surfaces[0], *plane);
  const Outcome outcome = erkpa::saveSharpSurfaces (path, {plane, nullptr});
  EXPECT_TRUE (contains (outcome.message, path) && contains (outcome.message, "sharp surface 1"));
  EXPECT_TRUE (erkpa::loadSharpSurfaces (path, surfaces).ok ()) << "the older one stays";
  EXPECT_EQ (folder.count (), 1);
}

TEST_F (SharpSurfaceIo, FilesThatCannotBeReadOrWrittenAreNamed)
{
  const Folder folder;
  Surfaces surfaces = {nullptr};
  std::ofstream (folder.file ("bad.json")) << "{\n\n]";
  for (const std::string &name : {folder.file ("none.json"), folder.file (""), folder.file ("bad.json")})
  {
    const Outcome outcome = erkpa::loadSharpSurfaces (name, surfaces);
    EXPECT_EQ (outcome.status, Status::INVALID_SETTING);
    EXPECT_TRUE (contains (outcome.message, name)) << outcome.message;
    EXPECT_EQ (surfaces.size (), 1u);
  }
  for (const std::string &name : {folder.file ("no/such.json"), folder.file (""), std::string ()})
  {
    const Outcome outcome = erkpa::saveSharpSurfaces (name, {});
    EXPECT_EQ (outcome.status, Status::INVALID_SETTING);
    EXPECT_TRUE (contains (outcome.message, name)) << outcome.message;
  }
  EXPECT_EQ (folder.count (), 1);
}
