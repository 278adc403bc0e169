// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_reader.h"
#include "point_fields.h"
#include "text_scanner.h"
#include "tool_error.h"

#include <boost/endian/conversion.hpp>

#include <algorithm>
#include <limits>

namespace erkpa::tool
{

namespace
{

using Field = pcl::PCLPointField;
using Tokens = std::vector<std::string_view>;

/** \brief An element of the header: its scalars as the layout of a cloud. */
struct PlyElement
{
  std::string name;
  std::size_t count = 0;
  pcl::PCLPointCloud2 layout;
  bool has_lists = false;
};

struct PlyHeader
{
  std::string format;
  std::vector<PlyElement> elements;
};

std::uint8_t
datatypeOf (const TextScanner &scanner, std::string_view type)
{
  struct Type
  {
    const char *name, *alias;
    std::uint8_t datatype;
  };
  constexpr Type TYPES[] = {{"char", "int8", Field::INT8},        {"uchar", "uint8", Field::UINT8},
                            {"short", "int16", Field::INT16},     {"ushort", "uint16", Field::UINT16},
                            {"int", "int32", Field::INT32},       {"uint", "uint32", Field::UINT32},
                            {"float", "float32", Field::FLOAT32}, {"double", "float64", Field::FLOAT64}};
  for (const Type &t : TYPES)
    if (type == t.name || type == t.alias)
      return t.datatype;
  scanner.fail ("there is no type " + quoted (type) + " in a PLY file");
}

void
readEntry (const TextScanner &scanner, const Tokens &tokens, PlyHeader &header)
{
  const std::string_view keyword = tokens[0];
  if (keyword == "format" && tokens.size () == 3)
    header.format = tokens[1];
  else if (keyword == "element" && tokens.size () == 3)
  {
    header.elements.emplace_back ();
    header.elements.back ().name = tokens[1];
    header.elements.back ().count = scanner.count (tokens[2]);
  }
  else if (keyword == "property" && !header.elements.empty () && tokens.size () == 3)
    appendField (header.elements.back ().layout, std::string (tokens[2]), datatypeOf (scanner, tokens[1]));
  else if (keyword == "property" && !header.elements.empty () && tokens.size () == 5 && tokens[1] == "list")
    header.elements.back ().has_lists = true;
  else if (keyword != "comment" && keyword != "obj_info" && keyword != "end_header")
    scanner.fail ("a PLY header cannot have a line " + quoted (keyword) + "; write the file again");
}

PlyHeader
readHeader (TextScanner &scanner)
{
  PlyHeader header;
  Tokens tokens;
  scanner.requireRow (tokens, "the keyword ply");
  if (tokens[0] != "ply")
    scanner.fail ("the file does not begin with 'ply'; is this a PLY file?");
  while (tokens[0] != "end_header")
  {
    scanner.requireRow (tokens, "end_header");
    readEntry (scanner, tokens, header);
  }
  if (header.format != "ascii" && header.format != "binary_little_endian" && header.format != "binary_big_endian")
    scanner.fail ("the format " + quoted (header.format) + " is unknown");
  return header;
}

/** \brief The bytes behind the header, read element by element. */
class PlyBody
{
public:
  PlyBody (TextScanner &scanner, std::string_view bytes, const std::string &path, const std::string &format)
      : scanner_ (scanner), rest_ (bytes.substr (scanner.offset ())), path_ (path), is_text_ (format == "ascii"),
        is_swapped_ ((format == "binary_big_endian") != (boost::endian::order::native == boost::endian::order::big))
  {
  }

  pcl::PCLPointCloud2
  read (const PlyElement &element)
  {
    pcl::PCLPointCloud2 cloud = element.layout;
    if (element.has_lists || element.count > std::numeric_limits<std::uint32_t>::max ())
      throw ToolError (path_ + ": the element '" + element.name +
                       "' has lists, or too many entries, and cannot be read; export the points alone");
    cloud.width = static_cast<std::uint32_t> (element.count);
    cloud.height = 1;
    if (is_text_)
      requireRows (scanner_, element.count, cloud);
    else
      takeBytes (cloud);
    return cloud;
  }

private:
  void
  takeBytes (pcl::PCLPointCloud2 &cloud)
  {
    const std::size_t needed = static_cast<std::size_t> (cloud.width) * cloud.point_step;
    if (rest_.size () < needed)
      throw ToolError (path_ + ": the file ends early, " + std::to_string (needed - rest_.size ()) +
                       " bytes are missing; write or copy it again");
    const auto *bytes = reinterpret_cast<const std::uint8_t *> (rest_.data ()); // copied as a whole, not one by one
    cloud.data.assign (bytes, bytes + needed);
    rest_.remove_prefix (needed);
    for (std::size_t i = 0; is_swapped_ && i < cloud.width; ++i)
      swapBytes (cloud, cloud.data.data () + i * cloud.point_step);
  }

  static void
  swapBytes (const pcl::PCLPointCloud2 &layout, std::uint8_t *point)
  {
    for (const Field &field : layout.fields)
      std::reverse (point + field.offset, point + field.offset + sizeOfType (field.datatype));
  }

  TextScanner &scanner_;
  std::string_view rest_;
  const std::string &path_;
  bool is_text_;
  bool is_swapped_;
};

/** \brief The sensor's position as PCL's writer leaves it; it writes the origin where it knows none. */
std::optional<Eigen::Vector3d>
viewPointOf (const pcl::PCLPointCloud2 &camera)
{
  const FieldReader x (camera, {"view_px"});
  const FieldReader y (camera, {"view_py"});
  const FieldReader z (camera, {"view_pz"});
  if (camera.width != 1 || !x.exists () || !y.exists () || !z.exists ())
    return std::nullopt;
  const Eigen::Vector3d position (x (0), y (0), z (0));
  return position.isZero (0.0) ? std::nullopt : std::make_optional (position);
}

} // namespace

RawCloud
readPly (std::string_view bytes, const std::string &path)
{
  TextScanner scanner (bytes, path);
  const PlyHeader header = readHeader (scanner);
  PlyBody body (scanner, bytes, path, header.format);
  RawCloud result;
  auto element = header.elements.begin ();
  for (; element != header.elements.end () && element->name != "vertex"; ++element)
    body.read (*element);
  if (element == header.elements.end ())
    scanner.fail ("the header has no element vertex; export the points again");
  result.cloud = body.read (*element);
  if (++element != header.elements.end () && element->name == "camera" && !element->has_lists)
    result.view_point = viewPointOf (body.read (*element));
  return result;
}

} // namespace erkpa::tool
