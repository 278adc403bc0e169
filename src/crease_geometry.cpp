// SPDX-License-Identifier: BSD-3-Clause
#include "crease_geometry.h"

#include "cell_loops.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>

namespace erkpa
{

bool
looksAway (const std::array<int, 3> &triangle, const Eigen::Vector3d &normal, const SurfaceVertices &vertices)
{
  constexpr double LEAST = 0.2; // cosine; a triangle across an edge of the surface has more
  constexpr double FLAT = 1e-3; // height over length: a vertex of a face may happen to lie on the crease
  const auto at = [&] (std::size_t i) { return vertices.positions[static_cast<std::size_t> (triangle[i])]; };
  const Eigen::Vector3d first = at (1) - at (0), second = at (2) - at (1), area = first.cross (at (2) - at (0));
  const double longest = std::max ({first.norm (), second.norm (), (at (0) - at (2)).norm ()});
  if (area.norm () < FLAT * longest * longest)
    return false;
  return area.dot (normal) < LEAST * area.norm () * normal.norm ();
}

bool
isInsideCell (int vertex, const CellLoop &loop, double voxel, const SurfaceVertices &vertices)
{
  const Eigen::Vector3d &x = vertices.positions[static_cast<std::size_t> (vertex)];
  for (std::size_t i = 0; i < loop.ring.size (); ++i)
  {
    const CellEdge edge = cellEdge (loop.edges[i]);
    const auto v = static_cast<std::size_t> (loop.ring[i]);
    const Eigen::Vector3d &place = v < vertices.found.size () ? vertices.found[v] : vertices.positions[v];
    for (int axis = 0; axis < 3; ++axis)
      if (axis != edge.axis)
      {
        const double from_low = x[axis] - place[axis] + ((edge.corner >> axis & 1) != 0 ? voxel : 0.0);
        if (from_low < 0.0 || from_low > voxel)
          return false;
      }
  }
  return true;
}

bool
putBackFarthest (const std::array<int, 3> &one, const std::array<int, 3> &other, SurfaceVertices &vertices)
{
  std::size_t farthest = 0;
  double most = 0.0;
  for (const std::array<int, 3> &triangle : {one, other})
    for (const int v : triangle)
    {
      const auto vertex = static_cast<std::size_t> (v);
      const bool is_on_grid = vertex < vertices.found.size ();
      const double way = is_on_grid ? (vertices.found[vertex] - vertices.positions[vertex]).norm () : 0.0;
      if (way > most)
        farthest = vertex;
      most = std::max (most, way);
    }
  if (most > 0.0)
    vertices.positions[farthest] = vertices.found[farthest];
  return most > 0.0;
}

} // namespace erkpa
