// SPDX-License-Identifier: BSD-3-Clause
#include "cell_mesher.h"

#include "crease_turn.h"
#include "grid_bits.h"
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
                 LargeVector<Triangle> &triangles)
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

/** \brief Meshes the active cells of blocks. */
class CellMesher
{
public:
  CellMesher (const SparseGrid &grid, const SurfaceVertices &vertices) : grid_ (grid), vertices_ (vertices) {}

  void
  meshBlock (int index, CellMesh &mesh)
  {
    const GridBlock &block = grid_.block (index);
    if (block.active == 0)
      return;
    std::array<std::uint64_t, 8> inside{};
    for (std::size_t above = 0; above < 8; ++above)
      if (block.above[above] >= 0)
        inside[above] = grid_.block (block.above[above]).inside;
    inside = grid_bits::atCorners (inside);
    findActiveBeyond (block);
    for (std::uint64_t left = block.active; left != 0; left &= left - 1)
    {
      const GridPlace cell{index, __builtin_ctzll (left)};
      std::size_t corners = 0;
      for (std::size_t corner = 0; corner < 8; ++corner)
        corners |= static_cast<std::size_t> (inside[corner] >> cell.local & 1) << corner;
      meshCell (cell, corners, mesh);
    }
  }

private:
  /** \brief Those cells of a block beyond whose faces the cells are active, too. */
  void
  findActiveBeyond (const GridBlock &block)
  {
    const auto active_in = [this] (int other) { return other >= 0 ? grid_.block (other).active : 0; };
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto a = static_cast<std::size_t> (axis);
      int below = block.below[a];
      if (below < 0 && (block.active & grid_bits::FIRST[axis]) != 0)
        below = grid_.find (block.first + GridPoint{axis == 0 ? -4 : 0, axis == 1 ? -4 : 0, axis == 2 ? -4 : 0}).block;
      active_beyond_[2 * a] = grid_bits::up (block.active, axis) | grid_bits::intoAbove (active_in (below), axis);
      active_beyond_[2 * a + 1] = grid_bits::down (block.active, axis) |
                                  grid_bits::intoBelow (active_in (block.above[std::size_t (1) << a]), axis);
    }
  }

  void
  meshCell (const GridPlace &cell, std::size_t inside, CellMesh &mesh)
  {
    CellLoops traced;
    const CellLoops *loops = loopsOfSigns (inside);
    if (loops == nullptr)
    {
      traced = traceLoops (grid_.cornerValues (cell));
      loops = &traced;
    }
    for (std::size_t l = 0; l < loops->count; ++l)
    {
      const LoopEdges &edges = loops->edges[l];
      size_ = loops->lengths[l];
      for (std::size_t i = 0; i < size_; ++i)
      {
        const CellEdge edge = cellEdge (edges[i]);
        ring_[i] = grid_.vertexOnEdge (cell, edge.corner, edge.axis);
      }
      if (mayHaveCrease ())
        mesh.mixed_loops.push_back ({{ring_.begin (), ring_.begin () + size_}, edges});
      else if (!triangulateRing (ring_.data (), size_, edges, vertices_, mesh.triangles))
        mesh.centered_loops.push_back ({{ring_.begin (), ring_.begin () + size_}, edges});
      findBorder (cell, edges, mesh.border);
    }
  }

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
  findBorder (const GridPlace &cell, const LoopEdges &edges, LargeVector<int> &border) const
  {
    for (std::size_t i = 0; i < size_; ++i)
    {
      const std::size_t next = i + 1 < size_ ? i + 1 : 0;
      const auto face = static_cast<std::size_t> (commonFace (edges[i], edges[next]));
      if ((active_beyond_[face] & cell.bit ()) == 0)
        border.insert (border.end (), {ring_[i], ring_[next]});
    }
  }

  const SparseGrid &grid_;
  const SurfaceVertices &vertices_;
  std::array<std::uint64_t, 6> active_beyond_{}; // per face
  std::array<int, 12> ring_{};                   // of the loop at hand
  std::size_t size_ = 0;
};

} // namespace

bool
triangulateCell (const CellLoop &loop, const SurfaceVertices &vertices, LargeVector<Triangle> &triangles)
{
  return triangulateRing (loop.ring.data (), loop.ring.size (), loop.edges, vertices, triangles);
}

void
addFan (const std::vector<int> &ring, int center, LargeVector<Triangle> &triangles)
{
  for (std::size_t i = 0; i < ring.size (); ++i)
    triangles.push_back ({ring[i], ring[(i + 1) % ring.size ()], center});
}

CellMesh
meshCells (const SparseGrid &grid, int threads, const SurfaceVertices &vertices)
{
  constexpr std::size_t STRETCH = 256, TRIANGLES = 40; // blocks, and what many of them have
  const auto blocks = static_cast<std::size_t> (grid.blockCount ());
  const std::size_t count = (blocks + STRETCH - 1) / STRETCH;
  std::vector<LargeVector<Triangle>> triangles (count);
  std::vector<LargeVector<CellLoop>> centered (count), mixed (count);
  std::vector<LargeVector<int>> border (count);
  parallelFor (
      count, threads, [] { return 0; },
      [&] (int, std::size_t i)
      {
        CellMesher mesher (grid, vertices);
        CellMesh part;
        part.triangles.reserve (STRETCH * TRIANGLES);
        for (std::size_t index = i * STRETCH; index < std::min (blocks, (i + 1) * STRETCH); ++index)
          mesher.meshBlock (static_cast<int> (index), part);
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
