// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

namespace erkpa
{

/** \brief Triangulate a loop of a cell without new vertices.
 *
 * No chord joins two vertices of one face: the neighbour cell could use the same one, and four triangles would meet
 * there. Among the other triangulations takes the one whose triangles agree best with the vertex normals, and with
 * the shorter chords where they agree alike.
 * \param[in] positions,normals of the loop's vertices, in order; up to 12
 * \param[in] edges the cell edge of each vertex
 * \param[out] triangles corners as places in the loop, appended
 * \return false where every triangulation needs a forbidden chord; the best of them is given then
 */
bool
triangulateLoop (const std::vector<Eigen::Vector3d> &positions, const std::vector<Eigen::Vector3d> &normals,
                 const std::array<int, 12> &edges, std::vector<std::array<int, 3>> &triangles);

} // namespace erkpa
