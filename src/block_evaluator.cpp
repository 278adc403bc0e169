// SPDX-License-Identifier: BSD-3-Clause
#include "block_evaluator.h"

#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>

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
BlockEvaluator::evaluate (GridField &worker, const int *first_block, const int *last_block) const
{
  for (const BlockPart &part : parts_)
  {
    worker.wanted.clear ();
    for (const int *index = first_block; index != last_block; ++index)
    {
      GridBlock &block = grid_.block (*index);
      for (std::uint64_t left = block.needed & part.nodes; left != 0; left &= left - 1)
        worker.wanted.push_back ({&block, __builtin_ctzll (left)});
    }
    evaluateWanted (worker);
  }
  for (const int *index = first_block; index != last_block; ++index)
    grid_.block (*index).needed = 0;
}

/** \brief Evaluate the nodes that are wanted, from one ball around them. */
void
BlockEvaluator::evaluateWanted (GridField &worker) const
{
  if (worker.wanted.empty ())
    return;
  Eigen::AlignedBox3i box;
  for (const WantedNode &node : worker.wanted)
  {
    const GridPoint point = SparseGrid::pointAt (*node.block, node.node);
    box.extend (Eigen::Vector3i (point.x, point.y, point.z));
  }
  const double voxel = grid_.voxelSize ();
  const Eigen::Vector3d center = grid_.position ({0, 0, 0}) + 0.5 * voxel * (box.min () + box.max ()).cast<double> ();
  const double extent = 0.5 * voxel * (box.max () - box.min ()).cast<double> ().norm ();
  if (worker.block.gather (center, extent))
    evaluateTogether (worker);
  if (worker.wanted.empty ())
    return;
  worker.local.gather (center, extent);
  for (const WantedNode &node : worker.wanted)
    evaluateAlone (worker.local, node);
}

/** \brief Evaluate what can be in lanes; the nodes that want LocalField are left. */
void
BlockEvaluator::evaluateTogether (GridField &worker) const
{
  BlockField &field = worker.block;
  std::vector<WantedNode> &wanted = worker.wanted, &left = worker.left;
  left.clear ();
  std::size_t taken = 0;
  for (const WantedNode node : wanted)
  {
    const Eigen::Vector3d position = positionOf (node);
    if (field.canEvaluateAt (position))
    {
      wanted[taken++] = node;
      field.addPoint (position);
    }
    else
      left.push_back (node);
  }
  field.evaluate (false);
  for (std::size_t i = 0; i < taken; ++i)
    if (field.isUnsettled (i))
      left.push_back (wanted[i]);
    else
      wanted[i].block->setValue (wanted[i].node, static_cast<float> (field.value (i) - options_.iso_level),
                                 field.isInReach (i));
  wanted.swap (left);
}

void
BlockEvaluator::evaluateAlone (LocalField &field, const WantedNode &node) const
{
  const double value = field.value (positionOf (node)) - options_.iso_level;
  node.block->setValue (node.node, static_cast<float> (value), isInReach (field, options_, grid_.voxelSize ()));
}

} // namespace erkpa
