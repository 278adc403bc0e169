// SPDX-License-Identifier: BSD-3-Clause
#include "sparse_grid.h"

#include "grid_bits.h"
#include "threads.h"

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
  const auto [index, is_new] = index_.insert (keyOf (first), blockCount ());
  if (is_new)
  {
    if (static_cast<std::size_t> (block_count_) == CHUNK * chunks_.size ())
      chunks_.emplace_back ().reserve (CHUNK);
    ++block_count_;
    GridBlock &made = chunks_.back ().emplace_back ();
    made.first = first;
    made.above.fill (-1);
    made.below.fill (-1);
    made.above[0] = index;
  }
  return index;
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
  return {index_.find (keyOf (point)), localOf (point)};
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
SparseGrid::markCutEdges (int threads)
{
  constexpr std::size_t STRETCH = 1024;
  const auto for_blocks = [&] (auto visit)
  {
    parallelRanges (
        static_cast<std::size_t> (blockCount ()), threads,
        [&] (std::size_t first, std::size_t last)
        {
          for (std::size_t index = first; index < last; ++index)
            visit (block (static_cast<int> (index)));
        },
        STRETCH);
  };
  for_blocks ([this] (const GridBlock &block) { markEdgesOf (block); });
  for_blocks (
      [this] (GridBlock &block)
      {
        for (int axis = 0; axis < 3; ++axis)
        {
          std::uint64_t &cut = block.cut[static_cast<std::size_t> (axis)];
          std::uint64_t ends = grid_bits::down (block.inside, axis);
          if (cut & grid_bits::LAST[axis])
            ends |= grid_bits::intoBelow (this->block (blockAbove (block, axis)).inside, axis);
          cut &= block.inside ^ ends;
        }
      });
}

/** \brief The block beyond the last edges of a block along an axis, which is there if these are of active cells. */
int
SparseGrid::blockAbove (const GridBlock &block, int axis) const
{
  const int known = block.above[std::size_t (1) << axis];
  const GridPoint offset = cornerOffset (1 << axis), by{4 * offset.x, 4 * offset.y, 4 * offset.z};
  return known >= 0 ? known : find (block.first + by).block;
}

/** \brief Mark the edges of the active cells of a block, cut or not; blocks beside it may be marked by other threads.
 */
void
SparseGrid::markEdgesOf (const GridBlock &from)
{
  for (int axis = 0; axis < 3 && from.active != 0; ++axis)
  {
    const auto nodes = grid_bits::cornersOf (from.active, 7 ^ 1 << axis);
    for (std::size_t above = 0; above < 8; ++above)
      if (nodes[above] != 0) // the corners of active cells are known, and so are their blocks
        __atomic_fetch_or (&block (from.above[above]).cut[static_cast<std::size_t> (axis)], nodes[above],
                           __ATOMIC_RELAXED);
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
