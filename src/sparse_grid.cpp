// SPDX-License-Identifier: BSD-3-Clause
#include "sparse_grid.h"

#include <cmath>

namespace erkpa
{

namespace
{

int
countBits (std::uint64_t bits)
{
  return __builtin_popcountll (bits);
}

std::vector<BlockPart>
makeParts (int side)
{
  std::vector<BlockPart> parts;
  for (int z = 0; z < GridBlock::SIDE; z += side)
    for (int y = 0; y < GridBlock::SIDE; y += side)
      for (int x = 0; x < GridBlock::SIDE; x += side)
      {
        BlockPart part{0, {x, y, z}, side};
        for (int node = 0; node < GridBlock::NODES; ++node)
          if ((node & 3) / side == x / side && ((node >> 2) & 3) / side == y / side && (node >> 4) / side == z / side)
            part.nodes |= std::uint64_t (1) << node;
        parts.push_back (part);
      }
  return parts;
}

} // namespace

const std::vector<BlockPart> &
partsOfBlock (double support)
{
  static const std::array<std::vector<BlockPart>, 3> PARTS{makeParts (1), makeParts (2), makeParts (4)};
  return PARTS[support > 2.5 ? 2 : support > 1.0 ? 1 : 0];
}

GridPoint
SparseGrid::cellOf (const Eigen::Vector3d &position) const
{
  const Eigen::Vector3d p = (position - origin_) / voxel_size_;
  return {static_cast<int> (std::floor (p[0])), static_cast<int> (std::floor (p[1])),
          static_cast<int> (std::floor (p[2]))};
}

std::uint64_t
SparseGrid::keyOf (const GridPoint &point)
{
  // Arithmetic shifts round towards minus infinity, so that blocks tile negative coordinates too.
  const auto part = [] (int v) { return static_cast<std::uint64_t> (v >> 2) + (std::uint64_t (1) << 20); };
  return part (point.x) | (part (point.y) << 21) | (part (point.z) << 42);
}

GridPlace
SparseGrid::place (const GridPoint &point)
{
  const auto [entry, is_new] = index_.try_emplace (keyOf (point), blockCount ());
  if (is_new)
  {
    blocks_.emplace_back ();
    blocks_.back ().first = {point.x & ~3, point.y & ~3, point.z & ~3};
  }
  return {entry->second, localOf (point)};
}

GridPlace
SparseGrid::find (const GridPoint &point) const
{
  const auto entry = index_.find (keyOf (point));
  return {entry == index_.end () ? -1 : entry->second, localOf (point)};
}

std::array<double, 8>
SparseGrid::cornerValues (const GridPoint &cell) const
{
  std::array<double, 8> values;
  const GridPlace lowest = find (cell);
  const bool inside = (cell.x & 3) < 3 && (cell.y & 3) < 3 && (cell.z & 3) < 3;
  for (int corner = 0; corner < 8; ++corner)
  {
    const GridPoint offset = cornerOffset (corner);
    const GridPlace place =
        inside ? GridPlace{lowest.block, lowest.local + offset.x + 4 * offset.y + 16 * offset.z} : find (cell + offset);
    values[static_cast<std::size_t> (corner)] = block (place.block).values[static_cast<std::size_t> (place.local)];
  }
  return values;
}

bool
SparseGrid::isNear (const GridPoint &cell) const
{
  for (int corner = 0; corner < 8; ++corner)
  {
    const GridPlace place = find (cell + cornerOffset (corner));
    if (block (place.block).near & place.bit ())
      return true;
  }
  return false;
}

int
SparseGrid::numberVertices ()
{
  int count = 0;
  for (GridBlock &block : blocks_)
  {
    block.first_vertex = count;
    for (const std::uint64_t bits : block.cut)
      count += countBits (bits);
  }
  return count;
}

int
SparseGrid::vertexOnEdge (const GridBlock &block, int node, int axis)
{
  int vertex = block.first_vertex;
  for (int a = 0; a < axis; ++a)
    vertex += countBits (block.cut[static_cast<std::size_t> (a)]);
  return vertex + countBits (block.cut[static_cast<std::size_t> (axis)] & ((std::uint64_t (1) << node) - 1));
}

} // namespace erkpa
