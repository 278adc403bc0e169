// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <functional>
#include <memory>

namespace erkpa
{

/** \brief A smooth, invertible map of space with its Jacobian: a bend, a twist, a taper.
 *
 * Implementations are const and safe from several threads.
 */
class SpaceWarp
{
public:
  using ConstPtr = std::shared_ptr<const SpaceWarp>;

  SpaceWarp () = default;
  SpaceWarp (const SpaceWarp &) = delete;
  SpaceWarp &
  operator= (const SpaceWarp &) = delete;
  virtual ~SpaceWarp () = default;

  /** \brief Where the point x goes. */
  virtual Eigen::Vector3d
  map (const Eigen::Vector3d &x) const = 0;

  /** \brief ∂map_i / ∂x_j at x. */
  virtual Eigen::Matrix3d
  jacobian (const Eigen::Vector3d &x) const = 0;

  /** \brief Finds the x that goes to \a y, by Newton's method.
   * \param[in] y a point of the warped space
   * \param[in,out] x a guess; the result
   * \param[in] tolerance how far map (x) may miss y, a length
   * \return false where the method does not converge; x is undefined then
   */
  bool
  invert (const Eigen::Vector3d &y, Eigen::Vector3d &x, double tolerance) const;
};

/** \brief A warp from two functions. */
SpaceWarp::ConstPtr
makeSpaceWarp (std::function<Eigen::Vector3d (const Eigen::Vector3d &)> map,
               std::function<Eigen::Matrix3d (const Eigen::Vector3d &)> jacobian);

} // namespace erkpa
