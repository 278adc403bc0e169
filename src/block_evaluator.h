// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "block_field.h"
#include "local_field.h"
#include "sparse_grid.h"

#include <erkpa/marching_cubes.h>

#include <vector>

namespace erkpa
{

/** \brief A node of a grid whose value is asked for. */
struct WantedNode
{
  GridBlock *block;
  int node;
};

/** \brief The field as one thread asks it for the nodes of a grid. */
struct GridField
{
  GridField (const ImplicitField &field, const PolygonizerOptions &options, double voxel_size);

  LocalField local; ///< walls so thin that both sides cross the same edge of the grid are thickened
  BlockField block; ///< the quick double, for points it can do; the same

  std::vector<WantedNode> wanted, left; ///< memory for a BlockEvaluator

  void
  addTo (PolygonizerReport &report) const
  {
    report.evaluations += local.evaluations () + block.evaluations ();
    report.support_nodes += local.supportNodes () + block.supportNodes ();
  }
};

/** \brief Whether a surface may be at a point: not farther from the nodes than the data supports. */
bool
isInReach (const LocalField &local, const PolygonizerOptions &options, double voxel_size);

/** \brief Evaluates the needed nodes of blocks. */
class BlockEvaluator
{
public:
  BlockEvaluator (const ImplicitField &field, const PolygonizerOptions &options, SparseGrid &grid)
      : options_ (options), grid_ (grid), parts_ (partsOfBlock (field.typicalRadius () / grid.voxelSize ()))
  {
  }

  /** \brief Evaluate those of some blocks that share a gathering of the field's nodes: see BlockGroups. */
  void
  evaluate (GridField &worker, const int *first_block, const int *last_block) const;

private:
  Eigen::Vector3d
  positionOf (const WantedNode &node) const
  {
    return grid_.position (SparseGrid::pointAt (*node.block, node.node));
  }

  void
  evaluateWanted (GridField &worker) const;

  void
  evaluateTogether (GridField &worker) const;

  void
  evaluateAlone (LocalField &field, const WantedNode &node) const;

  const PolygonizerOptions &options_;
  SparseGrid &grid_;
  const std::vector<BlockPart> &parts_;
};

} // namespace erkpa
