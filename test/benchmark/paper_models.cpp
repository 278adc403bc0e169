// SPDX-License-Identifier: BSD-3-Clause
#include "paper_models.h"

#include "cloud_reader.h"
#include "point_fields.h"
#include "text_scanner.h"
#include "tool_error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>

namespace paper
{

namespace
{

using erkpa::tool::FieldReader;
using erkpa::tool::TextScanner;
using erkpa::tool::ToolError;

// Two planes along the flat tip of screwdriver_40722.xyz, outward: its faces (least squares over the points between
// z = 0.26 and 0.47 with |n_y| > 0.95, which lie within 0.0004 of them), moved inwards by 0.003. There they halve the
// chamfers of about 0.006 that the scan has in the place of edges. On the faces themselves they would have nothing
// beyond them but the noise of the points, which says nothing about the jump of the gradient.
const Eigen::Vector4d UPPER_PLANE (0.051959, 0.997194, 0.053898, -0.023152);
const Eigen::Vector4d LOWER_PLANE (-0.053759, -0.996651, 0.061614, -0.033839);

using Face = std::vector<std::size_t>;

/** \brief The faces of an .off file, which the reader of the tool leaves alone: it is one for points. */
std::vector<Face>
readFaces (const std::string &path, std::size_t vertices)
{
  std::stringstream text;
  text << std::ifstream (path, std::ios::binary).rdbuf ();
  const std::string bytes = text.str ();
  TextScanner scanner (bytes, path);
  std::vector<std::string_view> tokens;
  scanner.requireRow (tokens, "the keyword OFF");
  if (tokens.size () == 1)
    scanner.requireRow (tokens, "the line with the number of vertices");
  for (std::size_t i = 0; i < vertices; ++i)
    scanner.requireRow (tokens, "a vertex");
  std::vector<Face> faces;
  while (scanner.nextRow (tokens))
  {
    Face face;
    for (std::size_t i = 1; i < tokens.size () && i <= scanner.count (tokens[0]); ++i)
      face.push_back (scanner.count (tokens[i]));
    if (std::any_of (face.begin (), face.end (), [vertices] (std::size_t corner) { return corner >= vertices; }))
      scanner.fail ("the face names a vertex that does not exist");
    faces.push_back (face);
  }
  return faces;
}

/** \brief Gives the nodes the normals of the faces around them, weighted by area. */
void
addFaceNormals (const std::vector<Face> &faces, std::vector<Node> &nodes)
{
  for (const Face &face : faces)
    for (std::size_t i = 2; i < face.size (); ++i)
    {
      const Eigen::Vector3f &a = nodes[face[0]].position;
      const Eigen::Vector3f doubled_area = (nodes[face[i - 1]].position - a).cross (nodes[face[i]].position - a);
      for (const std::size_t corner : {face[0], face[i - 1], face[i]})
        nodes[corner].normal += doubled_area;
    }
  for (Node &node : nodes)
    node.normal.normalize ();
}

std::vector<Node>
readNodes (const std::string &path)
{
  constexpr const char *NAMES[] = {"x", "y", "z", "nx", "ny", "nz"};
  const pcl::PCLPointCloud2 cloud = erkpa::tool::readCloud (path).cloud;
  std::array<FieldReader, 6> fields;
  std::transform (std::begin (NAMES), std::end (NAMES), fields.begin (),
                  [&cloud] (const char *name) { return FieldReader (cloud, {name}); });
  const auto read = [&fields] (std::size_t field, std::size_t point)
  { return fields[field].exists () ? static_cast<float> (fields[field](point)) : 0.0f; };
  std::vector<Node> nodes (static_cast<std::size_t> (cloud.width) * cloud.height);
  for (std::size_t i = 0; i < nodes.size (); ++i)
  {
    nodes[i].position = {read (0, i), read (1, i), read (2, i)};
    nodes[i].normal = {read (3, i), read (4, i), read (5, i)};
  }
  if (fields[3].exists ())
    return nodes;
  if (std::filesystem::path (path).extension () != ".off")
    throw ToolError (path + ": the points have no normals; give x y z nx ny nz on every line");
  addFaceNormals (readFaces (path, nodes.size ()), nodes);
  return nodes;
}

} // namespace

const std::vector<Row> &
rows ()
{
  static const std::vector<Row> ROWS = {
      {"maxplanck", "Max Planck", "maxplanck_52809.xyz", false, 52809, 165388, 2862, 3196, 424},
      {"screwdriver", "Screwdriver", "screwdriver_40722.xyz", false, 40722, 25484, 880, 2384, 213},
      {"sharp", "Screwdriver+Sharp", "screwdriver_40722.xyz", true, 40722, 26160, 1442, 2384, 133},
      {"buddha", "Buddha", "happy_buddha_5000.xyz", false, 5000, 58080, 176, 455, 2409},
      {"venus", "Venus", "venus_711.off", false, 711, 8871, 6, 93, 10971}};
  return ROWS;
}

Model
loadModel (const Row &row, const std::string &folder)
{
  const std::string path = (std::filesystem::path (folder) / row.file).string ();
  if (folder.empty () || !std::filesystem::exists (path))
    return generateModel (row);
  Model model;
  model.source = row.file;
  model.nodes = readNodes (path);
  if (row.is_sharp)
    model.planes = {UPPER_PLANE, LOWER_PLANE};
  return model;
}

} // namespace paper
