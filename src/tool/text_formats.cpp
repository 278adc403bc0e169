// SPDX-License-Identifier: BSD-3-Clause
//
// The tables of text: .xyz, .xyzn, .pwn, .off.
#include "cloud_reader.h"
#include "point_fields.h"
#include "text_scanner.h"

#include <algorithm>
#include <cstring>

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

/** \brief Rows x y z or x y z nx ny nz from \a tokens to the end of the text; the first row tells which. */
void
readTable (TextScanner &scanner, Tokens &tokens, pcl::PCLPointCloud2 &cloud)
{
  if (tokens.size () != 3 && tokens.size () != 6)
    scanner.fail ("the row has " + std::to_string (tokens.size ()) +
                  " columns; give x y z, or x y z nx ny nz, on every line");
  appendFields (cloud, {"x", "y", "z"});
  if (tokens.size () == 6)
    appendFields (cloud, {"nx", "ny", "nz"});
  const std::size_t columns = tokens.size ();
  std::size_t count = 0;
  do
  {
    scanner.requireColumns (tokens, columns);
    appendRow (scanner, tokens, cloud);
    ++count;
  } while (scanner.nextRow (tokens));
  setCount (cloud, count);
}

} // namespace

RawCloud
readXyz (std::string_view bytes, const std::string &path)
{
  RawCloud result;
  TextScanner scanner (bytes, path);
  Tokens tokens;
  if (scanner.nextRow (tokens))
    readTable (scanner, tokens, result.cloud);
  return result;
}

RawCloud
readPwn (std::string_view bytes, const std::string &path)
{
  RawCloud result;
  TextScanner scanner (bytes, path);
  Tokens tokens;
  if (!scanner.nextRow (tokens))
    return result;
  if (tokens.size () != 1)
  {
    readTable (scanner, tokens, result.cloud);
    return result;
  }
  const std::size_t count = scanner.count (tokens[0]);
  scanner.requireRow (tokens, "point 1 of " + std::to_string (count));
  readTable (scanner, tokens, result.cloud);
  if (result.cloud.width != count)
    scanner.fail ("the file has " + std::to_string (result.cloud.width) + " rows where its first line promises " +
                  std::to_string (count) + "; write or copy it again");
  return result;
}

namespace
{

/** \brief The layout that the keyword [C][N]OFF gives the rows; the colour may end with an alpha. */
void
layOutOff (const TextScanner &scanner, std::string_view keyword, std::size_t columns, pcl::PCLPointCloud2 &cloud)
{
  const bool has_normals = keyword == "NOFF" || keyword == "CNOFF" || keyword == "NCOFF";
  const bool has_colour = keyword == "COFF" || keyword == "CNOFF" || keyword == "NCOFF";
  if (!has_normals && !has_colour && keyword != "OFF")
    scanner.fail ("the file begins with " + quoted (keyword) + "; save it as OFF, NOFF, COFF or CNOFF");
  appendFields (cloud, {"x", "y", "z"});
  if (has_normals)
    appendFields (cloud, {"nx", "ny", "nz"});
  if (has_colour)
    appendFields (cloud, {"red", "green", "blue"});
  if (has_colour && columns > columnsOf (cloud))
    appendFields (cloud, {"alpha"});
}

/** \brief Colours are written as 0 to 1 or as 0 to 255; makes them 0 to 1. */
void
normalizeColours (pcl::PCLPointCloud2 &cloud)
{
  double largest = 0.0;
  const auto forEach = [&cloud] (auto action)
  {
    for (const Field &field : cloud.fields)
      for (std::size_t i = 0; i < cloud.width && (field.name == "red" || field.name == "green" || field.name == "blue");
           ++i)
      {
        std::uint8_t *bytes = cloud.data.data () + i * cloud.point_step + field.offset;
        double value = 0.0;
        std::memcpy (&value, bytes, sizeof (value));
        value = action (value);
        std::memcpy (bytes, &value, sizeof (value));
      }
  };
  forEach ([&largest] (double value) { return largest = std::max (largest, value), value; });
  if (largest > 1.0)
    forEach ([] (double value) { return value / 255.0; });
}

} // namespace

RawCloud
readOff (std::string_view bytes, const std::string &path)
{
  RawCloud result;
  TextScanner scanner (bytes, path);
  Tokens tokens;
  scanner.requireRow (tokens, "the keyword OFF");
  const std::string keyword (tokens[0]);
  tokens.erase (tokens.begin ());
  if (tokens.empty ())
    scanner.requireRow (tokens, "the line with the number of vertices");
  const std::size_t count = scanner.count (tokens[0]);
  TextScanner ahead = scanner; // the first row tells whether a colour has three values or four
  ahead.nextRow (tokens);
  layOutOff (scanner, keyword, tokens.size (), result.cloud);
  readRows (scanner, count, result.cloud);
  setCount (result.cloud, count);
  normalizeColours (result.cloud);
  return result;
}

} // namespace erkpa::tool
