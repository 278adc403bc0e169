// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/sharp_surface.h>

#include <cmath>
#include <string>
#include <utility>

namespace erkpa
{

namespace
{

class SharpFunction : public SharpSurface
{
public:
  using Theta = std::function<double (const Eigen::Vector3d &)>;
  using Gradient = std::function<Eigen::Vector3d (const Eigen::Vector3d &)>;

  SharpFunction (Theta theta, Gradient gradient) : theta_ (std::move (theta)), gradient_ (std::move (gradient)) {}

  double
  theta (const Eigen::Vector3d &x) const override
  {
    return theta_ (x);
  }

  Eigen::Vector3d
  thetaGradient (const Eigen::Vector3d &x) const override
  {
    return gradient_ (x);
  }

private:
  Theta theta_;
  Gradient gradient_;
};

class WarpedSharpSurface : public SharpSurface
{
public:
  WarpedSharpSurface (ConstPtr surface, SpaceWarp::ConstPtr back)
      : surface_ (std::move (surface)), back_ (std::move (back))
  {
  }

  double
  theta (const Eigen::Vector3d &x) const override
  {
    return surface_->theta (back_->map (x));
  }

  Eigen::Vector3d
  thetaGradient (const Eigen::Vector3d &x) const override
  {
    return back_->jacobian (x).transpose () * surface_->thetaGradient (back_->map (x));
  }

  const SharpSurface &
  surface () const
  {
    return *surface_;
  }

  const SpaceWarp *
  back () const
  {
    return back_.get ();
  }

private:
  ConstPtr surface_;
  SpaceWarp::ConstPtr back_;
};

class SharpBetween : public SharpSurface
{
public:
  SharpBetween (ConstPtr face, ConstPtr other) : face_ (std::move (face)), other_ (std::move (other)) {}

  double
  theta (const Eigen::Vector3d &x) const override
  {
    return other_->theta (x) - face_->theta (x);
  }

  Eigen::Vector3d
  thetaGradient (const Eigen::Vector3d &x) const override
  {
    return other_->thetaGradient (x) - face_->thetaGradient (x);
  }

private:
  ConstPtr face_, other_;
};

/** \brief v / |v|; any unit vector for v = 0, where a distance has no gradient. */
Eigen::Vector3d
direction (const Eigen::Vector3d &v)
{
  const double length = v.norm ();
  return length > 0.0 ? Eigen::Vector3d (v / length) : Eigen::Vector3d::UnitX ();
}

class SharpSphere : public SharpSurface
{
public:
  SharpSphere (const Eigen::Vector3d &center, double radius) : center_ (center), radius_ (radius) {}

  double
  theta (const Eigen::Vector3d &x) const override
  {
    return (x - center_).norm () - radius_;
  }

  Eigen::Vector3d
  thetaGradient (const Eigen::Vector3d &x) const override
  {
    return direction (x - center_);
  }

private:
  Eigen::Vector3d center_;
  double radius_;
};

/** \brief A surface around an axis whose radius is radius + slope * height: a cylinder or one nappe of a cone. */
class SharpRevolution : public SharpSurface
{
public:
  SharpRevolution (const Eigen::Vector3d &point, const Eigen::Vector3d &axis, double radius, double angle)
      : point_ (point), axis_ (axis), radius_ (radius), cosine_ (std::cos (angle)), sine_ (std::sin (angle))
  {
  }

  double
  theta (const Eigen::Vector3d &x) const override
  {
    const double height = axis_.dot (x - point_);
    return cosine_ * (across (x).norm () - radius_) - sine_ * height;
  }

  Eigen::Vector3d
  thetaGradient (const Eigen::Vector3d &x) const override
  {
    return cosine_ * direction (across (x)) - sine_ * axis_;
  }

private:
  Eigen::Vector3d
  across (const Eigen::Vector3d &x) const
  {
    const Eigen::Vector3d d = x - point_;
    return d - axis_.dot (d) * axis_;
  }

