// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/sharp_surface.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace erkpa
{

namespace
{

using Kind = SharpSurfaceParts::Kind;

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

  SharpSurfaceParts
  parts () const override
  {
    SharpSurfaceParts parts;
    parts.kind = Kind::FUNCTION;
    return parts;
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

  double
  presence (const Eigen::Vector3d &x, double radius, PresenceSlope *slope) const override
  {
    const double presence = surface_->presence (back_->map (x), radius, slope);
    if (slope != nullptr)
      slope->by_position = back_->jacobian (x).transpose () * slope->by_position;
    return presence;
  }

  SharpSurfaceParts
  parts () const override
  {
    SharpSurfaceParts parts;
    parts.kind = Kind::WARPED;
    parts.surface = surface_;
    parts.warp = back_;
    return parts;
  }

private:
  ConstPtr surface_;
  SpaceWarp::ConstPtr back_;
};

/** \brief A surface whose presence is that of an extent. */
class LimitedSurface : public SharpSurface
{
public:
  LimitedSurface (ConstPtr surface, Extent::ConstPtr extent, double fade)
      : surface_ (std::move (surface)), extent_ (std::move (extent)), bounds_ (extent_->bounds ()), fade_ (fade)
  {
  }

  double
  theta (const Eigen::Vector3d &x) const override
  {
    return surface_->theta (x);
  }

  Eigen::Vector3d
  thetaGradient (const Eigen::Vector3d &x) const override
  {
    return surface_->thetaGradient (x);
  }

  void
  evaluate (const Eigen::Vector3d &x, double &theta, Eigen::Vector3d &gradient) const override
  {
    surface_->evaluate (x, theta, gradient);
  }

  double
  presence (const Eigen::Vector3d &x, double radius, PresenceSlope *slope) const override;

  bool
  isAbsentIn (const Eigen::Vector3d &center, double radius) const override
  {
    // The distance d grows by at most one in one. By the automatic fade a point with the support radius ε is absent
    // where d >= ε, and the ball reaches ε beyond it.
    const double gone = radius + fade_;
    return bounds_.exteriorDistance (center) >= gone || extent_->distance (center) >= gone ||
           surface_->isAbsentIn (center, radius);
  }

  SharpSurfaceParts
  parts () const override
  {
    SharpSurfaceParts parts;
    parts.kind = Kind::LIMITED;
    parts.surface = surface_;
    parts.extent = extent_;
    parts.fade = fade_;
    return parts;
  }

private:
  ConstPtr surface_;
  Extent::ConstPtr extent_;
  Eigen::AlignedBox3d bounds_;
  double fade_;
};

double
LimitedSurface::presence (const Eigen::Vector3d &x, double radius, PresenceSlope *slope) const
{
  const double start = fade_ > 0.0 ? 0.0 : 0.5 * radius, length = fade_ > 0.0 ? fade_ : 0.5 * radius;
  Eigen::Vector3d away;
  const double distance = extent_->distance (x, slope != nullptr ? &away : nullptr);
  PresenceSlope inner_slope;
  const double inner = surface_->presence (x, radius, slope != nullptr ? &inner_slope : nullptr);
  const double t = std::clamp ((distance - start) / length, 0.0, 1.0), own = 1.0 - t * t * (3.0 - 2.0 * t);
  if (slope == nullptr)
    return inner * own;
  const double by_t = -6.0 * t * (1.0 - t);
  const double t_by_radius = fade_ > 0.0 ? 0.0 : -2.0 * distance / (radius * radius);
  slope->by_position = own * inner_slope.by_position + inner * by_t / length * away;
  slope->by_radius = own * inner_slope.by_radius + inner * by_t * t_by_radius;
  return inner * own;
}

} // namespace

double
SharpSurface::presence (const Eigen::Vector3d & /*x*/, double /*radius*/, PresenceSlope *slope) const
{
  if (slope != nullptr)
    *slope = PresenceSlope ();
  return 1.0;
}

bool
SharpSurface::isAbsentIn (const Eigen::Vector3d & /*center*/, double /*radius*/) const
{
  return false;
}

SharpSurfaceParts
SharpSurface::parts () const
{
  return {};
}

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
makeLimited (SharpSurface::ConstPtr surface, Extent::ConstPtr extent, double fade)
{
  if (!surface || !extent || !(fade >= 0.0) || !std::isfinite (fade))
    return nullptr;
  return std::make_shared<LimitedSurface> (std::move (surface), std::move (extent), fade);
}

const SharpPlane *
planeBehind (const SharpSurface &surface, const SpaceWarp **warp)
{
  if (warp != nullptr)
    *warp = nullptr;
  bool is_warped = false;
  for (SharpSurfaceParts parts = surface.parts ();; parts = parts.surface->parts ())
  {
    if (parts.kind == Kind::WARPED && !is_warped)
    {
      is_warped = true;
      if (warp != nullptr)
        *warp = parts.warp.get ();
    }
    else if (parts.kind != Kind::LIMITED)
      return parts.plane;
  }
}

} // namespace erkpa
