// SPDX-License-Identifier: BSD-3-Clause
#include "surface_tracking.h"

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
constexpr GridPoint ALONG[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr GridPoint AGAINST[3] = {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};

} // namespace

LocalField
fieldForGrid (const ImplicitField &field, double voxel_size)
{
  constexpr double LEAST_WALL = 1.2; // voxels
  LocalField local (field);
  local.thicken (local.unwarpedLength (LEAST_WALL * voxel_size));
  return local;
}

bool
isInReach (const LocalField &local, const PolygonizerOptions &options, double voxel_size)
{
  const Support &support = local.support ();
  const double offset = std::abs (options.iso_level);
  // Beyond its border a face goes on for a while, and might meet another one there.
  constexpr double FAR_ASIDE = 0.65, APART = 0.5; // support radii
  const bool is_beyond = support.nearestDistance () > APART * support.radius () + offset && local.aside () > FAR_ASIDE;
  // A cell as large as the support or larger reaches beyond it, even where nodes lie in the cell.
  return (!is_beyond && support.quartileDistance () <= options.reach * support.radius () + offset) ||
         support.nearestDistance () <= local.unwarpedLength (std::sqrt (3.0) * voxel_size) + offset;
}

SurfaceTracker::SurfaceTracker (const ImplicitField &field, const PolygonizerOptions &options, SparseGrid &grid,
                                PolygonizerReport &report, ProgressCallback progress)
    : field_ (field), options_ (options), grid_ (grid), report_ (report), progress_ (std::move (progress))
{
}

Outcome
SurfaceTracker::track ()
{
  seedFromNodes ();
  followFront ();
  seedFromProjections ();
  followFront ();
  if (too_many_)
    return {Status::GRID_TOO_FINE, "the surface crosses more than " + std::to_string (MAX_ACTIVE_CELLS) +
                                       " grid cells: use a larger voxel size or a lower resolution"};
  return {};
}

void
SurfaceTracker::addToFront (const GridPoint &cell)
{
  const auto inside = [] (int v) { return v > -SparseGrid::LIMIT && v < SparseGrid::LIMIT; };
  if (!inside (cell.x) || !inside (cell.y) || !inside (cell.z))
    return;
  const GridPlace place = grid_.place (cell);
  GridBlock &block = grid_.block (place.block);
  if (block.visited & place.bit ())
    return;
  block.visited |= place.bit ();
  next_front_.push_back (cell);
}

void
SurfaceTracker::followFront ()
{
  std::swap (front_, next_front_);
  next_front_.clear ();
  while (!front_.empty () && !too_many_)
  {
    for (const GridPoint &cell : front_)
      requestCorners (cell);
    evaluateRequested ();
    for (const GridPoint &cell : front_)
      classify (cell);
    std::swap (front_, next_front_);
    next_front_.clear ();
    too_many_ = active_.size () > MAX_ACTIVE_CELLS;
  }
}

void
SurfaceTracker::requestCorners (const GridPoint &cell)
{
  for (int corner = 0; corner < 8; ++corner)
  {
    const GridPlace place = grid_.place (cell + cornerOffset (corner));
    GridBlock &block = grid_.block (place.block);
    if ((block.known | block.needed) & place.bit ())
      continue;
    if (block.needed == 0)
      requested_blocks_.push_back (place.block);
    block.needed |= place.bit ();
  }
}

void
SurfaceTracker::evaluateRequested ()
{
  // In slices, so that progress shows during the first front, which is the largest by far.
  constexpr std::size_t SLICE = 8192;
  for (std::size_t first = 0; first < requested_blocks_.size (); first += SLICE)
  {
    parallelFor (
        std::min (SLICE, requested_blocks_.size () - first), options_.threads,
        [this] { return fieldForGrid (field_, grid_.voxelSize ()); },
        [&] (LocalField &local, std::size_t i) { evaluateBlock (local, grid_.block (requested_blocks_[first + i])); },
        [this] (const LocalField &local)
        {
          report_.evaluations += local.evaluations ();
          report_.support_nodes += local.supportNodes ();
        });
    evaluated_blocks_ += std::min (SLICE, requested_blocks_.size () - first);
    if (progress_)
      progress_ (std::min (1.0, static_cast<double> (evaluated_blocks_) / static_cast<double> (grid_.blockCount ())));
  }
  requested_blocks_.clear ();
}

