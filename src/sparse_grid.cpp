// SPDX-License-Identifier: BSD-3-Clause
#include "sparse_grid.h"

#include "grid_bits.h"

namespace erkpa
{

namespace
{

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
  return PARTS[support > 1.0 ? 2 : support > 0.4 ? 1 : 0];
}

GridPoint
SparseGrid::cellOf (const Eigen::Vector3d &position) const
{
  const Eigen::Vector3d p = (position - origin_) * cells_per_length_;
  const auto floored = [] (double v)
  {
    const int towards_zero = static_cast<int> (v);
    return towards_zero - (v < static_cast<double> (towards_zero) ? 1 : 0);
  };
  return {floored (p[0]), floored (p[1]), floored (p[2])};
}

std::uint64_t
SparseGrid::keyOf (const GridPoint &point)
{
  // Arithmetic shifts round towards minus infinity, so that blocks tile negative coordinates too.
  const auto part = [] (int v) { return static_cast<std::uint64_t> (v >> 2) + (std::uint64_t (1) << 20); };
  return part (point.x) | (part (point.y) << 21) | (part (point.z) << 42);
}

int
SparseGrid::placeBlock (const GridPoint &first)
{
  const auto [entry, is_new] = index_.try_emplace (keyOf (first), blockCount ());
  if (is_new)
  {
    if (static_cast<std::size_t> (block_count_) == CHUNK * chunks_.size ())
      chunks_.emplace_back ().reserve (CHUNK);
    ++block_count_;
    GridBlock &made = chunks_.back ().emplace_back ();
    made.first = first;
    made.above.fill (-1);
    made.below.fill (-1);
    made.above[0] = entry->second;
  }
  return entry->second;
}

int
SparseGrid::placeAbove (int block, int axes)
{
  const auto i = static_cast<std::size_t> (axes);
  const int known = this->block (block).above[i];
  if (known >= 0)
    return known;
  const GridPoint offset = cornerOffset (axes), by{4 * offset.x, 4 * offset.y, 4 * offset.z};
  const int made = placeBlock (this->block (block).first + by);
  this->block (block).above[i] = made;
  if ((axes & (axes - 1)) == 0) // one axis: the way back is known, too
    this->block (made).below[i / 2] = block;
  return made;
}

int
SparseGrid::placeBelow (int block, int axis)
{
  const auto i = static_cast<std::size_t> (axis);
  const int known = this->block (block).below[i];
  if (known >= 0)
    return known;
  const GridPoint by{axis == 0 ? -4 : 0, axis == 1 ? -4 : 0, axis == 2 ? -4 : 0};
  const int made = placeBlock (this->block (block).first + by);
  this->block (block).below[i] = made;
  this->block (made).above[std::size_t (1) << i] = block;
  return made;
}

GridPlace
SparseGrid::find (const GridPoint &point) const
{
  const auto entry = index_.find (keyOf (point));
  return {entry == index_.end () ? -1 : entry->second, localOf (point)};
}

GridPlace
SparseGrid::step (const GridPlace &from, int step) const
{
  // The coordinates with a bit between them, into which goes what leaves the block.
  const int l = from.local, spread = (l & 3) | (l & 12) << 1 | (l & 48) << 2;
  const int sum = spread + ((step & 1) | (step & 2) << 2 | (step & 4) << 4);
  const int over = (sum >> 2 & 1) | (sum >> 4 & 2) | (sum >> 6 & 4);
  const int local = (sum & 3) | (sum >> 1 & 12) | (sum >> 2 & 48);
  if (over == 0)
    return {from.block, local};
  const GridBlock &origin = block (from.block);
  const int next = origin.above[static_cast<std::size_t> (over)];
  return next >= 0 ? GridPlace{next, local} : find (pointAt (origin, from.local) + cornerOffset (step));
}

std::array<double, 8>
SparseGrid::cornerValues (const GridPlace &cell) const
{
  std::array<double, 8> values;
  for (int corner = 0; corner < 8; ++corner)
  {
    const GridPlace place = step (cell, corner);
    values[static_cast<std::size_t> (corner)] =
        static_cast<double> (block (place.block).values[static_cast<std::size_t> (place.local)]);
  }
  return values;
}

void
SparseGrid::markCutEdges ()
{
  const int blocks = blockCount (); // all corners of active cells have theirs
  for (int index = 0; index < blocks; ++index)
  {
    const std::uint64_t active = block (index).active;
    for (int axis = 0; axis < 3 && active != 0; ++axis)
    {
      const auto nodes = grid_bits::cornersOf (active, 7 ^ 1 << axis);
      for (int above = 0; above < 8; ++above)
        if (nodes[static_cast<std::size_t> (above)] != 0)
          block (placeAbove (index, above)).cut[static_cast<std::size_t> (axis)] |=
              nodes[static_cast<std::size_t> (above)];
    }
  }
  for (int index = 0; index < blocks; ++index)
    for (int axis = 0; axis < 3; ++axis)
    {
      GridBlock &block = this->block (index);
      std::uint64_t &cut = block.cut[static_cast<std::size_t> (axis)];
      std::uint64_t ends = grid_bits::down (block.inside, axis);
      if (cut & grid_bits::LAST[axis])
      {
        const int above = placeAbove (index, 1 << axis); // is there: see above
        ends |= grid_bits::intoBelow (this->block (above).inside, axis);
      }
      cut &= block.inside ^ ends;
    }
}

int
SparseGrid::numberVertices ()
{
  int count = 0;
  for (int index = 0; index < block_count_; ++index)
  {
    GridBlock &block = this->block (index);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      block.first_vertex[axis] = count;
      count += __builtin_popcountll (block.cut[axis]);
    }
  }
  return count;
}

} // namespace erkpa
