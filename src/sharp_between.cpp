// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/sharp_surface.h>

#include <utility>

namespace erkpa
{

namespace
{

using Kind = SharpSurfaceParts::Kind;

/** \brief θ of one face less that of another. */
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

  void
  evaluate (const Eigen::Vector3d &x, double &theta, Eigen::Vector3d &gradient) const override
  {
    double of_face = 0.0;
    Eigen::Vector3d slope;
    face_->evaluate (x, of_face, slope);
    other_->evaluate (x, theta, gradient);
    theta -= of_face;
    gradient -= slope;
  }

  SharpSurfaceParts
  parts () const override
  {
    SharpSurfaceParts parts;
    parts.kind = Kind::BETWEEN;
    parts.surface = face_;
    parts.other = other_;
    return parts;
  }

private:
  ConstPtr face_, other_;
};

class ReversedSurface : public SharpSurface
{
public:
  explicit ReversedSurface (ConstPtr surface) : surface_ (std::move (surface)) {}

  double
  theta (const Eigen::Vector3d &x) const override
  {
    return -surface_->theta (x);
  }

  Eigen::Vector3d
  thetaGradient (const Eigen::Vector3d &x) const override
  {
    return -surface_->thetaGradient (x);
  }

  void
  evaluate (const Eigen::Vector3d &x, double &theta, Eigen::Vector3d &gradient) const override
  {
    surface_->evaluate (x, theta, gradient);
    theta = -theta;
    gradient = -gradient;
  }

  double
  presence (const Eigen::Vector3d &x, double radius, PresenceSlope *slope) const override
  {
    return surface_->presence (x, radius, slope);
  }

  SharpSurfaceParts
  parts () const override
  {
    SharpSurfaceParts parts;
    parts.kind = Kind::REVERSED;
    parts.surface = surface_;
    return parts;
  }

private:
  ConstPtr surface_;
};

/** \brief The same for two planes: a plane, too. */
class PlaneBetween : public SharpPlane
{
public:
  PlaneBetween (const Eigen::Vector3d &unit_normal, double offset, ConstPtr face, ConstPtr other)
      : SharpPlane (unit_normal, offset), face_ (std::move (face)), other_ (std::move (other))
  {
  }

  SharpSurfaceParts
  parts () const override
  {
    SharpSurfaceParts parts;
    parts.kind = Kind::BETWEEN;
    parts.surface = face_;
    parts.other = other_;
    parts.plane = this;
    return parts;
  }

private:
  ConstPtr face_, other_;
};

} // namespace

SharpSurface::ConstPtr
makeSharpBetween (SharpSurface::ConstPtr face, SharpSurface::ConstPtr other)
{
  if (!face || !other)
    return nullptr;
  const auto between = std::make_shared<SharpBetween> (face, other);
  if (face->parts ().plane == nullptr || other->parts ().plane == nullptr)
    return between;
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero (), normal = between->thetaGradient (zero);
  constexpr double PARALLEL = 1e-6;
  if (!(normal.norm () > PARALLEL))
    return nullptr;
  const double offset = between->theta (zero) / normal.norm ();
  return std::make_shared<PlaneBetween> (normal.normalized (), offset, std::move (face), std::move (other));
}

SharpSurface::ConstPtr
makeReversed (SharpSurface::ConstPtr surface)
{
  if (!surface)
    return nullptr;
  const SharpSurfaceParts parts = surface->parts ();
  const auto &c = parts.coefficients;
  if (parts.kind == Kind::MODEL && parts.model == SurfaceModel::PLANE)
    return std::make_shared<SharpPlane> (-Eigen::Vector3d (c[0], c[1], c[2]), -c[3]);
  return std::make_shared<ReversedSurface> (std::move (surface));
}

bool
facesBehind (const SharpSurface &surface, SharpSurface::ConstPtr &face, SharpSurface::ConstPtr &other,
             Extent::ConstPtr &extent)
{
  SharpSurfaceParts parts = surface.parts ();
  const Extent::ConstPtr outermost = parts.extent;
  while (parts.kind == Kind::LIMITED)
    parts = parts.surface->parts ();
  if (parts.kind != Kind::BETWEEN)
    return false;
  face = parts.surface;
  other = parts.other;
  extent = outermost;
  return true;
}

} // namespace erkpa
