// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <utility>
#include <vector>

namespace erkpa::tool
{

/** \brief Normals of vertices from the faces around them, for files that have faces and no normals: the mean of the
 * faces' normals by their areas, outwards where the faces turn counterclockwise.
 */
class FaceNormals
{
public:
  explicit FaceNormals (const std::vector<Eigen::Vector3d> &positions);

  /** \brief Adds a polygon; vertices that do not exist are passed over. */
  void
  add (const std::vector<std::size_t> &polygon);

  /** \brief One unit normal per vertex; zero where no face says anything. Empty without faces, and where the faces do
   * not agree about the outside: neighbours run along a common edge in opposite directions. */
  std::vector<Eigen::Vector3d>
  normals () const;

private:
  const std::vector<Eigen::Vector3d> &positions_;
  std::vector<Eigen::Vector3d> sums_;
  std::vector<std::pair<std::size_t, std::size_t>> edges_; // directed
};

} // namespace erkpa::tool
