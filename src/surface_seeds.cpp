// SPDX-License-Identifier: BSD-3-Clause
//
// Where SurfaceTracker starts: at the nodes, and at their feet on the surface where that runs elsewhere.
#include "surface_tracking.h"

#include "node_table.h"
#include "parallel_collect.h"
#include "surface_feet.h"

#include <algorithm>
#include <utility>

namespace erkpa
{

GridPoint
SurfaceTracker::cellOfPlace (std::size_t place) const
{
  const PointGrid &nodes = *field_.nodeTable ().grid;
  if (field_.options ().warp)
    return grid_.cellOf (field_.surfacePositions ()[nodes.index ()[place]].cast<double> ());
  return grid_.cellOf ({nodes.coordinates (0)[place], nodes.coordinates (1)[place], nodes.coordinates (2)[place]});
}

void
SurfaceTracker::seedFromNodes ()
{
  struct BlockCells
  {
    GridPoint first;
    std::uint64_t cells;
  };
  const auto found = parallelCollect<LargeVector<BlockCells>> (
      nodeCount (), options_.threads,
      [this] (std::size_t first, std::size_t last, LargeVector<BlockCells> &blocks)
      {
        for (std::size_t i = first; i < last; ++i)
        {
          const GridPoint cell = cellOfPlace (i);
          const GridPoint block = SparseGrid::blockOf (cell);
          // A few blocks take turns.
          constexpr std::size_t RECENT = 8;
          const auto oldest = blocks.end () - static_cast<std::ptrdiff_t> (std::min (RECENT, blocks.size ()));
          auto known = std::find_if (oldest, blocks.end (), [&] (const BlockCells &b) { return b.first == block; });
          if (known == blocks.end ())
            known = blocks.insert (known, {block, 0});
          known->cells |= SparseGrid::bitOf (cell);
        }
      });
  for (const BlockCells &block : found)
    addToFront (block.first, block.cells);
}

bool
SurfaceTracker::findCellNear (GridWindow &window, const GridPoint &cell, GridPoint &found)
{
  found = cell;
  window.moveTo (cell);
  if (!window.exists ())
    return false;
  if (window.isActive (cell))
    return true;
  for (const int dx : {0, -1, 1})
    for (const int dy : {0, -1, 1})
      for (const int dz : {0, -1, 1})
      {
        found = cell + GridPoint{dx, dy, dz};
        if (window.isActive (found))
          return true;
      }
  return false;
}

bool
SurfaceTracker::findCellOfNode (GridWindow &window, std::size_t node, GridPoint &found) const
{
  if (findCellNear (window, grid_.cellOf (field_.surfacePositions ()[node].cast<double> ()), found))
    return true;
  const auto before = [] (const std::pair<std::size_t, GridPoint> &foot, std::size_t n) { return foot.first < n; };
  const auto foot = std::lower_bound (feet_.begin (), feet_.end (), node, before);
  if (foot == feet_.end () || foot->first != node)
    return false;
  found = foot->second;
  window.moveTo (found);
  return window.exists () && window.isActive (found);
}

/** \brief Where noise or smoothing moves the surface off a node, start at the foot of the node on the surface. */
void
SurfaceTracker::seedFromProjections ()
{
  const auto &positions = field_.surfacePositions ();
  const LargeVector<std::uint32_t> &order = field_.nodeTable ().grid->index ();
  const LargeVector<std::uint32_t> away = parallelCollect<LargeVector<std::uint32_t>> (
      order.size (), options_.threads,
      [&] (std::size_t first, std::size_t last, LargeVector<std::uint32_t> &missing)
      {
        GridWindow window (grid_);
        GridPoint found{};
        for (std::size_t i = first; i < last; ++i)
          if (!findCellNear (window, cellOfPlace (i), found))
            missing.push_back (order[i]);
      });
  std::vector<Eigen::Vector3d> feet;
  feet.reserve (away.size ());
  for (const std::uint32_t i : away)
    feet.push_back (positions[i].cast<double> ());
  const std::vector<char> has_foot = findFeet (field_, options_, grid_.voxelSize (), feet, report_);
  for (std::size_t i = 0; i < away.size (); ++i)
    if (has_foot[i])
    {
      feet_.emplace_back (away[i], grid_.cellOf (feet[i]));
      addToFront (feet_.back ().second);
    }
  const auto is_before = [] (const auto &a, const auto &b) { return a.first < b.first; };
  std::sort (feet_.begin (), feet_.end (), is_before);
}

} // namespace erkpa
