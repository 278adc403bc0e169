// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "local_field.h"
#include "sparse_grid.h"

#include <erkpa/marching_cubes.h>

#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief Finds the cells that the surface crosses by following it from the cells of the nodes.
 *
 * Works in fronts: the corner values a front needs are evaluated together, block by block, each once; then every
 * crossed cell hands the front on through the faces that the surface passes.
 */
class SurfaceTracker
{
public:
  SurfaceTracker (const ImplicitField &field, const PolygonizerOptions &options, SparseGrid &grid,
                  PolygonizerReport &report, ProgressCallback progress);

  /** \brief Mark the active cells of the grid.
   * \return Status::GRID_TOO_FINE where the surface passes more cells than fit in memory
   */
  Outcome
  track ();

  /** \brief The active cells, in the order they were found. */
  const std::vector<GridPoint> &
  activeCells () const
  {
    return active_;
  }

  /** \brief For each node the active cell at which it supports the surface; an x of NO_CELL where there is none. */
  const std::vector<GridPoint> &
  cellsOfNodes () const
  {
    return cells_of_nodes_;
  }

  static constexpr int NO_CELL = 1 << 30;

private:
  void
  addToFront (const GridPoint &cell);

  void
  followFront ();

  void
  requestCorners (const GridPoint &cell);

  void
  evaluateRequested ();

  void
  evaluateBlock (LocalField &local, GridBlock &block) const;

  void
  classify (const GridPoint &cell);

  void
  seedFromNodes ();

  void
  seedFromProjections ();

  bool
  findCellNear (const GridPoint &cell, GridPoint &found) const;

  bool
  project (LocalField &local, Eigen::Vector3d &position) const;

  const ImplicitField &field_;
  const PolygonizerOptions &options_;
  SparseGrid &grid_;
  PolygonizerReport &report_;
  ProgressCallback progress_;
  std::vector<GridPoint> front_, next_front_, active_;
  std::vector<int> requested_blocks_;
  std::size_t evaluated_blocks_ = 0; // a block counts once per front that asks for nodes of it
  std::vector<GridPoint> cells_of_nodes_;
  bool too_many_ = false;
};

/** \brief The field for a grid: walls so thin that both sides cross the same edge of the grid are thickened. */
LocalField
fieldForGrid (const ImplicitField &field, double voxel_size);

/** \brief Whether a surface may be at a point: not farther from the nodes than the data supports. */
bool
isInReach (const LocalField &local, const PolygonizerOptions &options, double voxel_size);

} // namespace erkpa
