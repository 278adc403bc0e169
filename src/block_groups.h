// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sparse_grid.h"

#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief Blocks of a grid that share one gathering of the field's nodes. */
class BlockGroups
{
public:
  static constexpr int CUBE = 2; ///< blocks along the side of a cube

  /** \brief Whether supports are so large beside voxels that the blocks in a cube share a gathering. */
  static bool
  areCubes (double support)
  {
    constexpr double LARGE = 16.0; // voxels
    return support > LARGE;
  }

  /** \brief The lowest node of the cube of a node. */
  static GridPoint
  cubeOf (const GridPoint &point)
  {
    constexpr int MASK = ~(CUBE * GridBlock::SIDE - 1);
    return {point.x & MASK, point.y & MASK, point.z & MASK};
  }

  /** \brief Each block is a group of its own; where supports are far larger than blocks, those in a cube are one.
   * \param[in] blocks indices in the grid
   * \param[in] support typical support radius, in voxels
   */
  BlockGroups (const SparseGrid &grid, std::vector<int> blocks, double support);

  std::size_t
  size () const
  {
    return firsts_.size () - 1;
  }

  /** \brief The blocks of a group. */
  const int *
  begin (std::size_t group) const
  {
    return blocks_.data () + firsts_[group];
  }

  const int *
  end (std::size_t group) const
  {
    return blocks_.data () + firsts_[group + 1];
  }

private:
  std::vector<int> blocks_;
  std::vector<std::size_t> firsts_; // per group, and one more
};

} // namespace erkpa
