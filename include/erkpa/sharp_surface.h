// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/extent.h>
#include <erkpa/space_warp.h>
#include <erkpa/status.h>

#include <Eigen/Core>

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace erkpa
{

struct FacePoints;
struct SharpSurfaceParts;

/** \brief How a presence changes. */
struct PresenceSlope
{
  Eigen::Vector3d by_position = Eigen::Vector3d::Zero (); ///< with x, per unit of length
  double by_radius = 0.0;                                 ///< with the support radius, per unit of length
};

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

  /** \brief Both at once, which surfaces override where that saves time. */
  virtual void
  evaluate (const Eigen::Vector3d &x, double &theta, Eigen::Vector3d &gradient) const
  {
    theta = this->theta (x);
    gradient = thetaGradient (x);
  }

  /** \brief How much of the surface is in force at x: 1 in its extent, 0 far from it, C1 between. Always 1 without one.
   * \param[in] x a point
   * \param[in] radius support radius at x, by which an automatic fade goes
   * \param[out] slope where not null
   */
  virtual double
  presence (const Eigen::Vector3d &x, double radius, PresenceSlope *slope = nullptr) const;

  /** \brief Whether the surface is absent at all points whose supports lie in a ball; false where that is not known.
   * \param[in] center, radius the ball, which holds the supports of those points and the points themselves
   */
  virtual bool
  isAbsentIn (const Eigen::Vector3d &center, double radius) const;

  /** \brief What the surface was made from. */
  virtual SharpSurfaceParts
  parts () const;
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

  SharpSurfaceParts
  parts () const override;

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

/** \brief A surface with its other side outside: -θ. The wall of a hole, from the cylinder around it.
 * \return null where \a surface is; a SharpPlane for a plane
 */
SharpSurface::ConstPtr
makeReversed (SharpSurface::ConstPtr surface);

/** \brief A sharp surface that is in force in a region only.
 *
 * A term of the fit belongs to a support, not to a point: to be sharp at an edge, the surface must be present at all
 * points whose supports reach the edge. A region must hence be wider than the edge by a support radius, or the fade
 * be automatic, and then by half of one.
 * \param[in] surface the whole surface
 * \param[in] extent where it is in force
 * \param[in] fade the length outside the extent over which it fades out; 0 = automatic: it stays in force up to half a
 * support radius outside, and is gone at one
 * \return null where one of them is null or \a fade is negative or not finite
 */
SharpSurface::ConstPtr
makeLimited (SharpSurface::ConstPtr surface, Extent::ConstPtr extent, double fade = 0.0);

/** \brief What a sharp surface was made from, to save it, to show it, or to find out which faces meet in it. */
struct SharpSurfaceParts
{
  enum class Kind
  {
    OTHER,    ///< a class of the caller's own: not known
    MODEL,    ///< \a model and \a coefficients
    BETWEEN,  ///< the faces \a surface and \a other
    REVERSED, ///< -θ of \a surface
    WARPED,   ///< \a surface seen through \a warp
    LIMITED,  ///< \a surface within \a extent
    POINTS,   ///< the face \a points
    FUNCTION  ///< of makeSharpFunction ()
  };

  Kind kind = Kind::OTHER;
  SurfaceModel model = SurfaceModel::PLANE;
  std::array<double, 7> coefficients = {};  ///< as many as the model has; normals and directions of unit length
  const SharpPlane *plane = nullptr;        ///< the surface itself where it is a plane, of coefficients or between two
  SharpSurface::ConstPtr surface, other;    ///< the surfaces it was made from
  SpaceWarp::ConstPtr warp;                 ///< of a warped one
  Extent::ConstPtr extent;                  ///< of a limited one
  double fade = 0.0;                        ///< of a limited one, as given to makeLimited ()
  std::shared_ptr<const FacePoints> points; ///< of a face of points
};

/** \brief The plane behind a sharp surface that is a plane, whether warped or limited, and the warp; null where it is
 * none. */
const SharpPlane *
planeBehind (const SharpSurface &surface, const SpaceWarp **warp = nullptr);

/** \brief The faces between which makeSharpBetween () made a surface, limited or not.
 * \param[in] surface any
 * \param[out] face, other the surfaces given to makeSharpBetween (), in that order
 * \param[out] extent of the limited one; null where it is not limited. Of several the outermost
 * \return false where it is no such surface; the others are untouched then
 */
bool
facesBehind (const SharpSurface &surface, SharpSurface::ConstPtr &face, SharpSurface::ConstPtr &other,
             Extent::ConstPtr &extent);

} // namespace erkpa
