// SPDX-License-Identifier: BSD-3-Clause
#include "surface_tracking.h"

#include "block_evaluator.h"
#include "block_groups.h"
#include "grid_bits.h"
#include "moment_lattice.h"
#include "parallel_collect.h"
#include "threads.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace erkpa
{

namespace
{

constexpr std::size_t MAX_ACTIVE_CELLS = 100000000; // some 100 GB of grid and mesh

std::uint64_t
anyOf (const std::array<std::uint64_t, 8> &corners)
{
  std::uint64_t any = 0;
  for (const std::uint64_t corner : corners)
    any |= corner;
  return any;
}

std::uint64_t
everyOf (const std::array<std::uint64_t, 8> &corners)
{
  std::uint64_t every = ~std::uint64_t (0);
  for (const std::uint64_t corner : corners)
    every &= corner;
  return every;
}

} // namespace

SurfaceTracker::SurfaceTracker (const ImplicitField &field, const PolygonizerOptions &options, MomentLattice *lattice,
                                SparseGrid &grid, PolygonizerReport &report, ProgressCallback progress)
    : field_ (field), options_ (options), lattice_ (lattice), grid_ (grid), report_ (report),
      progress_ (std::move (progress))
{
}

Outcome
SurfaceTracker::track ()
{
  seedFromNodes ();
  followFront ();
  seedFromProjections ();
  followFront ();
  if (active_count_ > MAX_ACTIVE_CELLS)
    return {Status::GRID_TOO_FINE, "the surface crosses more than " + std::to_string (MAX_ACTIVE_CELLS) +
                                       " grid cells: use a larger voxel size or a lower resolution"};
  return {};
}

void
SurfaceTracker::addToFront (const GridPoint &cell)
{
  addToFront (SparseGrid::blockOf (cell), SparseGrid::bitOf (cell));
}

void
SurfaceTracker::addToFront (const GridPoint &first, std::uint64_t cells)
{
  const auto inside = [] (int v) { return v > -SparseGrid::LIMIT && v < SparseGrid::LIMIT; };
  if (inside (first.x) && inside (first.y) && inside (first.z))
    addToFront (grid_.placeBlock (first), cells);
}

void
SurfaceTracker::addToFront (int index, std::uint64_t cells)
{
  GridBlock &block = grid_.block (index);
  cells &= ~block.visited;
  if (cells == 0)
    return;
  if (block.next == 0)
    next_front_.push_back (index);
  block.visited |= cells;
  block.next |= cells;
}

void
SurfaceTracker::followFront ()
{
  while (!next_front_.empty () && active_count_ <= MAX_ACTIVE_CELLS)
  {
    std::swap (front_, next_front_);
    next_front_.clear ();
    for (const int block : front_)
    {
      grid_.block (block).fresh = std::exchange (grid_.block (block).next, 0);
      requestCorners (block);
    }
    evaluateRequested ();
    classifyFront ();
  }
}

void
SurfaceTracker::requestCorners (int block)
{
  const std::array<std::uint64_t, 8> corners = grid_bits::cornersOf (grid_.block (block).fresh);
  for (int above = 0; above < 8; ++above)
    if (corners[static_cast<std::size_t> (above)] != 0)
      request (grid_.placeAbove (block, above), corners[static_cast<std::size_t> (above)]);
}

void
SurfaceTracker::request (int index, std::uint64_t nodes)
{
  GridBlock &block = grid_.block (index);
  nodes &= ~(block.known | block.needed);
  if (nodes == 0)
    return;
  if (block.needed == 0)
    requested_blocks_.push_back (index);
  block.needed |= nodes;
}

/** \brief Have the cubes of requested blocks evaluated as a whole if nothing of them is known yet. */
void
SurfaceTracker::requestCubes ()
{
  std::vector<std::array<int, 3>> cubes;
  for (const int block : requested_blocks_)
  {
    const GridPoint cube = BlockGroups::cubeOf (grid_.block (block).first);
    cubes.push_back ({cube.z, cube.y, cube.x});
  }
  std::sort (cubes.begin (), cubes.end ());
  cubes.erase (std::unique (cubes.begin (), cubes.end ()), cubes.end ());
  for (const auto &[z, y, x] : cubes)
  {
    std::array<int, CubeSketch::OCTANTS> blocks{};
    std::uint64_t known = 0;
    for (std::size_t octant = 0; octant < blocks.size (); ++octant)
    {
      const GridPoint by = cornerOffset (static_cast<int> (octant));
      int &block = blocks[octant];
      block = grid_.placeBlock ({x + GridBlock::SIDE * by.x, y + GridBlock::SIDE * by.y, z + GridBlock::SIDE * by.z});
      known |= grid_.block (block).known;
    }
    for (const int block : blocks)
      if (known == 0 && grid_.block (block).needed == 0)
        requested_blocks_.push_back (block);
  }
}

void
SurfaceTracker::coverRequested ()
{
  using Cells = std::vector<MomentLattice::Cells>;
  constexpr std::size_t STRETCH = 1024;
  lattice_->cover (parallelCollect<Cells> (
      requested_blocks_.size (), options_.threads,
      [this] (std::size_t first, std::size_t last, Cells &cells)
      {
        for (std::size_t i = first; i < last; ++i)
        {
          const GridBlock &block = grid_.block (requested_blocks_[i]);
          for (std::uint64_t left = block.needed; left != 0; left &= left - 1)
            lattice_->listCell (grid_.position (SparseGrid::pointAt (block, __builtin_ctzll (left))), cells);
        }
      },
      STRETCH));
}

void
SurfaceTracker::evaluateRequested ()
{
  // The surface passes some 16 cells of a block. Where the nodes lie in few of them, the first front asks for little.
  constexpr std::size_t FEW = 8;
  if (evaluated_blocks_ == 0)
    foresees_ = lattice_ == nullptr && nodeCount () < FEW * requested_blocks_.size ();
  // A sketch spares sums over the nodes. What is interpolated has none.
  const bool sketches = lattice_ == nullptr && BlockEvaluator::canSketch (field_, grid_.voxelSize ());
  if (sketches)
    requestCubes ();
  if (lattice_ != nullptr)
    coverRequested ();
  const std::size_t block_count = requested_blocks_.size ();
  const BlockEvaluator evaluator (field_, options_, grid_, foresees_, sketches);
  const BlockGroups groups (grid_, std::move (requested_blocks_), field_.typicalRadius () / grid_.voxelSize ());
  // In slices, so that progress shows during the first front, which is the largest by far.
  constexpr std::size_t SLICE = 8192;
  for (std::size_t first = 0; first < groups.size (); first += SLICE)
  {
    const std::size_t last = std::min (first + SLICE, groups.size ());
    parallelFor (
        last - first, options_.threads, [this] { return GridField (field_, options_, grid_.voxelSize (), lattice_); },
        [&] (GridField &worker, std::size_t i)
        { evaluator.evaluate (worker, groups.begin (first + i), groups.end (first + i)); },
        [this] (const GridField &worker) { worker.addTo (report_); });
    const std::size_t evaluated = evaluated_blocks_ + block_count * last / groups.size ();
    if (progress_)
      progress_ (std::min (1.0, static_cast<double> (evaluated) / static_cast<double> (grid_.blockCount ())));
  }
  evaluated_blocks_ += block_count;
  requested_blocks_.clear ();
}

/** \brief Marks the crossed cells of the front and hands it on from them. */
void
SurfaceTracker::classifyFront ()
{
  std::vector<PassedFaces> passed (front_.size ());
  constexpr std::size_t STRETCH = 1024;
  parallelRanges (
      front_.size (), options_.threads,
      [&] (std::size_t first, std::size_t last)
      {
        for (std::size_t i = first; i < last; ++i)
          passed[i] = classify (front_[i]);
      },
      STRETCH);
  for (std::size_t i = 0; i < front_.size (); ++i)
  {
    const GridBlock &block = grid_.block (front_[i]);
    active_count_ += static_cast<unsigned> (__builtin_popcountll (block.active & block.fresh));
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {0, 1})
        handOn (front_[i], passed[i][faceOf (axis, side)], axis, side == 1);
  }
}

