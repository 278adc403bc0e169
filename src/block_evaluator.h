// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "block_field.h"
#include "block_groups.h"
#include "cube_sketch.h"
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
  /** \param[in] lattice see BlockField */
  GridField (const ImplicitField &field, const PolygonizerOptions &options, double voxel_size,
             const MomentLattice *lattice);

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
   * \param[in] sketches whether cubes of blocks are sketched: where canSketch ()
   */
  BlockEvaluator (const ImplicitField &field, const PolygonizerOptions &options, SparseGrid &grid, bool foresees,
                  bool sketches)
      : options_ (options), grid_ (grid), foresees_ (foresees), sketches_ (sketches),
        parts_ (partsOfBlock (field.typicalRadius () / grid.voxelSize ()))
  {
  }

  /** \brief Whether sketches may serve: it is best then to ask for all blocks of a cube (BlockGroups). */
  static bool
  canSketch (const ImplicitField &field, double voxel_size)
  {
    return BlockGroups::areCubes (field.typicalRadius () / voxel_size) && BlockField::canEvaluate (field) &&
           field.faces () == nullptr && field.options ().sharp_surfaces.empty ();
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

  /** \brief Value all nodes of a cube of blocks (BlockGroups) of which none is known yet.
   *
   * Supports that are far larger than blocks leave f so smooth that its values and gradients in the middles of the
   * blocks tell it in between; only nodes next to f = iso are evaluated.
   * \return false, and nothing is known, where these show that it is not
   */
  bool
  sketchCube (GridField &worker, const int *first_block, const int *last_block) const;

  /** \brief Take f and its gradients in the middles of the octants; false where they are undefined, out of
   * reach, or of supports that are not that large. */
  bool
  takeMiddles (BlockField &field, CubeSketch &sketch) const;

  /** \brief Take back the values of a block's nodes; those up to \a most are to be evaluated. */
  static void
  requestNear (double most, GridBlock &block);

  /** \brief Value the nodes of the cube by a sketch, but list as wanted those that are to be evaluated. */
  void
  fillIn (const CubeSketch &sketch, double close, const int *first_block, const int *last_block,
          GridField &worker) const;

  /** \brief Evaluate the wanted nodes; false where one is off its sketch by more than \a most, or out of reach. */
  bool
  evaluateClose (GridField &worker, double most) const;

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
  bool foresees_, sketches_;
  const std::vector<BlockPart> &parts_;
};

} // namespace erkpa
