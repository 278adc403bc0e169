// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "block_points.h"
#include "moment_lattice.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief The points of a MomentLattice around those of one ball, as the lanes read them. Arrays keep their memory. */
class BlockLattice
{
public:
  /** \param[in] lattice null: nothing is covered */
  BlockLattice (const MomentLattice *lattice, const lanes::Engine &engine, std::size_t channels)
      : lattice_ (lattice), engine_ (engine), channels_ (channels)
  {
  }

  /** \brief Forget the points of the ball before. */
  void
  clear ()
  {
    box_ = Box ();
  }

  /** \brief Whether the moments at a point (local frame) can be interpolated. */
  bool
  covers (const Eigen::Vector3d &x);

  /** \brief Evaluate the field at points that are covered, with a \a center as origin and \a unit as length.
   * \return false, and nothing is evaluated, where they lie too far apart
   */
  bool
  evaluate (const lanes::Settings &settings, const Eigen::Vector3d &center, double unit, BlockPoints &points);

private:
  /** \brief Points of the lattice. */
  struct Box
  {
    Eigen::Array3i low = Eigen::Array3i::Zero (), sides = Eigen::Array3i::Zero ();

    bool
    contains (const Box &other) const
    {
      return (other.low >= low).all () && (other.low + other.sides <= low + sides).all ();
    }
  };

  void
  findBox (const Eigen::Vector3d &center, double unit, const BlockPoints &points, Box &box) const;

  void
  copySums (const Eigen::Vector3d &center, double unit);

  void
  copyRow (const Eigen::Array3i &first, std::size_t place, const Eigen::Vector3d &center, double unit);

  const MomentLattice *lattice_;
  const lanes::Engine &engine_;
  std::size_t channels_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  Box box_; // whose sums are there, about the center
  std::size_t stride_ = 0;
  const MomentLattice::Brick *last_ = nullptr; // that covered a point
  std::array<std::vector<float>, 3> steps_;    // from the origins of their sums
  std::vector<float> sums_, records_;
};

} // namespace erkpa
