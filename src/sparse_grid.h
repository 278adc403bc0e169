// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "block_index.h"

#include <erkpa/large_pages.h>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace erkpa
{

/** \brief A grid node or cell by its integer coordinates; a cell is named by its lowest corner. */
struct GridPoint
{
  int x, y, z;

  GridPoint
  operator+ (const GridPoint &o) const
  {
    return {x + o.x, y + o.y, z + o.z};
  }

  bool
  operator== (const GridPoint &o) const
  {
    return x == o.x && y == o.y && z == o.z;
  }
};

/** \brief Corner 0..7 of a cell: bit 0 is x, bit 1 is y, bit 2 is z. */
inline GridPoint
cornerOffset (int corner)
{
  return {corner & 1, (corner >> 1) & 1, corner >> 2};
}

/** \brief Face 0..5 of a cell: that of the lower or of the higher coordinate along an axis. */
inline std::size_t
faceOf (int axis, int side)
{
  return 2 * static_cast<std::size_t> (axis) + static_cast<std::size_t> (side);
}

/** \brief 4 x 4 x 4 grid nodes and the cells that start at them; a bit per node or cell. */
struct GridBlock
{
  static constexpr int SIDE = 4;
  static constexpr int NODES = SIDE * SIDE * SIDE;

  GridPoint first;                    ///< lowest node
  std::array<int, 8> above;           ///< the blocks at + 4 along the axes of the bits; -1 where not looked for yet
  std::array<int, 3> below;           ///< those at - 4 along each axis, likewise
  std::array<int, 3> first_vertex{};  ///< index of the first vertex on its edges along each axis
  std::uint64_t known = 0;            ///< nodes whose value is there
  std::uint64_t needed = 0;           ///< nodes whose value is asked for
  std::uint64_t inside = 0;           ///< known nodes with f < iso
  std::uint64_t undefined = 0;        ///< known nodes where f is undefined
  std::uint64_t near = 0;             ///< known nodes that are in reach of the data, or sketched where it is
  std::uint64_t visited = 0;          ///< cells that were or will be looked at
  std::uint64_t next = 0;             ///< cells that will be looked at in the next front
  std::uint64_t fresh = 0;            ///< cells that are in this one
  std::uint64_t active = 0;           ///< cells that the surface crosses
  std::array<std::uint64_t, 3> cut{}; ///< per axis: edges from a node that carry a vertex
  std::array<float, NODES>
      values; ///< of known nodes: f - iso, or about that where it is sketched; NaN where f is undefined

  /** \brief Take up the value of a node. */
  void
  setValue (int node, float value, bool is_near)
  {
    const std::uint64_t bit = std::uint64_t (1) << node;
    values[static_cast<std::size_t> (node)] = value;
    inside |= value < 0.0f ? bit : 0;
    undefined |= value == value ? 0 : bit;
    near |= is_near ? bit : 0;
    known |= bit;
  }

  /** \brief Correct the value of a known node. */
  void
  setValueAgain (int node, float value)
  {
    const std::uint64_t bit = std::uint64_t (1) << node;
    values[static_cast<std::size_t> (node)] = value;
    inside = value < 0.0f ? inside | bit : inside & ~bit;
  }

  /** \brief Forget the values of all nodes. */
  void
  forget ()
  {
    known = inside = undefined = near = 0;
  }
};

/** \brief Where a node lies: block and place in it. */
struct GridPlace
{
  int block;
  int local;

  std::uint64_t
  bit () const
  {
    return std::uint64_t (1) << local;
  }
};

/** \brief The part of an unbounded grid that the surface passes, in blocks. */
class SparseGrid
{
public:
  /** \brief Largest coordinate in either direction. */
  static constexpr int LIMIT = (1 << 20) - 8;

  SparseGrid (const Eigen::Vector3d &origin, double voxel_size)
      : origin_ (origin), voxel_size_ (voxel_size), cells_per_length_ (1.0 / voxel_size)
  {
  }

  double
  voxelSize () const
  {
    return voxel_size_;
  }

  Eigen::Vector3d
  position (const GridPoint &node) const
  {
    return origin_ + voxel_size_ * Eigen::Vector3d (node.x, node.y, node.z);
  }

  /** \brief The cell that holds a position. */
  GridPoint
  cellOf (const Eigen::Vector3d &position) const;

  /** \brief The lowest node of the block of a node or cell. */
  static GridPoint
  blockOf (const GridPoint &point)
  {
    return {point.x & ~3, point.y & ~3, point.z & ~3};
  }

  /** \brief Its bit there. */
  static std::uint64_t
  bitOf (const GridPoint &point)
  {
    return std::uint64_t (1) << localOf (point);
  }

  /** \brief The block with a lowest node, which is made where it does not exist. */
  int
  placeBlock (const GridPoint &first);

  /** \brief The place of a node or cell; block < 0 where it does not exist. */
  GridPlace
  find (const GridPoint &point) const;

  /** \brief The place of the node or cell a step of 0 or 1 along each axis from a place (bits of \a step). */
  GridPlace
  step (const GridPlace &from, int step) const;

  /** \brief The block next to a block in the direction of the axes' bits, which is made where it does not exist. */
  int
  placeAbove (int block, int axes);

  /** \brief The same against one axis. */
  int
  placeBelow (int block, int axis);

  GridBlock &
  block (int index)
  {
    return chunks_[static_cast<std::size_t> (index) / CHUNK][static_cast<std::size_t> (index) % CHUNK];
  }

  const GridBlock &
  block (int index) const
  {
    return chunks_[static_cast<std::size_t> (index) / CHUNK][static_cast<std::size_t> (index) % CHUNK];
  }

  int
  blockCount () const
  {
    return block_count_;
  }

  /** \brief The node or cell at a place of a block. */
  static GridPoint
  pointAt (const GridBlock &block, int local)
  {
    return {block.first.x + (local & 3), block.first.y + ((local >> 2) & 3), block.first.z + (local >> 4)};
  }

  bool
  isActive (const GridPoint &cell) const
  {
    const GridPlace place = find (cell);
    return place.block >= 0 && (block (place.block).active & place.bit ()) != 0;
  }

  /** \brief Values at the 8 corners of a cell whose corners are known. */
  std::array<double, 8>
  cornerValues (const GridPoint &cell) const
  {
    return cornerValues (find (cell));
  }

  std::array<double, 8>
  cornerValues (const GridPlace &cell) const;

  /** \brief Mark the edges of active cells on which the values change their sign: they carry the vertices. */
  void
  markCutEdges (int threads);

  /** \brief Number the cut edges, block after block; returns how many there are. */
  int
  numberVertices ();

  /** \brief The vertex on the edge from \a node along \a axis; the edge must be cut. */
  int
  vertexOnEdge (const GridPoint &node, int axis) const
  {
    const GridPlace place = find (node);
    return vertexOnEdge (block (place.block), place.local, axis);
  }

  /** \brief The same on the edge along \a axis that starts at a corner of a cell. */
  int
  vertexOnEdge (const GridPlace &cell, int corner, int axis) const
  {
    const GridPlace node = step (cell, corner);
    return vertexOnEdge (block (node.block), node.local, axis);
  }

  static int
  vertexOnEdge (const GridBlock &block, int node, int axis)
  {
    const std::uint64_t before = block.cut[static_cast<std::size_t> (axis)] & ((std::uint64_t (1) << node) - 1);
    return block.first_vertex[static_cast<std::size_t> (axis)] + __builtin_popcountll (before);
  }

private:
  void
  markEdgesOf (const GridBlock &from);

  int
  blockAbove (const GridBlock &block, int axis) const;

  static constexpr std::size_t CHUNK = 4096; // blocks

  static std::uint64_t
  keyOf (const GridPoint &point);

  static int
  localOf (const GridPoint &point)
  {
    return (point.x & 3) | ((point.y & 3) << 2) | ((point.z & 3) << 4);
  }

  Eigen::Vector3d origin_;
  double voxel_size_, cells_per_length_;
  int block_count_ = 0;
  std::vector<LargeVector<GridBlock>> chunks_; // of a fixed size: blocks stay where they are when others are made
  BlockIndex index_;
};

/** \brief A cube of nodes of a block that share one gathering of the field's nodes. */
struct BlockPart
{
  std::uint64_t nodes; ///< its nodes, as bits
  GridPoint first;     ///< lowest of them, in the block
  int side;            ///< nodes along a side: 1, 2 or 4
};

/** \brief The parts of a block, not much larger than the support: larger ones would gather nodes in vain.
 * \param[in] support typical support radius, in voxels
 */
const std::vector<BlockPart> &
partsOfBlock (double support);

} // namespace erkpa
