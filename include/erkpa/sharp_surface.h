// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/status.h>

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace erkpa
{

/** \brief A surface Γ = {θ = 0} that cuts a sharp edge: across it the gradient of the field may jump (eq. 21).
 *
 * θ must be close to a signed distance (|∇θ| about 1 near Γ): its value tells how far Γ is. Coordinates are
 * those of the input cloud. Implementations are const and safe from several threads.
 */
class SharpSurface
{
public:
  using ConstPtr = std::shared_ptr<const SharpSurface>;

  SharpSurface () = default;
  SharpSurface (const SharpSurface &) = delete;
  SharpSurface &
  operator= (const SharpSurface &) = delete;
  virtual ~SharpSurface () = default;

  /** \brief θ(x), in the unit of length of the cloud. */
  virtual double
  theta (const Eigen::Vector3d &x) const = 0;

  /** \brief ∇θ(x). */
  virtual Eigen::Vector3d
  thetaGradient (const Eigen::Vector3d &x) const = 0;
};

/** \brief The plane n·x + d = 0 with |n| = 1. */
class SharpPlane : public SharpSurface
{
public:
  SharpPlane (const Eigen::Vector3d &unit_normal, double offset) : normal_ (unit_normal), offset_ (offset) {}

  double
  theta (const Eigen::Vector3d &x) const override
  {
    return normal_.dot (x) + offset_;
  }

  Eigen::Vector3d
  thetaGradient (const Eigen::Vector3d &) const override
  {
    return normal_;
  }

private:
  Eigen::Vector3d normal_;
  double offset_;
};

/** \brief A plane from coefficients a, b, c, d of any scale.
 * \param[in] coefficients four finite values, not all of a, b, c zero
 * \param[out] surface the plane; untouched on error
 * \return Status::INVALID_SETTING with the reason where the coefficients make no plane
 */
Outcome
makeSharpPlane (const std::vector<float> &coefficients, SharpSurface::ConstPtr &surface);

} // namespace erkpa
