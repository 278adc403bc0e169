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
  /** \param[in] foresees whether nodes that were not asked for yet are evaluated, too, where it looks as if they will
   */
  BlockEvaluator (const ImplicitField &field, const PolygonizerOptions &options, SparseGrid &grid, bool foresees)
      : options_ (options), grid_ (grid), foresees_ (foresees),
        parts_ (partsOfBlock (field.typicalRadius () / grid.voxelSize ()))
  {
  }

  /** \brief Evaluate those of some blocks that share a gathering of the field's nodes: see BlockGroups. */
  void
  evaluate (GridField &worker, const int *first_block, const int *last_block) const;

private:
  static void
  listNodes (GridBlock &block, std::uint64_t nodes, std::vector<WantedNode> &list);

  Eigen::Vector3d
  positionOf (const WantedNode &node) const
  {
    return grid_.position (SparseGrid::pointAt (*node.block, node.node));
  }

  void
  evaluateWanted (GridField &worker, const int *first_block, const int *last_block) const;

  /** \brief Evaluate the wanted nodes in lanes; those that want LocalField are left. */
  void
  evaluateTogether (GridField &worker) const;

  /** \brief Evaluate the other nodes of some blocks that the surface will ask for, as far as one fit can tell.
   *
   * Following the surface asks for a few nodes of a block at a time; but gathering takes longer than evaluating these,
   * and lanes stay empty.
   * \param[in] center of the gathering
   */
  void
  evaluateForeseen (GridField &worker, const int *first_block, const int *last_block,
                    const Eigen::Vector3d &center) const;

  /** \brief The nodes of a block that are corners of a cell with f = iso in it. */
  std::uint64_t
  nodesNear (const GridBlock &block, const FieldSketch &sketch) const;

  void
  evaluateAlone (LocalField &field, const WantedNode &node) const;

  const PolygonizerOptions &options_;
  SparseGrid &grid_;
  bool foresees_;
  const std::vector<BlockPart> &parts_;
};

} // namespace erkpa
