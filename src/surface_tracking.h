// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grid_window.h"
#include "local_field.h"
#include "sparse_grid.h"

#include <erkpa/marching_cubes.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace erkpa
{

class MomentLattice;

/** \brief Finds the cells that the surface crosses by following it from the cells of the nodes and those beside them.
 *
 * Works in fronts: the corner values a front needs are found together, block by block (BlockEvaluator), each once; then
 * every crossed cell hands the front on through the faces that the surface passes. Which cells are crossed does not
 * depend on the order, so that a front is a set of blocks, and the cells of a block are looked at together, as bits.
 */
class SurfaceTracker
{
public:
  /** \param[in,out] lattice see BlockField; covers what is evaluated. Null: none */
  SurfaceTracker (const ImplicitField &field, const PolygonizerOptions &options, MomentLattice *lattice,
                  SparseGrid &grid, PolygonizerReport &report, ProgressCallback progress);

  /** \brief Mark the active cells of the grid.
   * \return Status::GRID_TOO_FINE where the surface passes more cells than fit in memory
   */
  Outcome
  track ();

  std::size_t
  nodeCount () const
  {
    return field_.surfacePositions ().size ();
  }

  /** \brief Find the active cell at which a node supports the surface; false where there is none.
   * \param[in,out] window onto the grid
   */
  bool
  findCellOfNode (GridWindow &window, std::size_t node, GridPoint &found) const;

private:
  void
  addToFront (const GridPoint &cell);

  /** \param[in] first the lowest cell of a block */
  void
  addToFront (const GridPoint &first, std::uint64_t cells);

  void
  addToFront (int block, std::uint64_t cells);

  void
  followFront ();

  void
  requestCorners (int block);

  void
  request (int block, std::uint64_t nodes);

  void
  requestCubes ();

  /** \brief Let the lattice cover the requested nodes. */
  void
  coverRequested ();

  void
  evaluateRequested ();

  void
  classifyFront ();

  /** \brief For each face of the cells, down and up along each axis: those fresh cells of a block through which the
   * surface passes on. */
  using PassedFaces = std::array<std::uint64_t, 6>;

  PassedFaces
  classify (int block);

  static PassedFaces
  cutFaces (const std::array<std::uint64_t, 8> &inside);

  void
  handOn (int block, std::uint64_t cells, int axis, bool up);

  /** \brief The cell of the node at a place of the nodes' grid: in that order neighbours follow each other, and so do
   * their blocks in memory. */
  GridPoint
  cellOfPlace (std::size_t place) const;

  /** \brief The faces of a node's cell beyond which its tangent plane goes on, as bits.
   *
   * Starting there as well spares fronts that ask many blocks for a few nodes each.
   */
  unsigned
  facesOfPlane (std::size_t place, const GridPoint &cell) const;

  void
  seedFromNodes ();

  void
  seedFromProjections ();

  static bool
  findCellNear (GridWindow &window, const GridPoint &cell, GridPoint &found);

  const ImplicitField &field_;
  const PolygonizerOptions &options_;
  MomentLattice *lattice_;
  SparseGrid &grid_;
  PolygonizerReport &report_;
  ProgressCallback progress_;
  std::vector<int> front_, next_front_; // blocks with fresh cells
  std::size_t active_count_ = 0;
  std::vector<int> requested_blocks_;
  bool foresees_ = false;                               // see BlockEvaluator
  std::size_t evaluated_blocks_ = 0;                    // a block counts once per front that asks for nodes of it
  std::vector<std::pair<std::size_t, GridPoint>> feet_; // of nodes that lie in no active cell: their cells; sorted
};

} // namespace erkpa