/** \brief Marks those fresh cells of a block that the surface crosses, and those of it to which they hand on if
 * nothing has to be evaluated for them. */
SurfaceTracker::PassedFaces
SurfaceTracker::classify (int index)
{
  GridBlock &block = grid_.block (index);
  std::array<std::uint64_t, 8> inside{}, undefined{}, near{}, known{};
  for (std::size_t above = 0; above < 8; ++above)
    if (block.above[above] >= 0)
    {
      const GridBlock &other = grid_.block (block.above[above]);
      inside[above] = other.inside;
      undefined[above] = other.undefined;
      near[above] = other.near;
      known[above] = other.known;
    }
  inside = grid_bits::atCorners (inside);
  const std::uint64_t all_known = everyOf (grid_bits::atCorners (known));
  const std::uint64_t may_cross = anyOf (inside) & ~everyOf (inside) & anyOf (grid_bits::atCorners (near)) &
                                  ~anyOf (grid_bits::atCorners (undefined));
  const PassedFaces cut = cutFaces (inside);
  PassedFaces passed{};
  for (std::uint64_t cells = block.fresh; cells != 0;)
  {
    const std::uint64_t crossed = may_cross & cells;
    block.active |= crossed;
    std::uint64_t next = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {0, 1})
      {
        const std::uint64_t through = crossed & cut[faceOf (axis, side)];
        passed[faceOf (axis, side)] |= through;
        next |= side == 1 ? grid_bits::up (through, axis) : grid_bits::down (through, axis);
      }
    cells = next & all_known & ~block.visited;
    block.visited |= cells;
    block.fresh |= cells;
  }
  return passed;
}

/** \brief For each face of cells: those with corners of it on either side of the surface.
 * \param[in] inside corner by corner the cells that have it inside
 */
SurfaceTracker::PassedFaces
SurfaceTracker::cutFaces (const std::array<std::uint64_t, 8> &inside)
{
  PassedFaces cut{};
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, 1})
    {
      std::uint64_t any = 0, every = ~std::uint64_t (0);
      for (int corner = 0; corner < 8; ++corner)
        if ((corner >> axis & 1) == side)
        {
          any |= inside[static_cast<std::size_t> (corner)];
          every &= inside[static_cast<std::size_t> (corner)];
        }
      cut[faceOf (axis, side)] = any & ~every;
    }
  return cut;
}

/** \brief The cells beyond a face of some cells go into the next front. */
void
SurfaceTracker::handOn (int index, std::uint64_t cells, int axis, bool up)
{
  if (cells == 0)
    return;
  addToFront (index, up ? grid_bits::up (cells, axis) : grid_bits::down (cells, axis));
  const std::uint64_t leaving = up ? grid_bits::intoAbove (cells, axis) : grid_bits::intoBelow (cells, axis);
  const GridPoint &first = grid_.block (index).first;
  const int coordinate = (axis == 0 ? first.x : axis == 1 ? first.y : first.z) + (up ? 4 : -4);
  if (leaving != 0 && std::abs (coordinate) + 4 < SparseGrid::LIMIT)
    addToFront (up ? grid_.placeAbove (index, 1 << axis) : grid_.placeBelow (index, axis), leaving);
}

} // namespace erkpa
