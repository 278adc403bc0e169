// SPDX-License-Identifier: BSD-3-Clause
#include "block_evaluator.h"

#include "grid_bits.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace erkpa
{

GridField::GridField (const ImplicitField &field, const PolygonizerOptions &options, double voxel_size,
                      const MomentLattice *lattice)
    : local (field), block (field, lanes::bestEngine (), lattice)
{
  constexpr double LEAST_WALL = 1.2; // voxels
  local.thicken (local.unwarpedLength (LEAST_WALL * voxel_size));
  block.thicken (LEAST_WALL * voxel_size);
  const double offset = std::abs (options.iso_level);
  block.setReach (options.reach, offset, std::sqrt (3.0) * voxel_size + offset,
                  field.supportSize ().farthest (voxel_size));
  block.setLevel (options.iso_level);
}

bool
isInReach (const LocalField &local, const PolygonizerOptions &options, double voxel_size)
{
  const Support &support = local.support ();
  if (support.radius () > support.farthest (local.unwarpedLength (voxel_size)))
    return false;
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
  if (!sketchCube (worker, first_block, last_block))
    for (const BlockPart &part : parts_)
    {
      worker.wanted.clear ();
      for (const int *index = first_block; index != last_block; ++index)
      {
        GridBlock &block = grid_.block (*index);
        listNodes (block, block.needed & part.nodes, worker.wanted);
      }
      if (!worker.wanted.empty ())
        evaluateWanted (worker, first_block, last_block);
    }
  for (const int *index = first_block; index != last_block; ++index)
    grid_.block (*index).needed = 0;
}

/** \brief Evaluate the nodes that are wanted, from one ball around them. */
void
BlockEvaluator::evaluateWanted (GridField &worker, const int *first_block, const int *last_block) const
{
  const bool foresees = foresees_ && parts_.size () == 1 && grid_.block (*first_block).known == 0;
  Eigen::AlignedBox3i box;
  const auto extend = [&box] (const GridPoint &point) { box.extend (Eigen::Vector3i (point.x, point.y, point.z)); };
  for (const WantedNode &node : worker.wanted)
    extend (SparseGrid::pointAt (*node.block, node.node));
  for (const int *index = first_block; index != (foresees ? last_block : first_block); ++index)
  {
    constexpr int LAST = GridBlock::SIDE - 1;
    extend (grid_.block (*index).first);
    extend (grid_.block (*index).first + GridPoint{LAST, LAST, LAST});
  }
  const double voxel = grid_.voxelSize ();
  const Eigen::Vector3d center = grid_.position ({0, 0, 0}) + 0.5 * voxel * (box.min () + box.max ()).cast<double> ();
  const double extent = 0.5 * voxel * (box.max () - box.min ()).cast<double> ().norm ();
  worker.left.clear ();
  if (!worker.block.gather (center, extent))
    worker.left.swap (worker.wanted);
  else if (foresees)
    evaluateForeseen (worker, first_block, last_block, center);
  else
    evaluateTogether (worker);
  if (worker.left.empty ())
    return;
  worker.local.gather (center, extent);
  for (const WantedNode &node : worker.left)
    evaluateAlone (worker.local, node);
}

bool
BlockEvaluator::takeMiddles (BlockField &field, CubeSketch &sketch) const
{
  for (std::size_t i = 0; i < CubeSketch::OCTANTS; ++i)
    if (!field.addPoint (sketch.middle (i)))
      return false;
  field.evaluate (true);
  for (std::size_t i = 0; i < CubeSketch::OCTANTS; ++i)
  {
    if (!field.isSettled (i) || !field.isInReach (i) || !BlockGroups::areCubes (field.radius (i) / grid_.voxelSize ()))
      return false;
    sketch.set (i, field.value (i), field.gradient (i));
  }
  return true;
}

bool
BlockEvaluator::sketchCube (GridField &worker, const int *first_block, const int *last_block) const
{
  // Voxels: most sketches are off by less than half of the first. Where no node is as close, the second finds some if
  // f = iso passes between nodes at all. Cells that it crosses have corners up to NEAR off where f is about a distance.
  constexpr double CLOSE = 0.15, LESS_CLOSE = 0.6, NEAR = 1.3;
  const auto is_known = [this] (int block) { return grid_.block (block).known != 0; };
  if (!sketches_ || last_block - first_block != static_cast<std::ptrdiff_t> (CubeSketch::OCTANTS) ||
      std::any_of (first_block, last_block, is_known))
    return false;
  const double half = 0.5 * (GridBlock::SIDE - 1) * grid_.voxelSize (), side = GridBlock::SIDE * grid_.voxelSize ();
  const GridPoint first = BlockGroups::cubeOf (grid_.block (*first_block).first);
  CubeSketch sketch (grid_.position (first) + Eigen::Vector3d::Constant (half), side);
  if (!worker.block.gather (sketch.center (), std::sqrt (3.0) * (0.5 * side + half)) ||
      !takeMiddles (worker.block, sketch))
    return false;
  const double unit = grid_.voxelSize () * sketch.steepest ();
  for (const double close : {CLOSE, LESS_CLOSE})
  {
    fillIn (sketch, close * unit, first_block, last_block, worker);
    const bool is_tested = close == LESS_CLOSE || !worker.wanted.empty ();
    if (is_tested && evaluateClose (worker, 0.5 * close * unit))
      return true;
  }
  for (const int *index = first_block; index != last_block; ++index)
    requestNear (NEAR * unit, grid_.block (*index));
  return false;
}

void
BlockEvaluator::requestNear (double most, GridBlock &block)
{
  for (int node = 0; node < GridBlock::NODES; ++node)
  {
    const bool is_near = std::abs (static_cast<double> (block.values[static_cast<std::size_t> (node)])) <= most;
    block.needed |= static_cast<std::uint64_t> (is_near) << node;
  }
  block.forget ();
}

void
BlockEvaluator::fillIn (const CubeSketch &sketch, double close, const int *first_block, const int *last_block,
                        GridField &worker) const
{
  worker.wanted.clear ();
  for (const int *index = first_block; index != last_block; ++index)
  {
    GridBlock &block = grid_.block (*index);
    block.forget ();
    for (int row = 0; row < GridBlock::NODES; row += GridBlock::SIDE)
    {
      const Eigen::Vector3d x = grid_.position (SparseGrid::pointAt (block, row));
      std::array<double, GridBlock::SIDE> values{};
      sketch.valuesOnLine (x, grid_.voxelSize (), values);
      for (int i = 0; i < GridBlock::SIDE; ++i)
      {
        const double value = values[static_cast<std::size_t> (i)] - options_.iso_level;
        block.setValue (row + i, static_cast<float> (value), true);
        if (std::abs (value) <= close)
          worker.wanted.push_back ({&block, row + i});
      }
    }
  }
}

bool
BlockEvaluator::evaluateClose (GridField &worker, double most) const
{
  BlockField &field = worker.block;
  field.clearPoints ();
  for (const WantedNode &node : worker.wanted)
    if (!field.addPoint (positionOf (node)))
      return false;
  field.evaluate (false);
  for (std::size_t i = 0; i < worker.wanted.size (); ++i)
  {
    const WantedNode &node = worker.wanted[i];
    const double value = field.value (i) - options_.iso_level;
    const double sketched = static_cast<double> (node.block->values[static_cast<std::size_t> (node.node)]);
    if (field.isUnsettled (i) || !(std::abs (value - sketched) <= most) || !field.isInReach (i))
      return false;
    node.block->setValueAgain (node.node, static_cast<float> (value));
  }
  return true;
}

void
BlockEvaluator::evaluateForeseen (GridField &worker, const int *first_block, const int *last_block,
                                  const Eigen::Vector3d &center) const
{
  BlockField &field = worker.block;
  const bool has_center = field.addSketchPoint (center);
  evaluateTogether (worker);
  FieldSketch sketch;
  if (!has_center || !field.sketch (0, sketch))
    return;
  worker.wanted.clear ();
  for (const int *index = first_block; index != last_block; ++index)
  {
    GridBlock &block = grid_.block (*index);
    listNodes (block, nodesNear (block, sketch) & ~(block.known | block.needed), worker.wanted);
  }
  field.clearPoints ();
  evaluateTogether (worker);
}

std::uint64_t
BlockEvaluator::nodesNear (const GridBlock &block, const FieldSketch &sketch) const
{
  constexpr int SIDE = GridBlock::SIDE;
  const double voxel = grid_.voxelSize ();
  const Eigen::Vector3d first = grid_.position (block.first);
  double values[3][SIDE], steps[3][SIDE]; // along each axis: what is added to the value, and by a cell
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < SIDE; ++i)
    {
      values[axis][i] = sketch.along (axis, first[axis] + i * voxel);
      steps[axis][i] = std::abs (sketch.slopeAlong (axis, first[axis] + i * voxel)) * voxel;
    }
  std::uint64_t near = 0;
  for (int node = 0; node < GridBlock::NODES; ++node)
  {
    const int x = node % SIDE, y = node / SIDE % SIDE, z = node / (SIDE * SIDE);
    const double value = sketch.value - options_.iso_level + values[0][x] + values[1][y] + values[2][z];
    const bool is_near = std::abs (value) <= steps[0][x] + steps[1][y] + steps[2][z];
    near |= static_cast<std::uint64_t> (is_near) << node;
  }
  return near;
}

