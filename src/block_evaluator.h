// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "block_field.h"
#include "local_field.h"
#include "sparse_grid.h"

#include <erkpa/marching_cubes.h>

#include <array>
#include <cstdint>
#include <vector>

namespace erkpa
{

/** \brief The field as one thread asks it for the nodes of a grid. */
struct GridField
{
  GridField (const ImplicitField &field, const PolygonizerOptions &options, double voxel_size);

  LocalField local; ///< walls so thin that both sides cross the same edge of the grid are thickened
  BlockField block; ///< the quick double, for points it can do; the same

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
  BlockEvaluator (const ImplicitField &field, const PolygonizerOptions &options, const SparseGrid &grid)
      : options_ (options), grid_ (grid), parts_ (partsOfBlock (field.typicalRadius () / grid.voxelSize ()))
  {
  }

  void
  evaluate (GridField &worker, GridBlock &block) const;

private:
  Eigen::Vector3d
  positionOf (const GridBlock &block, int node) const;

  void
  findBall (const GridBlock &block, std::uint64_t nodes, Eigen::Vector3d &center, double &extent) const;

  std::uint64_t
  evaluateTogether (BlockField &field, std::uint64_t nodes, GridBlock &block) const;

  void
  evaluateAlone (LocalField &field, int node, GridBlock &block) const;

  const PolygonizerOptions &options_;
  const SparseGrid &grid_;
  const std::vector<BlockPart> &parts_;
};

} // namespace erkpa
