// SPDX-License-Identifier: BSD-3-Clause
#include "cell_mesher.h"

#include "crease_turn.h"
#include "grid_window.h"
#include "loop_triangulation.h"
#include "parallel_collect.h"

#include <algorithm>
#include <utility>

namespace erkpa
{

namespace
{

using Triangle = std::array<int, 3>;

/** \brief Append the triangles of a loop; false, and none of them, where it needs a vertex of its own. */
bool
triangulateRing (const int *ring, std::size_t size, const LoopEdges &edges, const SurfaceVertices &vertices,
                 std::vector<Triangle> &triangles)
{
  if (size == 3)
  {
    triangles.push_back ({ring[0], ring[1], ring[2]});
    return true;
  }
  LoopShape shape;
  shape.size = static_cast<int> (size);
  shape.edges = edges;
  for (std::size_t i = 0; i < size; ++i)
  {
    shape.positions[i] = vertices.positions[static_cast<std::size_t> (ring[i])];
    shape.normals[i] = vertices.normals[static_cast<std::size_t> (ring[i])];
  }
  LoopTriangles corners;
  if (!triangulateLoop (shape, corners))
    return false;
  for (std::size_t i = 0; i < static_cast<std::size_t> (corners.count); ++i)
  {
    const Triangle &t = corners.corners[i];
    triangles.push_back ({ring[t[0]], ring[t[1]], ring[t[2]]});
  }
  return true;
}

/** \brief Meshes the cells of one stretch. */
class CellMesher
{
public:
  CellMesher (const SparseGrid &grid, const SurfaceVertices &vertices) : window_ (grid), vertices_ (vertices) {}

  void
  mesh (const GridPoint &cell, CellMesh &mesh)
  {
    window_.moveTo (cell);
    const CellLoops loops = traceLoops (window_.cornerValues (cell));
    for (std::size_t l = 0; l < loops.count; ++l)
    {
      edges_ = loops.edges[l];
      size_ = loops.lengths[l];
      for (std::size_t i = 0; i < size_; ++i)
      {
        const CellEdge edge = cellEdge (edges_[i]);
        ring_[i] = window_.vertexOnEdge (cell + cornerOffset (edge.corner), edge.axis);
      }
      if (mayHaveCrease ())
        mesh.mixed_loops.push_back ({{ring_.begin (), ring_.begin () + size_}, edges_});
      else if (!triangulateRing (ring_.data (), size_, edges_, vertices_, mesh.triangles))
        mesh.centered_loops.push_back ({{ring_.begin (), ring_.begin () + size_}, edges_});
      findBorder (cell, mesh.border);
    }
  }

private:
  /** \brief Whether neighbours lie on different sides of sharp surfaces, and do not look the same way. */
  bool
  mayHaveCrease () const
  {
    for (std::size_t i = 0; i < (vertices_.has_sides ? size_ : 0); ++i)
    {
      const auto a = static_cast<std::size_t> (ring_[i]), b = static_cast<std::size_t> (ring_[(i + 1) % size_]);
      if (vertices_.side_keys[a] != vertices_.side_keys[b] && mayCrease (vertices_.normals[a], vertices_.normals[b]))
        return true;
    }
    return false;
  }

  /** \brief The sides of the loop in faces whose other cell has no surface. */
  void
  findBorder (const GridPoint &cell, std::vector<int> &border)
  {
    for (std::size_t i = 0; i < size_; ++i)
    {
      const std::size_t next = i + 1 < size_ ? i + 1 : 0;
      const int face = commonFace (edges_[i], edges_[next]), step = face & 1 ? 1 : -1;
      const GridPoint across{cell.x + (face / 2 == 0 ? step : 0), cell.y + (face / 2 == 1 ? step : 0),
                             cell.z + (face / 2 == 2 ? step : 0)};
      if (!window_.isActive (across))
        border.insert (border.end (), {ring_[i], ring_[next]});
    }
  }

  GridWindow window_;
  const SurfaceVertices &vertices_;
  std::array<int, 12> ring_{}; // of the loop at hand
  LoopEdges edges_{};
  std::size_t size_ = 0;
};

} // namespace

bool
triangulateCell (const CellLoop &loop, const SurfaceVertices &vertices, std::vector<Triangle> &triangles)
{
  return triangulateRing (loop.ring.data (), loop.ring.size (), loop.edges, vertices, triangles);
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
  constexpr std::size_t STRETCH = 4096;
  const std::size_t count = (cells.size () + STRETCH - 1) / STRETCH;
  std::vector<std::vector<Triangle>> triangles (count);
  std::vector<std::vector<CellLoop>> centered (count), mixed (count);
  std::vector<std::vector<int>> border (count);
  parallelFor (
      count, threads, [] { return 0; },
      [&] (int, std::size_t i)
      {
        CellMesher mesher (grid, vertices);
        CellMesh part;
        part.triangles.reserve (2 * STRETCH + STRETCH / 2);
        for (std::size_t c = i * STRETCH; c < std::min (cells.size (), (i + 1) * STRETCH); ++c)
          mesher.mesh (cells[c], part);
        triangles[i].swap (part.triangles);
        centered[i].swap (part.centered_loops);
        mixed[i].swap (part.mixed_loops);
        border[i].swap (part.border);
      });
  CellMesh mesh;
  mesh.centered_loops = joinParts (std::move (centered), threads);
  mesh.mixed_loops = joinParts (std::move (mixed), threads);
  constexpr double SPARE = 0.15; // those of loops that are meshed later on
  mesh.triangles = joinParts (std::move (triangles), threads, mesh.mixed_loops.empty () ? 0.0 : SPARE);
  mesh.border = joinParts (std::move (border), threads);
  return mesh;
}

} // namespace erkpa
