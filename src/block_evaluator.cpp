// SPDX-License-Identifier: BSD-3-Clause
#include "block_evaluator.h"

#include <cmath>

namespace erkpa
{

GridField::GridField (const ImplicitField &field, const PolygonizerOptions &options, double voxel_size)
    : local (field), block (field)
{
  constexpr double LEAST_WALL = 1.2; // voxels
  local.thicken (local.unwarpedLength (LEAST_WALL * voxel_size));
  block.thicken (LEAST_WALL * voxel_size);
  const double offset = std::abs (options.iso_level);
  block.setReach (options.reach, offset, std::sqrt (3.0) * voxel_size + offset);
}

bool
isInReach (const LocalField &local, const PolygonizerOptions &options, double voxel_size)
{
  const Support &support = local.support ();
  const double offset = std::abs (options.iso_level);
  const bool is_beyond =
      FaceVote::isBeyondBorder (support.nearestDistance () - offset, support.radius (), local.aside ());
  // A cell as large as the support or larger reaches beyond it, even where nodes lie in the cell.
  return (!is_beyond && support.quartileDistance () <= options.reach * support.radius () + offset) ||
         support.nearestDistance () <= local.unwarpedLength (std::sqrt (3.0) * voxel_size) + offset;
}

void
BlockEvaluator::evaluate (GridField &worker, GridBlock &block) const
{
  for (const BlockPart &part : parts_)
  {
    std::uint64_t nodes = block.needed & part.nodes;
    if (nodes == 0)
      continue;
    Eigen::Vector3d center;
    double extent = 0.0;
    findBall (block, nodes, center, extent);
    if (worker.block.gather (center, extent))
      nodes = evaluateTogether (worker.block, nodes, block);
    if (nodes == 0)
      continue;
    worker.local.gather (center, extent);
    for (; nodes != 0; nodes &= nodes - 1)
      evaluateAlone (worker.local, __builtin_ctzll (nodes), block);
  }
  block.needed = 0;
}

Eigen::Vector3d
BlockEvaluator::positionOf (const GridBlock &block, int node) const
{
  return grid_.position (SparseGrid::pointAt (block, node));
}

/** \brief A ball around some nodes of a block. */
void
BlockEvaluator::findBall (const GridBlock &block, std::uint64_t nodes, Eigen::Vector3d &center, double &extent) const
{
  Eigen::Array3i low (3, 3, 3), high (0, 0, 0);
  for (; nodes != 0; nodes &= nodes - 1)
  {
    const int node = __builtin_ctzll (nodes);
    const Eigen::Array3i at (node & 3, (node >> 2) & 3, node >> 4);
    low = low.min (at);
    high = high.max (at);
  }
  const Eigen::Vector3d middle = 0.5 * (low + high).cast<double> ().matrix ();
  center = grid_.position (block.first) + grid_.voxelSize () * middle;
  extent = 0.5 * grid_.voxelSize () * (high - low).cast<double> ().matrix ().norm ();
}

/** \brief Evaluates what has no enrichment; returns the nodes that want LocalField. */
std::uint64_t
BlockEvaluator::evaluateTogether (BlockField &field, std::uint64_t nodes, GridBlock &block) const
{
  std::array<int, GridBlock::NODES> taken;
  std::uint64_t others = 0;
  for (; nodes != 0; nodes &= nodes - 1)
  {
    const int node = __builtin_ctzll (nodes);
    const Eigen::Vector3d position = positionOf (block, node);
    if (field.canEvaluateAt (position))
    {
      taken[field.size ()] = node;
      field.addPoint (position);
    }
    else
      others |= std::uint64_t (1) << node;
  }
  field.evaluate (false);
  for (std::size_t i = 0; i < field.size (); ++i)
    if (field.isUnsettled (i))
      others |= std::uint64_t (1) << taken[i];
    else
      block.setValue (taken[i], static_cast<float> (field.value (i) - options_.iso_level), field.isInReach (i));
  return others;
}

void
BlockEvaluator::evaluateAlone (LocalField &field, int node, GridBlock &block) const
{
  const double value = field.value (positionOf (block, node)) - options_.iso_level;
  block.setValue (node, static_cast<float> (value), isInReach (field, options_, grid_.voxelSize ()));
}

} // namespace erkpa
