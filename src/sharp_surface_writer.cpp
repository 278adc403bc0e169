// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/face_of_points.h>
#include <erkpa/sharp_surface_io.h>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <map>
#include <stdexcept>
#include <string>

namespace erkpa
{

namespace
{

using Kind = SharpSurfaceParts::Kind;

/** \brief Why a surface cannot be written. */
struct NotWritable : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/** \brief The shortest digits that give the same number again. */
template <typename NumberT>
std::string
textOf (NumberT number)
{
  char text[64];
  return {text, std::to_chars (text, text + sizeof (text), number).ptr};
}

/** \brief The numbers of some vectors in one list. */
template <typename VectorT>
std::string
listOf (std::initializer_list<VectorT> vectors)
{
  std::string text;
  for (const VectorT &v : vectors)
    for (int i = 0; i < 3; ++i)
      text += (text.empty () ? "[" : ", ") + textOf (v[i]);
  return text + "]";
}

std::string
vectorText (const Eigen::Vector3d &v)
{
  return listOf ({v});
}

std::string
pointListText (const std::vector<Eigen::Vector3d> &points)
{
  std::string text;
  for (const Eigen::Vector3d &point : points)
    text += (text.empty () ? "[" : ", ") + vectorText (point);
  return text + "]";
}

std::string
modelText (const SharpSurfaceParts &parts)
{
  const auto &c = parts.coefficients;
  for (const double number : c)
    if (!std::isfinite (number))
      throw NotWritable ("has a coefficient that is not finite");
  const std::string first = vectorText (Eigen::Vector3d (c[0], c[1], c[2]));
  const auto axis = [&] { return vectorText (Eigen::Vector3d (c[3], c[4], c[5])); };
  switch (parts.model)
  {
    case SurfaceModel::SPHERE:
      return R"("type": "sphere", "center": )" + first + R"(, "radius": )" + textOf (c[3]);
    case SurfaceModel::CYLINDER:
      return R"("type": "cylinder", "point": )" + first + R"(, "axis": )" + axis () + R"(, "radius": )" + textOf (c[6]);
    case SurfaceModel::CONE:
      return R"("type": "cone", "apex": )" + first + R"(, "axis": )" + axis () + R"(, "angle": )" + textOf (c[6]);
    case SurfaceModel::PLANE:
      break;
  }
  return R"("type": "plane", "normal": )" + first + R"(, "offset": )" + textOf (c[3]);
}

std::string
pointsText (const FacePoints &face)
{
  std::string text = R"("type": "points", "origin": )" + vectorText (face.origin) + R"(, "k": )" + textOf (face.k);
  text += ", \"points\": [";
  for (std::size_t i = 0; i < face.positions.size (); ++i)
    text += (i == 0 ? "\n      " : ",\n      ") + listOf ({face.positions[i], face.normals[i]});
  return text + "]";
}

std::string
extentText (const Extent &extent, double fade)
{
  const ExtentParts parts = extent.parts ();
  const std::string end = (fade > 0.0 ? R"(, "fade": )" + textOf (fade) : "") + "}";
  switch (parts.kind)
  {
    case ExtentParts::Kind::BOX:
      return R"({"type": "box", "low": )" + vectorText (parts.points[0]) + R"(, "high": )" +
             vectorText (parts.points[1]) + end;
    case ExtentParts::Kind::POLYGON:
      return R"({"type": "polygon", "vertices": )" + pointListText (parts.points) + R"(, "thickness": )" +
             textOf (parts.length) + end;
    case ExtentParts::Kind::POINTS:
      return R"({"type": "points", "points": )" + pointListText (parts.points) + R"(, "radius": )" +
             textOf (parts.length) + end;
    case ExtentParts::Kind::OTHER:
      break;
  }
  throw NotWritable ("is limited by an extent of a class of its own");
}

/** \brief Writes surfaces, and collects the faces that they share. */
class Writer
{
public:
  std::string
  write (const std::vector<SharpSurface::ConstPtr> &surfaces);

private:
  /** \brief A surface as an object. */
  std::string
  surfaceText (const SharpSurface &surface);

