// SPDX-License-Identifier: BSD-3-Clause
#include "json_node.h"
#include "sharp_models.h"

#include <erkpa/face_of_points.h>
#include <erkpa/sharp_surface_io.h>

#include <boost/property_tree/json_parser.hpp>

#include <array>
#include <cstddef>
#include <sstream>
#include <string>
#include <utility>

namespace erkpa
{

namespace
{

void
expectOk (const JsonNode &node, const Outcome &outcome)
{
  if (!outcome.ok ())
    node.fail ("makes no surface: " + outcome.message);
}

double
numberOr0 (const JsonNode &node, const char *name)
{
  return node.has (name) ? node.member (name).number<double> () : 0.0;
}

/** \brief A surface of a model: two vectors, the second maybe none, and a number. */
SharpSurface::ConstPtr
readModel (const JsonNode &node, SurfaceModel model, const char *first, const char *second, const char *last)
{
  std::array<double, 7> coefficients = {};
  std::size_t count = 0;
  for (const char *name : {first, second})
    if (name != nullptr)
      for (const double value : node.member (name).numbers<double, 3> ())
        coefficients[count++] = value;
  coefficients[count++] = node.member (last).number<double> ();
  SharpSurface::ConstPtr surface;
  expectOk (node, makeModelSurface (model, coefficients, count, surface));
  node.expectOnly ({"type", "extents", first, second != nullptr ? second : first, last});
  return surface;
}

SharpSurface::ConstPtr
readPoints (const JsonNode &node)
{
  node.expectOnly ({"type", "extents", "origin", "k", "points"});
  std::vector<Eigen::Vector3f> positions, normals;
  for (const JsonNode &point : node.member ("points").list ())
  {
    const auto v = point.numbers<float, 6> ();
    positions.emplace_back (v[0], v[1], v[2]);
    normals.emplace_back (v[3], v[4], v[5]);
  }
  const auto surface = makeFaceOfPoints (std::move (positions), std::move (normals), node.member ("origin").vector (),
                                         node.has ("k") ? node.member ("k").number<int> () : 0);
  if (!surface)
    node.fail ("makes no face: give at least five points with normals, and a k of at least 5, or 0");
  return surface;
}

Extent::ConstPtr
readExtent (const JsonNode &node)
{
  Extent::ConstPtr extent;
  const std::string type = node.member ("type").word ();
  if (type == "box")
  {
    node.expectOnly ({"type", "fade", "low", "high"});
    expectOk (node, makeBoxExtent (node.member ("low").vector (), node.member ("high").vector (), extent));
  }
  else if (type == "polygon")
  {
    node.expectOnly ({"type", "fade", "vertices", "thickness"});
    expectOk (node, makePolygonExtent (node.member ("vertices").vectors (), numberOr0 (node, "thickness"), extent));
  }
  else if (type == "points")
  {
    node.expectOnly ({"type", "fade", "points", "radius"});
    const double radius = node.member ("radius").number<double> ();
    expectOk (node, makePointsExtent (node.member ("points").vectors (), radius, extent));
  }
  else
    node.fail ("has the type \"" + type + "\": use box, polygon or points");
  return extent;
}

using Surfaces = std::vector<SharpSurface::ConstPtr>;

SharpSurface::ConstPtr
readFace (const JsonNode &node, const Surfaces &faces)
{
  const auto place = node.number<int> ();
  if (place < 0 || static_cast<std::size_t> (place) >= faces.size ())
    node.fail ("is " + std::to_string (place) + ": give the place of a face that stands before, of " +
               std::to_string (faces.size ()) + " counted from 0");
  return faces[static_cast<std::size_t> (place)];
}

SharpSurface::ConstPtr
readBetween (const JsonNode &node, const Surfaces &faces)
{
  node.expectOnly ({"type", "extents", "face", "other"});
  const auto between =
      makeSharpBetween (readFace (node.member ("face"), faces), readFace (node.member ("other"), faces));
  if (!between)
    node.fail ("makes no surface: its faces are parallel planes, give two that meet");
  return between;
}

/** \brief A surface without its extents. */
SharpSurface::ConstPtr
readWhole (const JsonNode &node, const Surfaces &faces)
{
  const std::string type = node.member ("type").word ();
  if (type == "plane")
    return readModel (node, SurfaceModel::PLANE, "normal", nullptr, "offset");
  if (type == "sphere")
    return readModel (node, SurfaceModel::SPHERE, "center", nullptr, "radius");
  if (type == "cylinder")
    return readModel (node, SurfaceModel::CYLINDER, "point", "axis", "radius");
  if (type == "cone")
    return readModel (node, SurfaceModel::CONE, "apex", "axis", "angle");
  if (type == "points")
    return readPoints (node);
  if (type == "between")
    return readBetween (node, faces);
  if (type != "face" && type != "reversed")
    node.fail ("has the type \"" + type + "\": use plane, sphere, cylinder, cone, points, between, reversed or face");
  node.expectOnly ({"type", "extents", "face"});
  SharpSurface::ConstPtr face = readFace (node.member ("face"), faces);
  return type == "face" ? face : makeReversed (face);
}

SharpSurface::ConstPtr
readSurface (const JsonNode &node, const Surfaces &faces)
{
  SharpSurface::ConstPtr surface = readWhole (node, faces);
  if (node.has ("extents"))
    for (const JsonNode &extent : node.member ("extents").list ())
    {
      surface = makeLimited (surface, readExtent (extent), numberOr0 (extent, "fade"));
      if (!surface)
        extent.fail ("has a negative \"fade\": give a length, or 0 for an automatic one");
    }
  return surface;
}

/** \brief The parser calls itself for each level; far fewer are needed than a stack can bear. */
void
checkDepth (const std::string &text)
{
  constexpr int DEEPEST = 32;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size (); ++i)
  {
    if (quoted && text[i] == '\\')
      ++i;
    else if (text[i] == '"')
      quoted = !quoted;
    else if (!quoted)
      depth += (text[i] == '[' || text[i] == '{') - (text[i] == ']' || text[i] == '}');
    if (depth > DEEPEST)
      throw NotReadable ("this is no list of sharp surfaces: it is nested too deep");
  }
}

Surfaces
read (const std::string &text)
{
  checkDepth (text);
  boost::property_tree::ptree tree;
  std::istringstream stream (text);
  boost::property_tree::read_json (stream, tree);
  const JsonNode root (tree, "the whole");
  constexpr const char *FORMAT = "erkpa sharp surfaces";
  if (!root.has ("format") || root.member ("format").word () != FORMAT)
    root.fail (std::string ("is no list of sharp surfaces: it must have \"format\": \"") + FORMAT + "\"");
  if (root.member ("version").number<int> () != 1)
    root.fail ("is of another version: this program reads version 1");
  root.expectOnly ({"format", "version", "faces", "surfaces"});
  Surfaces faces, surfaces;
  if (root.has ("faces"))
    for (const JsonNode &node : JsonNode (tree.get_child ("faces"), "face").list ())
      faces.push_back (readSurface (node, faces));
  root.member ("surfaces"); // must be there
  for (const JsonNode &node : JsonNode (tree.get_child ("surfaces"), "surface").list ())
    surfaces.push_back (readSurface (node, faces));
  return surfaces;
}

} // namespace

Outcome
readSharpSurfaces (const std::string &text, std::vector<SharpSurface::ConstPtr> &surfaces)
try
{
  surfaces = read (text);
  return {};
}
catch (const boost::property_tree::json_parser_error &error)
{
  return {Status::INVALID_SETTING,
          "line " + std::to_string (error.line ()) + " is no JSON (" + error.message () + "): correct it"};
}
catch (const NotReadable &error)
{
  return {Status::INVALID_SETTING, error.what ()};
}

} // namespace erkpa
