// SPDX-License-Identifier: BSD-3-Clause
//
// The tables of text: .xyz, .xyzn, .pwn, .off.
#include "cloud_reader.h"
#include "face_normals.h"
#include "float_cloud.h"
#include "point_fields.h"
#include "text_scanner.h"

#include <algorithm>
#include <limits>

namespace erkpa::tool
{

namespace
{

using Field = pcl::PCLPointField;
using Tokens = std::vector<std::string_view>;

void
appendFields (pcl::PCLPointCloud2 &cloud, std::initializer_list<const char *> names)
{
  for (const char *name : names)
    appendField (cloud, name, Field::FLOAT64); // the digits of the text are kept until the cloud is made
}

void
setCount (pcl::PCLPointCloud2 &cloud, std::size_t count)
{
  cloud.width = static_cast<std::uint32_t> (count);
  cloud.height = 1;
}

/** \brief Whether the last three of six columns are colours, not normals: whole numbers of a byte, and not all of them
 * 0 and 1. */
bool
endsWithColours (TextScanner ahead)
{
  constexpr int ROWS = 64; // that are looked at
  Tokens tokens;
  bool any_large = false;
  for (int row = 0; row < ROWS && ahead.nextRow (tokens) && tokens.size () == 6; ++row)
    for (std::size_t column = 3; column < 6; ++column)
    {
      const std::string_view token = tokens[column];
      const auto is_digit = [] (char c) { return c >= '0' && c <= '9'; };
      if (token.size () > 3 || !std::all_of (token.begin (), token.end (), is_digit) ||
          std::stoi (std::string (token)) > 255)
        return false;
      any_large = any_large || token.size () > 1 || token[0] > '1';
    }
  return any_large;
}

/** \brief Rows x y z, x y z nx ny nz or x y z r g b to the end of the text; the first rows tell which. */
void
readTable (TextScanner &scanner, pcl::PCLPointCloud2 &cloud)
{
  TextScanner ahead = scanner;
  Tokens tokens;
  const bool is_empty = !ahead.nextRow (tokens);
  appendFields (cloud, {"x", "y", "z"});
  if (is_empty)
    return; // the cloud says so itself
  if (tokens.size () != 3 && tokens.size () != 6)
    ahead.fail ("the row has " + std::to_string (tokens.size ()) +
                " columns; give x y z, x y z nx ny nz or x y z r g b on every line");
  if (tokens.size () == 6 && endsWithColours (scanner))
    for (const char *name : {"red", "green", "blue"})
      appendField (cloud, name, Field::UINT8);
  else if (tokens.size () == 6)
    appendFields (cloud, {"nx", "ny", "nz"});
  setCount (cloud, readRows (scanner, std::numeric_limits<std::size_t>::max (), cloud));
}

} // namespace

RawCloud
readXyz (std::string_view bytes, const std::string &path)
{
  RawCloud result;
  TextScanner scanner (bytes, path);
  readTable (scanner, result.cloud);
  return result;
}

RawCloud
readPwn (std::string_view bytes, const std::string &path)
{
  RawCloud result;
  TextScanner scanner (bytes, path), ahead = scanner;
  Tokens tokens;
  if (!ahead.nextRow (tokens) || tokens.size () != 1)
  {
    readTable (scanner, result.cloud);
    return result;
  }
  scanner = ahead;
  const std::size_t count = scanner.count (tokens[0]);
  ahead.requireRow (tokens, "the first point");
  readTable (scanner, result.cloud);
  const std::size_t rows = result.cloud.width;
  if (rows != count)
    scanner.fail ("the file has " + std::to_string (rows) + " rows and promises " + std::to_string (count) +
                  " on its first line; write or copy it again");
  return result;
}

namespace
{

/** \brief What the keyword of an OFF file says of its rows. */
struct OffKeyword
{
  bool has_normals = false;
  bool has_colour = false;
};

OffKeyword
readKeyword (const TextScanner &scanner, std::string_view keyword)
{
  OffKeyword result;
  result.has_normals = keyword == "NOFF" || keyword == "CNOFF" || keyword == "NCOFF";
  result.has_colour = keyword == "COFF" || keyword == "CNOFF" || keyword == "NCOFF";
  if (!result.has_normals && !result.has_colour && keyword != "OFF")
    scanner.fail ("the file begins with " + quoted (keyword) + "; save it as OFF, NOFF, COFF or CNOFF");
  return result;
}

/** \brief The fields of the rows, of which \a row is the first: colours are 0 to 255, or 0 to 1 with a point,
 * and may end with an alpha. */
void
layOutOff (const OffKeyword &keyword, const Tokens &row, pcl::PCLPointCloud2 &cloud)
{
  appendFields (cloud, {"x", "y", "z"});
  if (keyword.has_normals)
    appendFields (cloud, {"nx", "ny", "nz"});
  if (!keyword.has_colour)
    return;
  const bool has_point =
      std::any_of (row.begin () + static_cast<std::ptrdiff_t> (std::min (columnsOf (cloud), row.size ())), row.end (),
                   [] (std::string_view t) { return t.find ('.') != t.npos; });
  for (const char *name : {"red", "green", "blue", "alpha"})
    if (columnsOf (cloud) < row.size () || *name != 'a')
      appendField (cloud, name, has_point ? Field::FLOAT64 : Field::UINT8);
}

/** \brief The normals that the faces after the vertices give; empty where there are none. */
std::vector<Eigen::Vector3d>
readFaces (TextScanner &scanner, std::size_t count, const pcl::PCLPointCloud2 &cloud)
{
  const std::vector<Eigen::Vector3d> positions = positionsOf (cloud);
  FaceNormals normals (positions);
  Tokens tokens;
  std::vector<std::size_t> polygon;
  for (std::size_t face = 0; face < count && scanner.nextRow (tokens); ++face)
  {
    polygon.clear ();
    const std::size_t corners = std::min (scanner.count (tokens[0]), tokens.size () - 1); // colours may follow
    for (std::size_t i = 1; i <= corners; ++i)
      polygon.push_back (scanner.count (tokens[i]));
    normals.add (polygon);
  }
  return normals.normals ();
}

} // namespace

RawCloud
readOff (std::string_view bytes, const std::string &path)
{
  RawCloud result;
  TextScanner scanner (bytes, path);
  Tokens tokens;
  scanner.requireRow (tokens, "the keyword OFF");
  const OffKeyword keyword = readKeyword (scanner, tokens[0]);
  tokens.erase (tokens.begin ());
  if (tokens.empty ())
    scanner.requireRow (tokens, "the line with the number of vertices");
  const std::size_t count = scanner.count (tokens[0]);
  const std::size_t faces = tokens.size () > 1 ? scanner.count (tokens[1]) : 0;
  TextScanner ahead = scanner;
  ahead.nextRow (tokens);
  layOutOff (keyword, tokens, result.cloud);
  requireRows (scanner, count, result.cloud);
  setCount (result.cloud, count);
  if (keyword.has_normals)
    return result;
  const std::vector<Eigen::Vector3d> normals = readFaces (scanner, faces, result.cloud);
  result.has_face_normals = !normals.empty ();
  appendNormals (normals, result.cloud);
  return result;
}

} // namespace erkpa::tool