  Eigen::Vector3d point_, axis_;
  double radius_, cosine_, sine_;
};

/** \brief What a model's coefficients are called in messages, and how many there are. */
struct ModelText
{
  const char *text;
  std::size_t count;
};

ModelText
textOf (SurfaceModel model)
{
  switch (model)
  {
    case SurfaceModel::SPHERE:
      return {"a sharp sphere needs the four coefficients x, y, z of its center and its radius", 4};
    case SurfaceModel::CYLINDER:
      return {
          "a sharp cylinder needs seven coefficients: a point x, y, z on the axis, the direction x, y, z of the axis, "
          "and the radius",
          7};
    case SurfaceModel::CONE:
      return {
          "a sharp cone needs seven coefficients: the apex x, y, z, the direction x, y, z of the axis, and the angle "
          "between axis and side",
          7};
    case SurfaceModel::PLANE:
      break;
  }
  return {"a sharp edge needs the four coefficients a, b, c, d of a plane a x + b y + c z + d = 0", 4};
}

/** \brief Why the coefficients make no such surface; empty where they do. */
std::string
faultOf (SurfaceModel model, const std::vector<float> &c)
{
  const std::size_t count = textOf (model).count;
  if (c.size () != count)
    return "but " + std::to_string (c.size ()) + " are given";
  for (const float value : c)
    if (!std::isfinite (value))
      return "but one of them is not finite";
  if (model == SurfaceModel::PLANE && c[0] == 0.0f && c[1] == 0.0f && c[2] == 0.0f)
    return "but its normal a, b, c is zero";
  if (model == SurfaceModel::SPHERE && !(c[3] > 0.0f))
    return "but the radius is not positive";
  if (count == 7 && c[3] == 0.0f && c[4] == 0.0f && c[5] == 0.0f)
    return "but the direction of the axis is zero";
  if (model == SurfaceModel::CYLINDER && !(c[6] > 0.0f))
    return "but the radius is not positive";
  if (model == SurfaceModel::CONE && !(c[6] > 0.0f && c[6] < static_cast<float> (M_PI_2)))
    return "but the angle is not between 0 and pi/2";
  return "";
}

} // namespace

SharpSurface::ConstPtr
makeSharpFunction (std::function<double (const Eigen::Vector3d &)> theta,
                   std::function<Eigen::Vector3d (const Eigen::Vector3d &)> theta_gradient)
{
  if (!theta || !theta_gradient)
    return nullptr;
  return std::make_shared<SharpFunction> (std::move (theta), std::move (theta_gradient));
}

SharpSurface::ConstPtr
makeWarpedSharpSurface (SharpSurface::ConstPtr surface, SpaceWarp::ConstPtr back)
{
  if (!surface || !back)
    return nullptr;
  return std::make_shared<WarpedSharpSurface> (std::move (surface), std::move (back));
}

SharpSurface::ConstPtr
makeSharpBetween (SharpSurface::ConstPtr face, SharpSurface::ConstPtr other)
{
  if (!face || !other)
    return nullptr;
  const auto between = std::make_shared<SharpBetween> (face, other);
  const bool are_planes = dynamic_cast<const SharpPlane *> (face.get ()) != nullptr &&
                          dynamic_cast<const SharpPlane *> (other.get ()) != nullptr;
  if (!are_planes)
    return between;
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero (), normal = between->thetaGradient (zero);
  constexpr double PARALLEL = 1e-6;
  if (!(normal.norm () > PARALLEL))
    return nullptr;
  return std::make_shared<SharpPlane> (normal.normalized (), between->theta (zero) / normal.norm ());
}

Outcome
makeSharpSurface (SurfaceModel model, const std::vector<float> &coefficients, SharpSurface::ConstPtr &surface)
{
  const std::string fault = faultOf (model, coefficients);
  if (!fault.empty ())
    return {Status::INVALID_SETTING, std::string (textOf (model).text) + ", " + fault};
  const auto vector = [&] (std::size_t first)
  { return Eigen::Vector3d (coefficients[first], coefficients[first + 1], coefficients[first + 2]); };
  const double last = coefficients.back ();
  switch (model)
  {
    case SurfaceModel::PLANE:
      surface = std::make_shared<SharpPlane> (vector (0).normalized (), last / vector (0).norm ());
      break;
    case SurfaceModel::SPHERE:
      surface = std::make_shared<SharpSphere> (vector (0), last);
      break;
    case SurfaceModel::CYLINDER:
      surface = std::make_shared<SharpRevolution> (vector (0), vector (3).normalized (), last, 0.0);
      break;
    case SurfaceModel::CONE:
      surface = std::make_shared<SharpRevolution> (vector (0), vector (3).normalized (), 0.0, last);
      break;
  }
  return {};
}

const SharpPlane *
planeBehind (const SharpSurface &surface, const SpaceWarp **warp)
{
  const auto *warped = dynamic_cast<const WarpedSharpSurface *> (&surface);
  if (warp != nullptr)
    *warp = warped != nullptr ? warped->back () : nullptr;
  return dynamic_cast<const SharpPlane *> (warped != nullptr ? &warped->surface () : &surface);
}

} // namespace erkpa
