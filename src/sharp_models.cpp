// SPDX-License-Identifier: BSD-3-Clause
#include "sharp_models.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace erkpa
{

namespace
{

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

  SharpSurfaceParts
  parts () const override
  {
    SharpSurfaceParts parts;
    parts.kind = SharpSurfaceParts::Kind::MODEL;
    parts.model = SurfaceModel::SPHERE;
    parts.coefficients = {center_[0], center_[1], center_[2], radius_};
    return parts;
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
      : point_ (point), axis_ (axis), radius_ (radius), angle_ (angle), cosine_ (std::cos (angle)),
        sine_ (std::sin (angle))
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

  SharpSurfaceParts
  parts () const override
  {
    const bool is_cylinder = radius_ > 0.0;
    SharpSurfaceParts parts;
    parts.kind = SharpSurfaceParts::Kind::MODEL;
    parts.model = is_cylinder ? SurfaceModel::CYLINDER : SurfaceModel::CONE;
    parts.coefficients = {
        point_[0], point_[1], point_[2], axis_[0], axis_[1], axis_[2], is_cylinder ? radius_ : angle_};
    return parts;
  }

private:
  Eigen::Vector3d
  across (const Eigen::Vector3d &x) const
  {
    const Eigen::Vector3d d = x - point_;
    return d - axis_.dot (d) * axis_;
  }

  Eigen::Vector3d point_, axis_;
  double radius_, angle_, cosine_, sine_;
};

/** \brief What a model's coefficients are called in messages. */
const char *
textOf (SurfaceModel model)
{
  switch (model)
  {
    case SurfaceModel::SPHERE:
      return "a sharp sphere needs the four coefficients x, y, z of its center and its radius";
    case SurfaceModel::CYLINDER:
      return "a sharp cylinder needs seven coefficients: a point x, y, z on the axis, the direction x, y, z of the "
             "axis, and the radius";
    case SurfaceModel::CONE:
      return "a sharp cone needs seven coefficients: the apex x, y, z, the direction x, y, z of the axis, and the "
             "angle between axis and side";
    case SurfaceModel::PLANE:
      break;
  }
  return "a sharp edge needs the four coefficients a, b, c, d of a plane a x + b y + c z + d = 0";
}

/** \brief Why the coefficients make no such surface; empty where they do. */
std::string
faultOf (SurfaceModel model, const std::array<double, 7> &c, std::size_t count)
{
  const std::size_t expected = coefficientCount (model);
  if (count != expected)
    return "but " + std::to_string (count) + " are given";
  if (!std::all_of (c.begin (), c.begin () + static_cast<std::ptrdiff_t> (count),
                    [] (double value) { return std::isfinite (value); }))
    return "but one of them is not finite";
  if (model == SurfaceModel::PLANE && c[0] == 0.0 && c[1] == 0.0 && c[2] == 0.0)
    return "but its normal a, b, c is zero";
  if (model == SurfaceModel::SPHERE && !(c[3] > 0.0))
    return "but the radius is not positive";
  if (expected == 7 && c[3] == 0.0 && c[4] == 0.0 && c[5] == 0.0)
    return "but the direction of the axis is zero";
  if (model == SurfaceModel::CYLINDER && !(c[6] > 0.0))
    return "but the radius is not positive";
  // The float nearest to pi/2 is above it, and the one below it stands for an angle that is almost that.
  if (model == SurfaceModel::CONE && !(c[6] > 0.0 && static_cast<float> (c[6]) < static_cast<float> (M_PI_2)))
    return "but the angle is not between 0 and pi/2";
  return "";
}

/** \brief 1 / |v|, and 1 for a v of unit length up to rounding, so that saved surfaces are loaded as they were. */
double
scaleToUnit (const Eigen::Vector3d &v)
{
  constexpr double ROUNDING = 1e-14;
  const double length = v.norm ();
  return std::abs (length - 1.0) < ROUNDING ? 1.0 : 1.0 / length;
}

} // namespace

std::size_t
coefficientCount (SurfaceModel model)
{
  return model == SurfaceModel::CYLINDER || model == SurfaceModel::CONE ? 7 : 4;
}

Outcome
makeModelSurface (SurfaceModel model, const std::array<double, 7> &coefficients, std::size_t count,
                  SharpSurface::ConstPtr &surface)
{
  const std::string fault = faultOf (model, coefficients, count);
  if (!fault.empty ())
    return {Status::INVALID_SETTING, std::string (textOf (model)) + ", " + fault};
  const auto vector = [&] (std::size_t first)
  { return Eigen::Vector3d (coefficients[first], coefficients[first + 1], coefficients[first + 2]); };
  const double last = coefficients[count - 1], scale = scaleToUnit (vector (count - 4));
  switch (model)
  {
    case SurfaceModel::PLANE:
      surface = std::make_shared<SharpPlane> (scale * vector (0), scale * last);
      break;
    case SurfaceModel::SPHERE:
      surface = std::make_shared<SharpSphere> (vector (0), last);
      break;
    case SurfaceModel::CYLINDER:
      surface = std::make_shared<SharpRevolution> (vector (0), scale * vector (3), last, 0.0);
      break;
    case SurfaceModel::CONE:
      surface = std::make_shared<SharpRevolution> (vector (0), scale * vector (3), 0.0, last);
      break;
  }
  return {};
}

SharpSurfaceParts
SharpPlane::parts () const
{
  SharpSurfaceParts parts;
  parts.kind = SharpSurfaceParts::Kind::MODEL;
  parts.coefficients = {normal_[0], normal_[1], normal_[2], offset_};
  parts.plane = this;
  return parts;
}

Outcome
makeSharpSurface (SurfaceModel model, const std::vector<float> &coefficients, SharpSurface::ConstPtr &surface)
{
  std::array<double, 7> values = {};
  for (std::size_t i = 0; i < std::min (values.size (), coefficients.size ()); ++i)
    values[i] = static_cast<double> (coefficients[i]);
  return makeModelSurface (model, values, coefficients.size (), surface);
}

} // namespace erkpa
