// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/face_of_points.h>
#include <erkpa/implicit_field.h>

#include <algorithm>
#include <mutex>
#include <utility>

namespace erkpa
{

namespace
{

constexpr std::size_t FEWEST_POINTS = 5; // that a support must hold

class FaceOfPoints : public SharpSurface
{
public:
  explicit FaceOfPoints (std::shared_ptr<const FacePoints> face) : face_ (std::move (face)) {}

  double
  theta (const Eigen::Vector3d &x) const override
  {
    return sample (x).value;
  }

  Eigen::Vector3d
  thetaGradient (const Eigen::Vector3d &x) const override
  {
    return sample (x).gradient;
  }

  void
  evaluate (const Eigen::Vector3d &x, double &theta, Eigen::Vector3d &gradient) const override
  {
    const FieldSample both = sample (x);
    theta = both.value;
    gradient = both.gradient;
  }

  SharpSurfaceParts
  parts () const override
  {
    SharpSurfaceParts parts;
    parts.kind = SharpSurfaceParts::Kind::POINTS;
    parts.points = face_;
    return parts;
  }

private:
  const ImplicitField &
  field () const
  {
    std::call_once (built_, [this] { build (); });
    return *field_;
  }

  FieldSample
  sample (const Eigen::Vector3d &x) const
  {
    const FieldSample sample = field ().sample (x);
    return sample.isDefined () ? sample : sampleTangentPlane (x);
  }

  void
  build () const;

  /** \brief What the nearest point alone says. */
  FieldSample
  sampleTangentPlane (const Eigen::Vector3d &x) const;

  std::shared_ptr<const FacePoints> face_;
  mutable std::once_flag built_;
  mutable std::unique_ptr<const ImplicitField> field_;
};

void
FaceOfPoints::build () const
{
  const auto points = std::make_shared<OrientedPoints> ();
  points->origin = face_->origin;
  points->positions = face_->positions;
  points->normals = face_->normals;
  FieldOptions options;
  options.k = std::min (face_->k, static_cast<int> (face_->positions.size ()));
  field_ = std::make_unique<const ImplicitField> (points, makeKdTreeSearch (points->positions), options);
}

FieldSample
FaceOfPoints::sampleTangentPlane (const Eigen::Vector3d &x) const
{
  std::vector<int> nearest;
  std::vector<float> squared;
  const Eigen::Vector3d local = x - face_->origin;
  if (local.allFinite ())
    field ().search ().nearestK (local.cast<float> (), 1, nearest, squared);
  if (nearest.empty ())
    return {};
  const auto i = static_cast<std::size_t> (nearest.front ());
  FieldSample sample;
  sample.gradient = face_->normals[i].cast<double> ();
  sample.value = sample.gradient.dot (local - face_->positions[i].cast<double> ());
  return sample;
}

} // namespace

SharpSurface::ConstPtr
makeFaceOfPoints (std::vector<Eigen::Vector3f> positions, std::vector<Eigen::Vector3f> normals,
                  const Eigen::Vector3d &origin, int k)
{
  const auto is_finite = [] (const Eigen::Vector3f &v) { return v.allFinite (); };
  const auto is_normal = [] (const Eigen::Vector3f &v) { return v.allFinite () && v.squaredNorm () > 0.0f; };
  if (positions.size () < FEWEST_POINTS || normals.size () != positions.size () || !origin.allFinite () ||
      (k != 0 && k < static_cast<int> (FEWEST_POINTS)))
    return nullptr;
  if (!std::all_of (positions.begin (), positions.end (), is_finite) ||
      !std::all_of (normals.begin (), normals.end (), is_normal))
    return nullptr;
  constexpr float ROUNDING = 1e-6f; // normals of unit length stay as they are
  for (Eigen::Vector3f &normal : normals)
    if (std::abs (normal.norm () - 1.0f) > ROUNDING)
      normal.normalize ();
  const auto face = std::make_shared<FacePoints> ();
  face->positions = std::move (positions);
  face->normals = std::move (normals);
  face->origin = origin;
  face->k = k;
  return std::make_shared<FaceOfPoints> (face);
}

const FacePoints *
pointsBehind (const SharpSurface &surface)
{
  SharpSurfaceParts parts = surface.parts ();
  while (parts.kind == SharpSurfaceParts::Kind::LIMITED)
    parts = parts.surface->parts ();
  return parts.points.get (); // the surface holds them, too
}

} // namespace erkpa
