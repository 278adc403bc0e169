// SPDX-License-Identifier: BSD-3-Clause
//
// Where SurfaceTracker starts: at the nodes, beside them, and at their feet on the surface where that runs elsewhere.
#include "surface_tracking.h"

#include "grid_bits.h"
#include "node_table.h"
#include "parallel_collect.h"
#include "surface_feet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief Cells of a block. */
struct BlockCells
{
  GridPoint first; ///< the lowest of the block
  std::uint64_t cells;
};

/** \brief Collects cells, block by block; a block may come more than once. */
class SeedBlocks
{
public:
  using Array = LargeVector<BlockCells>;

  explicit SeedBlocks (Array &blocks) : blocks_ (blocks) {}

  /** \brief Add a cell and those beyond some of its faces, as bits. */
  void
  add (const GridPoint &cell, unsigned faces)
  {
    const GridPoint first = SparseGrid::blockOf (cell);
    const std::uint64_t bit = SparseGrid::bitOf (cell);
    std::uint64_t cells = bit;
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool goes_down = (faces >> faceOf (axis, 0) & 1U) != 0, goes_up = (faces >> faceOf (axis, 1) & 1U) != 0;
      cells |= goes_down ? grid_bits::down (bit, axis) : 0;
      cells |= goes_up ? grid_bits::up (bit, axis) : 0;
      const GridPoint by{axis == 0 ? 4 : 0, axis == 1 ? 4 : 0, axis == 2 ? 4 : 0};
      if (goes_down && (bit & grid_bits::FIRST[axis]) != 0)
        addTo (first + GridPoint{-by.x, -by.y, -by.z}, grid_bits::intoBelow (bit, axis));
      if (goes_up && (bit & grid_bits::LAST[axis]) != 0)
        addTo (first + by, grid_bits::intoAbove (bit, axis));
    }
    addTo (first, cells);
  }

private:
  static constexpr int SLOTS = 8; // along each axis

  void
  addTo (const GridPoint &first, std::uint64_t cells)
  {
    const auto slot_along = [] (int v) { return static_cast<std::size_t> (v / GridBlock::SIDE & (SLOTS - 1)); };
    std::uint32_t &slot = slots_[slot_along (first.x) + SLOTS * (slot_along (first.y) + SLOTS * slot_along (first.z))];
    if (slot >= blocks_.size () || !(blocks_[slot].first == first))
    {
      slot = static_cast<std::uint32_t> (blocks_.size ());
      blocks_.push_back ({first, 0});
    }
    blocks_[slot].cells |= cells;
  }

  Array &blocks_;
  /** \brief Per place modulo SLOTS the block seen last. */
  std::array<std::uint32_t, std::size_t (SLOTS) * SLOTS * SLOTS> slots_{};
};

} // namespace

GridPoint
SurfaceTracker::cellOfPlace (std::size_t place) const
{
  const PointGrid &nodes = *field_.nodeTable ().grid;
  if (field_.options ().warp)
    return grid_.cellOf (field_.surfacePositions ()[nodes.index ()[place]].cast<double> ());
  return grid_.cellOf ({nodes.coordinates (0)[place], nodes.coordinates (1)[place], nodes.coordinates (2)[place]});
}

unsigned
SurfaceTracker::facesOfPlane (std::size_t place, const GridPoint &cell) const
{
  if (field_.options ().warp)
    return 0; // normals are those of the space that is not warped
  const NodeTable &nodes = field_.nodeTable ();
  const Eigen::Vector3d n (nodes.normals[0][place], nodes.normals[1][place], nodes.normals[2][place]);
  const Eigen::Vector3d x (nodes.grid->coordinates (0)[place], nodes.grid->coordinates (1)[place],
                           nodes.grid->coordinates (2)[place]);
  const double height = n.dot (grid_.position (cell) - x) / grid_.voxelSize () + 0.5 * n.sum (); // of its middle
  const double across = 0.5 * n.lpNorm<1> ();
  unsigned faces = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, 1})
      faces |= std::abs (height + (2 * side - 1) * n[axis]) < across ? 1U << faceOf (axis, side) : 0U;
  return faces;
}

void
SurfaceTracker::seedFromNodes ()
{
  const auto found =
      parallelCollect<SeedBlocks::Array> (nodeCount (), options_.threads,
                                          [this] (std::size_t first, std::size_t last, SeedBlocks::Array &blocks)
                                          {
                                            SeedBlocks seeds (blocks);
                                            for (std::size_t i = first; i < last; ++i)
                                            {
                                              const GridPoint cell = cellOfPlace (i);
                                              seeds.add (cell, facesOfPlane (i, cell));
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
  const std::vector<char> has_foot = findFeet (field_, options_, grid_.voxelSize (), lattice_, feet, report_);
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
