// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_reader.h"
#include "face_normals.h"
#include "point_fields.h"
#include "text_scanner.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace erkpa::tool
{

namespace
{

using Tokens = std::vector<std::string_view>;
using Triple = std::array<double, 3>;

constexpr std::size_t UNKNOWN = SIZE_MAX;     // no face names the vertex
constexpr std::size_t SEVERAL = SIZE_MAX - 1; // the faces disagree: the vertex lies on a sharp edge

/** \brief The vertices of an OBJ file with the normals that its faces give them. */
class ObjReader
{
public:
  explicit ObjReader (TextScanner &scanner) : scanner_ (scanner) {}

  void
  read ()
  {
    Tokens tokens;
    while (scanner_.nextRow (tokens))
    {
      if (tokens[0] == "v")
        readVertex (tokens);
      else if (tokens[0] == "vn")
        normals_.push_back (triple (tokens, 1));
      else if (tokens[0] == "f" && !normals_.empty ())
        std::for_each (tokens.begin () + 1, tokens.end (), [this] (std::string_view c) { readCorner (c); });
      else if (tokens[0] == "f")
        readPolygon (tokens);
    }
  }

  pcl::PCLPointCloud2
  makeCloud ()
  {
    normal_of_.resize (positions_.size (), UNKNOWN);
    // without faces the first normal belongs to the first vertex, and so on
    for (std::size_t i = 0; !has_corners_ && normals_.size () == positions_.size () && i < positions_.size (); ++i)
      normal_of_[i] = i;
    const bool has_normals =
        std::any_of (normal_of_.begin (), normal_of_.end (), [this] (std::size_t n) { return n < normals_.size (); });
    const bool has_colours = colours_.size () == positions_.size ();

    pcl::PCLPointCloud2 cloud;
    append (cloud, {"x", "y", "z"});
    if (has_normals)
      append (cloud, {"nx", "ny", "nz"});
    if (has_colours)
      append (cloud, {"red", "green", "blue"});
    for (std::size_t i = 0; i < positions_.size (); ++i)
    {
      append (cloud, positions_[i]);
      if (has_normals) // zero stands for unknown: such normals are estimated
        append (cloud, normal_of_[i] < normals_.size () ? normals_[normal_of_[i]] : Triple{});
      if (has_colours)
        append (cloud, colours_[i]);
    }
    cloud.width = static_cast<std::uint32_t> (positions_.size ());
    cloud.height = 1;
    if (!normals_.empty ())
      return cloud;
    const std::vector<Eigen::Vector3d> normals = normalsOfFaces ();
    has_face_normals_ = !normals.empty ();
    appendNormals (normals, cloud);
    return cloud;
  }

  bool
  hasFaceNormals () const
  {
    return has_face_normals_;
  }

private:
  static void
  append (pcl::PCLPointCloud2 &cloud, std::initializer_list<const char *> names)
  {
    for (const char *name : names)
      appendField (cloud, name, pcl::PCLPointField::FLOAT64);
  }

  static void
  append (pcl::PCLPointCloud2 &cloud, const Triple &values)
  {
    const auto *bytes = reinterpret_cast<const std::uint8_t *> (values.data ());
    cloud.data.insert (cloud.data.end (), bytes, bytes + sizeof (values));
  }

  Triple
  triple (const Tokens &tokens, std::size_t first) const
  {
    if (tokens.size () < first + 3)
      scanner_.fail ("the row has " + std::to_string (tokens.size () - 1) + " numbers where 3 are expected");
    return {scanner_.number (tokens[first]), scanner_.number (tokens[first + 1]), scanner_.number (tokens[first + 2])};
  }

  /** \brief v x y z, v x y z weight, or v x y z red green blue */
  void
  readVertex (const Tokens &tokens)
  {
    positions_.push_back (triple (tokens, 1));
    if (tokens.size () == 7)
      colours_.push_back (triple (tokens, 4));
    else if (tokens.size () > 5)
      scanner_.fail ("the row has " + std::to_string (tokens.size () - 1) + " numbers where 3 are expected");
  }

  /** \brief A corner v, v/t, v//n or v/t/n of a face. */
  void
  readCorner (std::string_view corner)
  {
    const std::size_t first = corner.find ('/');
    const std::size_t last = corner.rfind ('/');
    const std::size_t vertex = index (corner.substr (0, first), positions_.size ());
    const std::size_t normal = first != last ? index (corner.substr (last + 1), normals_.size ()) : SEVERAL;
    has_corners_ = true;
    if (vertex >= positions_.size ())
      return;
    normal_of_.resize (positions_.size (), UNKNOWN);
    std::size_t &known = normal_of_[vertex];
    known = known == UNKNOWN || same (known, normal) ? normal : SEVERAL;
  }

  /** \brief A face of a file that has no normals so far. */
  void
  readPolygon (const Tokens &tokens)
  {
    polygons_.emplace_back ();
    has_corners_ = true; // normals that come later do not belong to the vertices in their order
    for (std::size_t i = 1; i < tokens.size (); ++i)
      polygons_.back ().push_back (index (tokens[i].substr (0, tokens[i].find ('/')), positions_.size ()));
  }

  std::vector<Eigen::Vector3d>
  normalsOfFaces () const
  {
    std::vector<Eigen::Vector3d> positions;
    for (const Triple &p : positions_)
      positions.emplace_back (p[0], p[1], p[2]);
    FaceNormals normals (positions);
    for (const std::vector<std::size_t> &polygon : polygons_)
      normals.add (polygon);
    return normals.normals ();
  }

  bool
  same (std::size_t a, std::size_t b) const
  {
    return a == b || (a < normals_.size () && b < normals_.size () && normals_[a] == normals_[b]);
  }

  /** \brief Indices count from 1, negative ones from the end; SEVERAL where there is no such element. */
  std::size_t
  index (std::string_view token, std::size_t size) const
  {
    const bool from_end = !token.empty () && token[0] == '-';
    const std::size_t number = scanner_.count (from_end ? token.substr (1) : token);
    if (number == 0 || number > size)
      return SEVERAL;
    return from_end ? size - number : number - 1;
  }

  TextScanner &scanner_;
  std::vector<Triple> positions_;
  std::vector<Triple> normals_;
  std::vector<Triple> colours_;
  std::vector<std::size_t> normal_of_;
  std::vector<std::vector<std::size_t>> polygons_; // without normals
  bool has_corners_ = false;
  bool has_face_normals_ = false;
};

} // namespace

RawCloud
readObj (std::string_view bytes, const std::string &path)
{
  TextScanner scanner (bytes, path);
  ObjReader reader (scanner);
  reader.read ();
  RawCloud result;
  result.cloud = reader.makeCloud ();
  result.has_face_normals = reader.hasFaceNormals ();
  return result;
}

} // namespace erkpa::tool
