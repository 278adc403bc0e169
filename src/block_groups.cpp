// SPDX-License-Identifier: BSD-3-Clause
#include "block_groups.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace erkpa
{

BlockGroups::BlockGroups (const SparseGrid &grid, std::vector<int> blocks, double support)
    : blocks_ (std::move (blocks))
{
  if (!areCubes (support))
  {
    firsts_.resize (blocks_.size () + 1);
    std::iota (firsts_.begin (), firsts_.end (), 0);
    return;
  }
  using Cube = std::array<int, 3>;
  std::vector<std::pair<Cube, int>> sorted;
  for (const int block : blocks_)
  {
    const GridPoint cube = cubeOf (grid.block (block).first);
    sorted.push_back ({{cube.z, cube.y, cube.x}, block});
  }
  std::sort (sorted.begin (), sorted.end ());
  for (std::size_t i = 0; i < sorted.size (); ++i)
  {
    if (i == 0 || sorted[i].first != sorted[i - 1].first)
      firsts_.push_back (i);
    blocks_[i] = sorted[i].second;
  }
  firsts_.push_back (sorted.size ());
}

} // namespace erkpa
