// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/space_warp.h>
#include <erkpa/status.h>

#include <Eigen/Core>

#include <functional>
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

/** \brief A sharp surface from a function θ and its gradient; null where one of them is missing. */
SharpSurface::ConstPtr
makeSharpFunction (std::function<double (const Eigen::Vector3d &)> theta,
                   std::function<Eigen::Vector3d (const Eigen::Vector3d &)> theta_gradient);

/** \brief A sharp surface seen through a map of space: θ(map (x)), for example a plane that is twisted.
 * \param[in] surface the surface before the warp
 * \param[in] back maps the space of the cloud to that of \a surface (the twist undone)
 * \return null where one of them is
 */
SharpSurface::ConstPtr
makeWarpedSharpSurface (SharpSurface::ConstPtr surface, SpaceWarp::ConstPtr back);

/** \brief The surfaces that coefficients can describe, with the coefficients that PCL's models of them have. */
enum class SurfaceModel
{
  PLANE,    ///< a, b, c, d of a x + b y + c z + d = 0, of any scale
  SPHERE,   ///< center x, y, z, radius
  CYLINDER, ///< point on the axis x, y, z, direction of the axis x, y, z, radius
  CONE      ///< apex x, y, z, direction of the axis x, y, z, angle between axis and side in radians
};

/** \brief A sharp surface from coefficients; θ is the signed distance, positive outside (for a plane, where its normal
 * points).
 * \param[in] model what the coefficients describe
 * \param[in] coefficients as SurfaceModel lists them; finite, directions not zero, radii positive, angle in (0, π/2)
 * \param[out] surface untouched on error
 * \return Status::INVALID_SETTING with the reason where the coefficients make no surface
 */
Outcome
makeSharpSurface (SurfaceModel model, const std::vector<float> &coefficients, SharpSurface::ConstPtr &surface);

/** \brief The sharp surface between two faces that meet in an edge: θ = f_other - f_face.
 *
 * Where both faces are known this is the best choice, for straight edges and for curved ones as the rim of a cylinder:
 * max and min of the faces are then face + θH(θ) and other - θH(θ), whatever the angle between them.
 * \param[in] face its θ is the signed distance f to the face, positive outside the solid
 * \param[in] other the same for the other face
 * \return null where one of them is; a SharpPlane for two planes (null where they are parallel)
 */
SharpSurface::ConstPtr
makeSharpBetween (SharpSurface::ConstPtr face, SharpSurface::ConstPtr other);

/** \brief The plane behind a sharp surface that is a plane or a warped one, and the warp; null where it is none. */
const SharpPlane *
planeBehind (const SharpSurface &surface, const SpaceWarp **warp = nullptr);

} // namespace erkpa
