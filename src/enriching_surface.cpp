// SPDX-License-Identifier: BSD-3-Clause
#include "enriching_surface.h"

#include <utility>

namespace erkpa
{

namespace
{

using Kind = SharpSurfaceParts::Kind;

bool
isFieldBehind (const SharpSurface &surface)
{
  const SharpSurfaceParts parts = surface.parts ();
  return parts.kind == Kind::POINTS || (parts.surface && isFieldBehind (*parts.surface)) ||
         (parts.other && isFieldBehind (*parts.other));
}

/** \brief What |∇θ| is at most; 0: not known. */
double
steepnessOf (const SharpSurface &surface)
{
  const SharpSurfaceParts parts = surface.parts ();
  if (parts.plane != nullptr || parts.kind == Kind::MODEL)
    return 1.0;
  if (parts.kind == Kind::REVERSED || parts.kind == Kind::LIMITED)
    return steepnessOf (*parts.surface);
  if (parts.kind != Kind::BETWEEN)
    return 0.0;
  const double one = steepnessOf (*parts.surface), other = steepnessOf (*parts.other);
  return one > 0.0 && other > 0.0 ? one + other : 0.0;
}

} // namespace

EnrichingSurface::EnrichingSurface (SharpSurface::ConstPtr surface)
    : surface_ (std::move (surface)), is_field_ (isFieldBehind (*surface_)), steepness_ (steepnessOf (*surface_))
{
  const SpaceWarp *warp = nullptr;
  const SharpPlane *plane = planeBehind (*surface_, &warp);
  plane_ = warp == nullptr ? plane : nullptr;
  look (*surface_);
}

void
EnrichingSurface::look (const SharpSurface &surface)
{
  const SharpSurfaceParts parts = surface.parts ();
  switch (parts.kind)
  {
    case Kind::MODEL:
    case Kind::BETWEEN:
    case Kind::POINTS:
    case Kind::FUNCTION:
      return;
    case Kind::REVERSED:
      break;
    case Kind::WARPED:
      if (extent_ == nullptr) // one that is inside an extent does not move it
      {
        warp_ = parts.warp.get ();
        ++warps_;
      }
      break;
    case Kind::LIMITED:
      has_known_presence_ = has_known_presence_ && extent_ == nullptr && warps_ <= 1;
      extent_ = parts.extent.get ();
      fade_ = parts.fade;
      break;
    case Kind::OTHER:
      has_known_presence_ = false;
      return;
  }
  look (*parts.surface);
}

double
EnrichingSurface::distanceFromExtent (const Eigen::Vector3d &x, Eigen::Vector3d &away) const
{
  if (warp_ == nullptr)
    return extent_->distance (x, &away);
  const double distance = extent_->distance (warp_->map (x), &away);
  away = warp_->jacobian (x).transpose () * away;
  return distance;
}

} // namespace erkpa