  /** \brief What a surface is without its extents, as members of an object. */
  std::string
  membersText (const SharpSurface &surface, const SharpSurfaceParts &parts);

  /** \brief The place of a face; the first time it is asked for, the face is written. */
  std::string
  placeOf (const SharpSurface &face);

  std::map<const SharpSurface *, std::size_t> places_; // of the faces
  std::string faces_;
};

std::string
Writer::placeOf (const SharpSurface &face)
{
  if (places_.count (&face) == 0)
  {
    const std::string text = surfaceText (face); // its own faces come first
    faces_ += (faces_.empty () ? "\n    " : ",\n    ") + text;
    places_.emplace (&face, places_.size ());
  }
  return textOf (places_.at (&face));
}

std::string
Writer::membersText (const SharpSurface &surface, const SharpSurfaceParts &parts)
{
  if (places_.count (&surface) != 0)
    return R"("type": "face", "face": )" + placeOf (surface);
  switch (parts.kind)
  {
    case Kind::MODEL:
      return modelText (parts);
    case Kind::POINTS:
      return pointsText (*parts.points);
    case Kind::BETWEEN:
    {
      const std::string face = placeOf (*parts.surface), other = placeOf (*parts.other);
      return R"("type": "between", "face": )" + face + R"(, "other": )" + other;
    }
    case Kind::REVERSED:
      return R"("type": "reversed", "face": )" + placeOf (*parts.surface);
    case Kind::WARPED:
      throw NotWritable ("is seen through a warp of space");
    case Kind::LIMITED:
    case Kind::FUNCTION:
    case Kind::OTHER:
      break;
  }
  throw NotWritable ("is made from functions");
}

std::string
Writer::surfaceText (const SharpSurface &surface)
{
  std::string extents;
  const SharpSurface *inner = &surface; // each is held by the one it is in
  SharpSurfaceParts parts = surface.parts ();
  while (parts.kind == Kind::LIMITED && places_.count (inner) == 0)
  {
    extents = extentText (*parts.extent, parts.fade) + (extents.empty () ? "" : ", ") + extents;
    inner = parts.surface.get ();
    parts = inner->parts ();
  }
  const std::string members = membersText (*inner, parts);
  return "{" + members + (extents.empty () ? "" : R"(, "extents": [)" + extents + "]") + "}";
}

std::string
Writer::write (const std::vector<SharpSurface::ConstPtr> &surfaces)
{
  // Faces first, so that a surface that is one of them is written as that wherever it stands.
  for (std::size_t i = 0; i < surfaces.size (); ++i)
    try
    {
      if (surfaces[i] == nullptr)
        throw NotWritable ("is null");
      surfaceText (*surfaces[i]);
    }
    catch (const NotWritable &reason)
    {
      throw NotWritable ("sharp surface " + std::to_string (i) + " (counted from 0) " + reason.what ());
    }
  std::string list;
  for (const SharpSurface::ConstPtr &surface : surfaces)
    list += (list.empty () ? "\n    " : ",\n    ") + surfaceText (*surface);
  return "{\n  \"format\": \"erkpa sharp surfaces\",\n  \"version\": 1,\n  \"faces\": [" + faces_ +
         "\n  ],\n  \"surfaces\": [" + list + "\n  ]\n}\n";
}

} // namespace

Outcome
writeSharpSurfaces (const std::vector<SharpSurface::ConstPtr> &surfaces, std::string &text)
try
{
  text = Writer ().write (surfaces);
  return {};
}
catch (const NotWritable &reason)
{
  return {Status::INVALID_SETTING, std::string (reason.what ()) +
                                       ", which no numbers describe: leave it out, or describe it by models or points"};
}

} // namespace erkpa
