// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lanes/lanes.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bench
{

/** \brief Floating-point operations that a node takes at an evaluation point in whose support it is.
 *
 * Counted from lane_weights.h, lane_moments.h, lane_fit.h and the paper's kernel, nodes without values: sums, products
 * and estimates of roots are one, multiply-adds two. Comparisons, selections and conversions are none, and what does
 * not grow with the nodes of a point is left out: the system's solution, the search for the k-th neighbour with the
 * nodes that turn out to be too far, and what a node brings to all points alike.
 *
 *     x_i - x and its square, t, w(t)                     9 + 6 + 8
 *     M and b of eq. (17)                                 2 for each different product of two terms, and with the
 *                                                         Hermite constraint for each term that has a slope
 *     what eq. (2) asks for, where it is fitted           7 + 2 n
 *
 * and for gradients, which sum a second time over the nodes,
 *
 *     the same, with u and t²                             23 + 3 + 3 + 1, and 6 for the quadratic basis' products
 *     the fit's and the shape function's values           4 (n - 1), and 2 for their product
 *     their gradients                                     11, with 12 for the spherical and 48 for the quadratic basis
 *     eq. (2) instead                                     13, and 7 for the constant basis' centroid
 *     dw/dt / t, the force, what moves with x and ε       4 + 1 + 6 + 4
 */
double
flopsPerPair (erkpa::lanes::Basis basis, erkpa::lanes::Constraint constraint, bool gradients);

/** \brief What a benchmark evaluates. */
struct LaneCase
{
  erkpa::lanes::Basis basis;
  erkpa::lanes::Constraint constraint;
  int k;             ///< neighbours in the support; 0 = constant radius, and all nodes are in all supports
  std::size_t nodes; ///< with constant radius
  bool gradients;
};

/** \brief A block of evaluation points and the nodes around it, as BlockField hands them to an Engine. */
class LaneProblem
{
public:
  explicit LaneProblem (const LaneCase &what);

  void
  evaluate (const erkpa::lanes::Engine &engine);

  /** \brief Pairs of an evaluation point and a node in its support, of the last evaluation. */
  std::size_t
  pairs () const;

  /** \brief Whether f was defined at all points. */
  bool
  isDefined () const;

  std::size_t
  points () const
  {
    return POINTS;
  }

private:
  static constexpr std::size_t POINTS = 64; // of a block of the grid

  void
  makeNodes (std::size_t count, double extent);

  void
  makePoints (double half);

  erkpa::lanes::Settings settings_{};
  std::vector<float> positions_[3], normals_[3];
  std::size_t node_count_ = 0;

  std::vector<float> points_[3], bounds_, guesses_;

  std::vector<float> values_, radii_, border_offsets_, gradients_[3];
  std::vector<std::uint8_t> in_reach_;
  std::vector<erkpa::lanes::State> states_;
  std::vector<std::uint32_t> supports_, list_;
  std::vector<float> near_, rows_;
};

} // namespace bench