void
SurfaceTracker::evaluateBlock (LocalField &local, GridBlock &block) const
{
  for (const BlockPart &part : partsOfBlock (field_.typicalRadius () / grid_.voxelSize ()))
  {
    const std::uint64_t nodes = block.needed & part.nodes;
    if (nodes == 0)
      continue;
    const double half = 0.5 * (part.side - 1) * grid_.voxelSize ();
    local.gather (grid_.position (block.first + part.first).array () + half, std::sqrt (3.0) * half);
    for (int node = 0; node < GridBlock::NODES; ++node)
    {
      if (!(nodes >> node & 1))
        continue;
      block.values[static_cast<std::size_t> (node)] =
          local.value (grid_.position (SparseGrid::pointAt (block, node))) - options_.iso_level;
      if (isInReach (local, options_, grid_.voxelSize ()))
        block.near |= std::uint64_t (1) << node;
    }
  }
  block.known |= block.needed;
  block.needed = 0;
}

void
SurfaceTracker::classify (const GridPoint &cell)
{
  const std::array<double, 8> values = grid_.cornerValues (cell);
  unsigned inside = 0;
  for (unsigned corner = 0; corner < 8; ++corner)
  {
    if (std::isnan (values[corner]))
      return;
    inside |= values[corner] < 0.0 ? 1u << corner : 0u;
  }
  if (inside == 0 || inside == 255 || !grid_.isNear (cell))
    return;
  const GridPlace place = grid_.place (cell);
  grid_.block (place.block).active |= place.bit ();
  active_.push_back (cell);
  constexpr unsigned LOW_FACES[3] = {0x55, 0x33, 0x0f}; // the corners of a face as bits
  for (int axis = 0; axis < 3; ++axis)
  {
    const unsigned low = inside & LOW_FACES[axis], high = inside & ~LOW_FACES[axis];
    if (low != 0 && low != LOW_FACES[axis])
      addToFront (cell + AGAINST[axis]);
    if (high != 0 && high != (255u ^ LOW_FACES[axis]))
      addToFront (cell + ALONG[axis]);
  }
}

void
SurfaceTracker::seedFromNodes ()
{
  for (const Eigen::Vector3f &position : field_.surfacePositions ())
    addToFront (grid_.cellOf (position.cast<double> ()));
}

bool
SurfaceTracker::findCellNear (const GridPoint &cell, GridPoint &found) const
{
  for (const int dx : {0, -1, 1})
    for (const int dy : {0, -1, 1})
      for (const int dz : {0, -1, 1})
      {
        found = cell + GridPoint{dx, dy, dz};
        if (grid_.isActive (found))
          return true;
      }
  return false;
}

/** \brief Where noise or smoothing moves the surface off a node, start at the foot of the node on the surface. */
void
SurfaceTracker::seedFromProjections ()
{
  const auto &positions = field_.surfacePositions ();
  cells_of_nodes_.assign (positions.size (), {NO_CELL, 0, 0});
  std::vector<std::size_t> away;
  for (std::size_t i = 0; i < positions.size (); ++i)
  {
    GridPoint found{};
    if (findCellNear (grid_.cellOf (positions[i].cast<double> ()), found))
      cells_of_nodes_[i] = found;
    else
      away.push_back (i);
  }
  std::vector<Eigen::Vector3d> feet (away.size ());
  std::vector<char> has_foot (away.size (), 0);
  parallelFor (
      away.size (), options_.threads, [this] { return fieldForGrid (field_, grid_.voxelSize ()); },
      [&] (LocalField &local, std::size_t i)
      {
        feet[i] = positions[away[i]].cast<double> ();
        has_foot[i] = project (local, feet[i]) ? 1 : 0;
      },
      [this] (const LocalField &local)
      {
        report_.evaluations += local.evaluations ();
        report_.support_nodes += local.supportNodes ();
      });
  for (std::size_t i = 0; i < away.size (); ++i)
    if (has_foot[i])
    {
      cells_of_nodes_[away[i]] = grid_.cellOf (feet[i]);
      addToFront (cells_of_nodes_[away[i]]);
    }
}

bool
SurfaceTracker::project (LocalField &local, Eigen::Vector3d &position) const
{
  constexpr int STEPS = 4;
  for (int step = 0; step < STEPS; ++step)
  {
    local.gather (position, 0.0);
    const LocalSample sample = local.sample (position);
    const double slope = sample.gradient.squaredNorm ();
    if (!sample.isDefined () || !(slope > 0.0) || !isInReach (local, options_, grid_.voxelSize ()))
      return false;
    const Eigen::Vector3d move = (options_.iso_level - sample.value) / slope * sample.gradient;
    if (!(local.unwarpedLength (move.norm ()) < sample.radius + std::abs (options_.iso_level)))
      return false;
    position += move;
    if (move.norm () < 0.1 * grid_.voxelSize ())
      return true;
  }
  return false;
}

} // namespace erkpa
