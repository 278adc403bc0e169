// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cell_mesher.h"
#include "crease_solver.h"
#include "feature_loops.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace erkpa
{

/** \brief Neighbours on a loop between which a crease may run. */
struct Passage
{
  std::size_t loop; ///< place of the loop among those that are meshed together
  int a, b;
  bool is_crease;
};

/** \brief The way to the vertex on the crease or corner inside one loop. */
class CreaseLoop
{
public:
  static constexpr double REACH = 2.5; ///< voxels that the vertex may be away from the middle of the loop

  /** \param[out] result what is found
   * \param[in] iso,voxel the level of the surface, and the side of a grid cell
   */
  CreaseLoop (const CellLoop &loop, const SurfaceVertices &vertices, double iso, double voxel, MeshedLoop &result);

  /** \brief Middle of its vertices. */
  const Eigen::Vector3d &
  around () const
  {
    return around_;
  }

  MeshedLoop &
  result ()
  {
    return *result_;
  }

  /** \brief Append the neighbours that are on different sides of a sharp surface, and may have a crease between them.
   */
  void
  listPassages (std::size_t own_place, std::vector<Passage> &passages) const;

  /** \brief Note that a crease runs between two neighbours. */
  void
  cross (int a, int b);

  /** \brief Set out from near the middle for the crease or corner between all sides. */
  void
  start ();

  /** \brief Set out along the crease to where the vertex lies on the inner side of all sides of the loop that the
   * crease does not cross, so that no triangle is turned over; stay where it does. */
  void
  startInside ();

  /** \brief On its way; null where it is not. */
  CreaseSolver *
  solver ()
  {
    return solver_ && solver_->isAtWork () ? &*solver_ : nullptr;
  }

  /** \brief Take up what was found on the way, if it was; what was found before stands otherwise. */
  void
  arrive ();

  /** \brief Face and normal of the vertex that was found: the mean of its faces' normals. */
  void
  describe ();

private:
  const Eigen::Vector3d &
  position (int v) const
  {
    return vertices_->positions[static_cast<std::size_t> (v)];
  }

  const Eigen::Vector3d &
  normalOf (int v) const
  {
    return vertices_->normals[static_cast<std::size_t> (v)];
  }

  std::uint64_t
  keyOf (int v) const
  {
    return vertices_->side_keys[static_cast<std::size_t> (v)];
  }

  int
  next (std::size_t i) const
  {
    return loop_->ring[(i + 1) % loop_->ring.size ()];
  }

  bool
  isSingle () const;

  Eigen::Vector3d
  middleOfCrossings () const;

  Eigen::Vector3d
  minimizeDistances () const;

  void
  setOut (const Eigen::Vector3d &from);

  const CellLoop *loop_;
  const SurfaceVertices *vertices_;
  double iso_, voxel_;
  MeshedLoop *result_;
  Eigen::Vector3d around_ = Eigen::Vector3d::Zero ();
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero (); // that the vertex is sought near
  std::vector<int> sides_;                            // a vertex on each side of the creases
  std::optional<CreaseSolver> solver_;
  std::vector<Eigen::Vector3d> gradients_; // of the pieces of f on the sides, where the vertex is
};

} // namespace erkpa
