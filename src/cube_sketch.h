// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>

namespace erkpa
{

/** \brief f over a cube, from its values and gradients at the middles of the cube's octants.
 *
 * Σ w_i (f_i + ½ ∇f_i·(x - x_i)) with the trilinear weights w_i of the middles x_i. Exact where f is quadratic: there
 * the weighted values err by Σ w_i (x - x_i)ᵀ H (x - x_i) / 2, and the weighted tangent planes by the same to the other
 * side.
 */
class CubeSketch
{
public:
  static constexpr std::size_t OCTANTS = 8;

  /** \param[in] low middle of the lowest octant
   * \param[in] side of an octant
   */
  CubeSketch (const Eigen::Vector3d &low, double side) : low_ (low), side_ (side) {}

  /** \brief The middle of an octant; bit 0 is x, bit 1 is y, bit 2 is z. */
  Eigen::Vector3d
  middle (std::size_t octant) const
  {
    return low_ + side_ * Eigen::Vector3d (octant & 1 ? 1.0 : 0.0, octant & 2 ? 1.0 : 0.0, octant & 4 ? 1.0 : 0.0);
  }

  void
  set (std::size_t octant, double value, const Eigen::Vector3d &gradient)
  {
    values_[octant] = value;
    gradients_[octant] = gradient;
  }

  /** \brief The length of the longest gradient. */
  double
  steepest () const;

  Eigen::Vector3d
  center () const
  {
    return low_ + Eigen::Vector3d::Constant (0.5 * side_);
  }

  /** \brief f at points of a line along x.
   * \param[in] first the first of them
   * \param[in] step from one to the next
   */
  template <std::size_t N>
  void
  valuesOnLine (const Eigen::Vector3d &first, double step, std::array<double, N> &values) const;

private:
  Eigen::Vector3d low_;
  double side_;
  std::array<double, OCTANTS> values_{};
  std::array<Eigen::Vector3d, OCTANTS> gradients_;
};

inline double
CubeSketch::steepest () const
{
  double steepest = 0.0;
  for (const Eigen::Vector3d &gradient : gradients_)
    steepest = std::max (steepest, gradient.norm ());
  return steepest;
}

template <std::size_t N>
void
CubeSketch::valuesOnLine (const Eigen::Vector3d &first, double step, std::array<double, N> &values) const
{
  // The weighted sums over y and z first: what is left is linear in x on either side.
  const double v = (first[1] - low_[1]) / side_, w = (first[2] - low_[2]) / side_;
  std::array<double, 2> sums{}, slopes{};
  for (std::size_t i = 0; i < OCTANTS; ++i)
  {
    const double weight = (i & 2 ? v : 1.0 - v) * (i & 4 ? w : 1.0 - w);
    const Eigen::Vector3d &g = gradients_[i];
    const double dy = side_ * (v - (i & 2 ? 1.0 : 0.0)), dz = side_ * (w - (i & 4 ? 1.0 : 0.0));
    sums[i & 1] += weight * (values_[i] + 0.5 * (g[1] * dy + g[2] * dz));
    slopes[i & 1] += weight * 0.5 * g[0];
  }
  for (std::size_t i = 0; i < N; ++i)
  {
    const double d = first[0] + static_cast<double> (i) * step - low_[0], u = d / side_;
    values[i] = (1.0 - u) * (sums[0] + slopes[0] * d) + u * (sums[1] + slopes[1] * (d - side_));
  }
}

} // namespace erkpa