void
BlockEvaluator::listNodes (GridBlock &block, std::uint64_t nodes, std::vector<WantedNode> &list)
{
  for (const std::uint64_t octant : grid_bits::OCTANTS)
    for (std::uint64_t left = nodes & octant; left != 0; left &= left - 1)
      list.push_back ({&block, __builtin_ctzll (left)});
}

/** \brief After the points that are there. */
void
BlockEvaluator::evaluateTogether (GridField &worker) const
{
  BlockField &field = worker.block;
  std::vector<WantedNode> &wanted = worker.wanted;
  const std::size_t before = field.size ();
  std::size_t taken = 0;
  for (const WantedNode node : wanted)
  {
    const Eigen::Vector3d position = positionOf (node);
    if (field.addPoint (position))
      wanted[taken++] = node;
    else
      worker.left.push_back (node);
  }
  field.evaluate (false);
  for (std::size_t i = 0; i < taken; ++i)
    if (const std::size_t point = before + i; field.isUnsettled (point))
      worker.left.push_back (wanted[i]);
    else
      wanted[i].block->setValue (wanted[i].node, static_cast<float> (field.value (point) - options_.iso_level),
                                 field.isInReach (point));
}

void
BlockEvaluator::evaluateAlone (LocalField &field, const WantedNode &node) const
{
  const double value = field.value (positionOf (node)) - options_.iso_level;
  node.block->setValue (node.node, static_cast<float> (value), isInReach (field, options_, grid_.voxelSize ()));
}

} // namespace erkpa
