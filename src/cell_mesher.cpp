// SPDX-License-Identifier: BSD-3-Clause
#include "cell_mesher.h"

#include "cell_loops.h"
#include "loop_triangulation.h"
#include "threads.h"

#include <algorithm>

namespace erkpa
{

namespace
{

using Triangle = std::array<int, 3>;

CellLoop
loopOf (const SparseGrid &grid, const GridPoint &cell, const CellLoops &loops, int loop)
{
  CellLoop result;
  result.edges = loops.edges[static_cast<std::size_t> (loop)];
  const auto length = static_cast<std::size_t> (loops.lengths[static_cast<std::size_t> (loop)]);
  for (std::size_t i = 0; i < length; ++i)
  {
    const CellEdge edge = cellEdge (result.edges[i]);
    result.ring.push_back (grid.vertexOnEdge (cell + cornerOffset (edge.corner), edge.axis));
  }
  return result;
}

bool
hasSeveralSides (const CellLoop &loop, const SurfaceVertices &vertices)
{
  const auto key = [&] (int v) { return vertices.side_keys[static_cast<std::size_t> (v)]; };
  return std::any_of (loop.ring.begin (), loop.ring.end (), [&] (int v) { return key (v) != key (loop.ring[0]); });
}

void
meshCell (const SparseGrid &grid, const GridPoint &cell, const SurfaceVertices &vertices, CellMesh &mesh)
{
  const CellLoops loops = traceLoops (grid.cornerValues (cell));
  for (int l = 0; l < loops.count; ++l)
  {
    const CellLoop loop = loopOf (grid, cell, loops, l);
    if (hasSeveralSides (loop, vertices))
      mesh.mixed_loops.push_back (loop);
    else if (!triangulateCell (loop, vertices, mesh.triangles))
      mesh.centered_loops.push_back (loop);
  }
}

template <typename T>
void
append (const std::vector<T> &from, std::vector<T> &to)
{
  to.insert (to.end (), from.begin (), from.end ());
}

} // namespace

bool
triangulateCell (const CellLoop &loop, const SurfaceVertices &vertices, std::vector<Triangle> &triangles)
{
  std::vector<Eigen::Vector3d> positions, normals;
  for (const int v : loop.ring)
  {
    positions.push_back (vertices.positions[static_cast<std::size_t> (v)]);
    normals.push_back (vertices.normals[static_cast<std::size_t> (v)]);
  }
  std::vector<Triangle> corners;
  if (!triangulateLoop (positions, normals, loop.edges, corners))
    return false;
  const auto at = [&loop] (int corner) { return loop.ring[static_cast<std::size_t> (corner)]; };
  for (const Triangle &t : corners)
    triangles.push_back ({at (t[0]), at (t[1]), at (t[2])});
  return true;
}

void
addFan (const std::vector<int> &ring, int center, std::vector<Triangle> &triangles)
{
  for (std::size_t i = 0; i < ring.size (); ++i)
    triangles.push_back ({ring[i], ring[(i + 1) % ring.size ()], center});
}

CellMesh
meshCells (const SparseGrid &grid, const std::vector<GridPoint> &cells, int threads, const SurfaceVertices &vertices)
{
  constexpr std::size_t STRETCH = 1024;
  std::vector<CellMesh> stretches ((cells.size () + STRETCH - 1) / STRETCH);
  parallelFor (
      stretches.size (), threads, [] { return 0; },
      [&] (int, std::size_t i)
      {
        for (std::size_t c = i * STRETCH; c < std::min (cells.size (), (i + 1) * STRETCH); ++c)
          meshCell (grid, cells[c], vertices, stretches[i]);
      });
  CellMesh mesh;
  for (const CellMesh &stretch : stretches)
  {
    append (stretch.triangles, mesh.triangles);
    append (stretch.centered_loops, mesh.centered_loops);
    append (stretch.mixed_loops, mesh.mixed_loops);
  }
  return mesh;
}

} // namespace erkpa
