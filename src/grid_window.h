// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sparse_grid.h"

#include <array>

namespace erkpa
{

/** \brief The blocks in and around that of a cell, each looked up once while the cells stay in one block. */
class GridWindow
{
public:
  explicit GridWindow (const SparseGrid &grid) : grid_ (grid)
  {
    blocks_.fill (UNKNOWN);
  }

  /** \brief Put the block of \a cell in the middle. */
  void
  moveTo (const GridPoint &cell)
  {
    const GridPoint first = SparseGrid::blockOf (cell);
    if (first == first_)
      return;
    first_ = first;
    blocks_.fill (UNKNOWN);
    blocks_[MIDDLE] = grid_.find (cell).block;
  }

  /** \brief Whether the block in the middle is one of the grid's. */
  bool
  exists () const
  {
    return blocks_[MIDDLE] >= 0;
  }

  /** \brief The place of a node or cell in or next to the block in the middle; block < 0 where it does not exist. */
  GridPlace
  find (const GridPoint &point)
  {
    const int x = point.x - first_.x + 4, y = point.y - first_.y + 4, z = point.z - first_.z + 4;
    const int place = (x >> 2) + 3 * (y >> 2) + 9 * (z >> 2);
    int &block = blocks_[static_cast<std::size_t> (place)];
    if (block == UNKNOWN)
      block = lookUp (point, {x >> 2, y >> 2, z >> 2});
    return {block, (x & 3) | (y & 3) << 2 | (z & 3) << 4};
  }

  bool
  isActive (const GridPoint &cell)
  {
    const GridPlace place = find (cell);
    return place.block >= 0 && (grid_.block (place.block).active & place.bit ()) != 0;
  }

private:
  static constexpr int UNKNOWN = -2;
  static constexpr std::size_t MIDDLE = 13;

  /** \brief The block of a point, 0, 1 or 2 blocks along each axis from the lowest one. */
  int
  lookUp (const GridPoint &point, const std::array<int, 3> &along) const
  {
    const GridBlock &middle = grid_.block (blocks_[MIDDLE]);
    int above = 0, below = 0, axis_below = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      above |= along[static_cast<std::size_t> (axis)] == 2 ? 1 << axis : 0;
      below += along[static_cast<std::size_t> (axis)] == 0 ? 1 : 0;
      axis_below = along[static_cast<std::size_t> (axis)] == 0 ? axis : axis_below;
    }
    int known = -1;
    if (below == 0)
      known = middle.above[static_cast<std::size_t> (above)];
    else if (below == 1 && above == 0)
      known = middle.below[static_cast<std::size_t> (axis_below)];
    return known >= 0 ? known : grid_.find (point).block;
  }

  const SparseGrid &grid_;
  GridPoint first_{1, 0, 0}; // no block begins here
  std::array<int, 27> blocks_;
};

} // namespace erkpa
