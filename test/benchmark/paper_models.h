// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

namespace paper
{

/** \brief A row of the paper's Table 1, with what it takes to repeat it. */
struct Row
{
  const char *key;      ///< names the row on the command line
  const char *title;    ///< names it in the table
  const char *file;     ///< where the points are, in the folder of the user
  bool is_sharp;        ///< with two planes along the flat tip
  int points;           ///< the rest as printed in the paper
  double triangles;     ///< number of triangles
  double seconds;       ///< of the whole reconstruction, polygonization included
  double nodes;         ///< mean number of nodes in the support of an evaluation
  double evals_per_sec; ///< evaluations of the field per second
};

const std::vector<Row> &
rows ();

/** \brief A point with its normal, laid out as erkpa::PointView walks over it. */
struct Node
{
  Eigen::Vector3f position, normal;
};

struct Model
{
  std::string source; ///< the file, or what was generated in its place
  std::vector<Node> nodes;
  std::vector<Eigen::Vector4d> planes; ///< a, b, c, d of the sharp planes
};

/** \brief The points of a row from its file in \a folder, or a generated shape where there is no such file.
 *
 * Throws a tool::ToolError where there is one, but it cannot be read.
 */
Model
loadModel (const Row &row, const std::string &folder);

/** \brief A smooth closed shape, or one like a screwdriver, with as many points and as many details as the row's. */
Model
generateModel (const Row &row);

} // namespace paper
