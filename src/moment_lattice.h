// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lanes/lanes.h"

#include <erkpa/implicit_field.h>
#include <erkpa/marching_cubes.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <unordered_map>
#include <vector>

namespace erkpa
{

/** \brief Moments of eq. (17) at the points of a lattice, between which they are interpolated.
 *
 * Where supports of a constant radius hold hundreds of nodes and are far larger than voxels, moments hardly change from
 * one evaluation point to the next. So they are summed up at the points of a lattice only: a cluster of evaluation
 * points shares sums, as in a tree code. To interpolate sums is to interpolate the weights of the nodes (cubically):
 * the field is one with weights that are off by no more than errorOf () of the largest, and reproduces its basis
 * exactly all the same.
 */
class MomentLattice
{
public:
  static constexpr int SIDE = 4; ///< points along the side of a brick
  static constexpr std::size_t POINTS = 64;

  /** \brief Points of the lattice that are kept together, and the cells above them. */
  struct Brick
  {
    Eigen::Array3i first;      ///< the lowest point
    Eigen::Vector3d center;    ///< origin of the sums
    std::uint64_t cells = 0;   ///< those that are covered, as bits
    std::uint64_t points = 0;  ///< those that have sums
    std::uint64_t wanted = 0;  ///< those that are to have them
    std::vector<float> sums{}; ///< column after column, in the support radius as unit: see lanes::LatticeMethods
  };

  /** \brief A lattice, without sums, for the evaluations of a grid; null where the nodes serve as well or must serve.
   * \param[in] field,options must live as long as it does
   */
  static std::unique_ptr<MomentLattice>
  make (const ImplicitField &field, const PolygonizerOptions &options, double voxel_size,
        const lanes::Engine &engine = lanes::bestEngine ());

  /** \brief How much interpolated weights differ from a kernel's at most, as a share of its largest weight.
   *
   * That is at a node in the middle of a cell of the lattice, where the kernel bends most.
   * \param[in] per_radius cells of the lattice along a support radius, 4 or more
   */
  static double
  errorOf (const Kernel &kernel, double per_radius);

  /** \brief Cells of a brick, as bits. */
  struct Cells
  {
    Eigen::Array3i first; ///< the lowest of the brick
    std::uint64_t cells;
  };

  /** \brief Add the cell that holds a position (local frame) to a list. */
  void
  listCell (const Eigen::Vector3d &x, std::vector<Cells> &list) const;

  /** \brief Sum up what is missing around cells. */
  void
  cover (const std::vector<Cells> &list);

  /** \brief The brick of a cell or point of the lattice; null where it has none. */
  const Brick *
  brickOf (const Eigen::Array3i &cell) const;

  /** \brief The cell that holds a position. */
  Eigen::Array3i
  cellOf (const Eigen::Vector3d &x) const
  {
    return (x / spacing_).array ().floor ().cast<int> ();
  }

  /** \brief The place of a cell or point in its brick. */
  static std::size_t
  placeOf (const Eigen::Array3i &cell)
  {
    return static_cast<std::size_t> ((cell[0] & 3) | ((cell[1] & 3) << 2) | ((cell[2] & 3) << 4));
  }

  static std::uint64_t
  bitOf (const Eigen::Array3i &cell)
  {
    return std::uint64_t (1) << placeOf (cell);
  }

  double
  spacing () const
  {
    return spacing_;
  }

  /** \brief Sums per point, those of attributes as well. */
  std::size_t
  columns () const
  {
    return columns_;
  }

  /** \brief Number of points that have sums. */
  std::size_t
  size () const
  {
    return size_;
  }

private:
  struct Worker;

  MomentLattice (const ImplicitField &field, const PolygonizerOptions &options, double spacing,
                 const lanes::Engine &engine);

  Brick &
  placeBrick (const Eigen::Array3i &first);

  void
  wantPointsOf (const Eigen::Array3i &cell);

  void
  sumUp (Worker &worker, Brick &brick) const;

  const ImplicitField &field_;
  const PolygonizerOptions &options_;
  const lanes::Engine &engine_;
  double spacing_;
  std::size_t columns_, size_ = 0;
  std::unordered_map<std::uint64_t, Brick *> index_;
  std::deque<Brick> bricks_;
};

} // namespace erkpa
