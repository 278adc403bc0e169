// SPDX-License-Identifier: BSD-3-Clause
#include "paper_models.h"

#include "cloud_reader.h"
#include "point_fields.h"
#include "tool_error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>

namespace paper
{

namespace
{

using erkpa::tool::FieldReader;
using erkpa::tool::ToolError;

// Two planes along the flat tip of screwdriver_40722.xyz, outward: its faces (least squares over the points between
// z = 0.26 and 0.47 with |n_y| > 0.95, which lie within 0.0004 of them), moved inwards by 0.003. There they halve the
// chamfers of about 0.006 that the scan has in the place of edges. On the faces themselves they would have nothing
// beyond them but the noise of the points, which says nothing about the jump of the gradient.
const Eigen::Vector4d UPPER_PLANE (0.051959, 0.997194, 0.053898, -0.023152);
const Eigen::Vector4d LOWER_PLANE (-0.053759, -0.996651, 0.061614, -0.033839);

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
  if (!fields[3].exists ())
    throw ToolError (path + ": the points have no normals; give x y z nx ny nz on every line, or faces");
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
