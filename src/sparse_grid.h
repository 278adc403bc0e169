// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <unordered_map>
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
};

/** \brief 4 x 4 x 4 grid nodes and the cells that start at them; a bit per node or cell. */
struct GridBlock
{
  static constexpr int SIDE = 4;
  static constexpr int NODES = SIDE * SIDE * SIDE;

  GridPoint first;                    ///< lowest node
  std::uint64_t known = 0;            ///< nodes whose value is there
  std::uint64_t needed = 0;           ///< nodes whose value is asked for
  std::uint64_t near = 0;             ///< known nodes that are in reach of the data
  std::uint64_t visited = 0;          ///< cells that were or will be looked at
  std::uint64_t active = 0;           ///< cells that the surface crosses
  std::array<std::uint64_t, 3> cut{}; ///< per axis: edges from a node that carry a vertex
  int first_vertex = 0;               ///< index of the block's first vertex
  std::array<double, NODES> values{}; ///< f - iso, NaN where f is undefined
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

  SparseGrid (const Eigen::Vector3d &origin, double voxel_size) : origin_ (origin), voxel_size_ (voxel_size) {}

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

  /** \brief The place of a node or cell; its block is made where it does not exist. */
  GridPlace
  place (const GridPoint &point);

  /** \brief The place of a node or cell; block < 0 where it does not exist. */
  GridPlace
  find (const GridPoint &point) const;

  GridBlock &
  block (int index)
  {
    return blocks_[static_cast<std::size_t> (index)];
  }

  const GridBlock &
  block (int index) const
  {
    return blocks_[static_cast<std::size_t> (index)];
  }

  int
  blockCount () const
  {
    return static_cast<int> (blocks_.size ());
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
  cornerValues (const GridPoint &cell) const;

  /** \brief Whether a corner of a cell is in reach of the data. */
  bool
  isNear (const GridPoint &cell) const;

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

  static int
  vertexOnEdge (const GridBlock &block, int node, int axis);

private:
  static std::uint64_t
  keyOf (const GridPoint &point);

  static int
  localOf (const GridPoint &point)
  {
    return (point.x & 3) | ((point.y & 3) << 2) | ((point.z & 3) << 4);
  }

  Eigen::Vector3d origin_;
  double voxel_size_;
  std::vector<GridBlock> blocks_;
  std::unordered_map<std::uint64_t, int> index_;
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

/** \brief Corner 0..7 of a cell: bit 0 is x, bit 1 is y, bit 2 is z. */
inline GridPoint
cornerOffset (int corner)
{
  return {corner & 1, (corner >> 1) & 1, corner >> 2};
}

} // namespace erkpa
