// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_reader.h"
#include "lzf.h"
#include "point_fields.h"
#include "text_scanner.h"
#include "tool_error.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace erkpa::tool
{

namespace
{

using Field = pcl::PCLPointField;
using Tokens = std::vector<std::string_view>;

/** \brief The header's entries: what follows each keyword. */
struct PcdHeader
{
  std::vector<std::string> names, sizes, types, counts, view_point;
  std::size_t width = 0;
  std::size_t height = 1;
  std::size_t points = std::numeric_limits<std::size_t>::max (); ///< the largest: not given
  std::string data;
};

void
readEntry (const TextScanner &scanner, const Tokens &tokens, PcdHeader &header)
{
  const std::vector<std::string> values (tokens.begin () + 1, tokens.end ());
  const auto one = [&] () -> std::string_view
  {
    if (values.size () != 1)
      scanner.fail (quoted (tokens[0]) + " takes one value");
    return tokens[1];
  };
  if (tokens[0] == "FIELDS" || tokens[0] == "COLUMNS")
    header.names = values;
  else if (tokens[0] == "SIZE")
    header.sizes = values;
  else if (tokens[0] == "TYPE")
    header.types = values;
  else if (tokens[0] == "COUNT")
    header.counts = values;
  else if (tokens[0] == "WIDTH")
    header.width = scanner.count (one ());
  else if (tokens[0] == "HEIGHT")
    header.height = scanner.count (one ());
  else if (tokens[0] == "POINTS")
    header.points = scanner.count (one ());
  else if (tokens[0] == "VIEWPOINT")
    header.view_point = values;
  else if (tokens[0] == "DATA")
    header.data = one ();
  else if (tokens[0] != "VERSION")
    scanner.fail (quoted (tokens[0]) + " is no entry of a PCD header; is this a PCD file?");
}

PcdHeader
readHeader (TextScanner &scanner)
{
  PcdHeader header;
  Tokens tokens;
  while (header.data.empty ())
  {
    scanner.requireRow (tokens, "the header entry DATA");
    readEntry (scanner, tokens, header);
  }
  return header;
}

/** \brief The type that a letter and a number of bytes stand for. */
std::uint8_t
datatypeOf (const TextScanner &scanner, const std::string &type, const std::string &size)
{
  struct Type
  {
    const char *type, *size;
    std::uint8_t datatype;
  };
  constexpr Type TYPES[] = {{"F", "4", Field::FLOAT32}, {"F", "8", Field::FLOAT64}, {"I", "1", Field::INT8},
                            {"I", "2", Field::INT16},   {"I", "4", Field::INT32},   {"I", "8", Field::INT64},
                            {"U", "1", Field::UINT8},   {"U", "2", Field::UINT16},  {"U", "4", Field::UINT32},
                            {"U", "8", Field::UINT64}};
  for (const Type &t : TYPES)
    if (type == t.type && size == t.size)
      return t.datatype;
  scanner.fail ("there is no TYPE " + quoted (type) + " of SIZE " + quoted (size));
}

/** \brief Makes the layout of the cloud from the header. */
void
layOut (const TextScanner &scanner, const PcdHeader &header, RawCloud &result)
{
  const std::size_t fields = header.names.size ();
  if (fields == 0 || header.sizes.size () != fields || header.types.size () != fields ||
      (!header.counts.empty () && header.counts.size () != fields))
    scanner.fail ("FIELDS, SIZE, TYPE and COUNT of the header differ in length; write the file again");
  for (std::size_t i = 0; i < fields; ++i)
  {
    const std::size_t count = header.counts.empty () ? 1 : scanner.count (header.counts[i]);
    if (count > (1u << 20))
      scanner.fail ("COUNT " + quoted (header.counts[i]) + " is too large");
    appendField (result.cloud, header.names[i], datatypeOf (scanner, header.types[i], header.sizes[i]),
                 static_cast<std::uint32_t> (count));
    if (result.cloud.point_step > (1u << 24))
      scanner.fail ("a point is said to take more than 16 MB; is this a PCD file?");
  }
  constexpr std::size_t MOST = std::numeric_limits<std::uint32_t>::max ();
  const std::size_t points = header.points < MOST ? header.points : header.width * header.height;
  if (header.width > MOST || header.height > MOST || (header.width > 0 && points != header.width * header.height))
    scanner.fail ("POINTS is not WIDTH times HEIGHT; write the file again");
  result.cloud.width = static_cast<std::uint32_t> (header.width > 0 ? header.width : points);
  result.cloud.height = static_cast<std::uint32_t> (header.width > 0 ? header.height : 1);
  if (header.view_point.size () < 3)
    return;
  result.view_point.emplace ();
  for (std::size_t a = 0; a < 3; ++a)
    (*result.view_point)[static_cast<Eigen::Index> (a)] = scanner.number (header.view_point[a]);
}

void
requireBytes (std::size_t needed, std::string_view bytes, const std::string &path)
{
  if (bytes.size () < needed)
    throw ToolError (path + ": the file ends early, " + std::to_string (needed - bytes.size ()) +
                     " bytes are missing; write or copy it again");
}

/** \brief All values of a field, then all of the next one: brings them together point by point. */
void
transpose (const std::vector<std::uint8_t> &columns, std::size_t points, pcl::PCLPointCloud2 &cloud)
{
  cloud.data.resize (columns.size ());
  auto from = columns.begin ();
  for (const Field &field : cloud.fields)
  {
    const std::size_t size = sizeOfType (field.datatype) * field.count;
    for (std::size_t i = 0; i < points; ++i, from += static_cast<std::ptrdiff_t> (size))
      std::copy_n (from, size, cloud.data.begin () + static_cast<std::ptrdiff_t> (i * cloud.point_step + field.offset));
  }
}

void
readCompressed (std::string_view body, const std::string &path, std::size_t points, pcl::PCLPointCloud2 &cloud)
{
  std::uint32_t sizes[2] = {0, 0}; // compressed, and what comes out
  requireBytes (sizeof (sizes), body, path);
  std::memcpy (sizes, body.data (), sizeof (sizes));
  body.remove_prefix (sizeof (sizes));
  requireBytes (sizes[0], body, path);
  if (sizes[1] != points * cloud.point_step)
    throw ToolError (path + ": the compressed data is not as long as the header says; write the file again");
  std::vector<std::uint8_t> columns (sizes[1]);
  if (!decompressLzf (body.substr (0, sizes[0]), columns))
    throw ToolError (path + ": the compressed data is damaged; write or copy the file again");
  transpose (columns, points, cloud);
}

} // namespace

RawCloud
readPcd (std::string_view bytes, const std::string &path)
{
  TextScanner scanner (bytes, path);
  const PcdHeader header = readHeader (scanner);
  RawCloud result;
  pcl::PCLPointCloud2 &cloud = result.cloud;
  layOut (scanner, header, result);
  const std::size_t points = static_cast<std::size_t> (cloud.width) * cloud.height;
  const std::string_view body = bytes.substr (scanner.offset ());
  if (header.data == "ascii")
    requireRows (scanner, points, cloud);
  else if (header.data == "binary")
  {
    requireBytes (points * cloud.point_step, body, path);
    const auto *first = reinterpret_cast<const std::uint8_t *> (body.data ());
    cloud.data.assign (first, first + points * cloud.point_step);
  }
  else if (header.data == "binary_compressed")
    readCompressed (body, path, points, cloud);
  else
    scanner.fail ("DATA " + quoted (header.data) + " is unknown; use ascii, binary or binary_compressed");
  return result;
}

} // namespace erkpa::tool
