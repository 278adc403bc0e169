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
 * Counted from the formulas of lane_fit.h, lane_terms.h and the paper's kernel, Hermite constraints without values of
 * the nodes (functional ones for the constant basis, which has no gradient to fit): sums, products, quotients and roots
 * are one, multiply-adds two. Comparisons, selections and conversions are none, and what does not grow with the nodes
 * is left out: the system's solution, and the search for the k-th neighbour with the nodes that turn out to be too far.
 *
 *     x_i - x, its square, t, w(t)                          8 + 2 + 8
 *     w R                                                   n - 1, and 6 for the quadratic basis' products
 *     M += w R R^T (eq. 17)                                 n + n (n - 1)
 *     right-hand side                                       6 linear, 14 spherical, 36 quadratic; 8 constant
 *
 * and for gradients, which sum a second time over the nodes,
 *
 *     x_i - x, its square, t, w(t), u, t²                   18 + 3 + 1, and 6 for the quadratic basis' products
 *     the fit's and the shape function's values             4 (n - 1), and 2 for their product
 *     their gradients                                       11, with 12 for the spherical basis and 48 for the
 * quadratic; constant: 7 for the centroid and 13 for eq. (2) dw/dt / t, the force, what moves with x and with ε    4 +
 * 1 + 6 + 4
 */
double
flopsPerPair (erkpa::lanes::Basis basis, bool gradients);

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
