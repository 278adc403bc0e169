// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/sharp_edges_from_faces.h>

#include "node_table.h"
#include "noise.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <utility>

namespace erkpa
{

namespace
{

constexpr double SAME_NORMAL = 0.8;   // cosine: points of a face have its normal within 37 degrees
constexpr double SAME_FACE = 0.17;    // sine: faces at less than 10 degrees make no edge
constexpr double NEAR = 2.5;          // spacings: how far points near the curve may be from it
constexpr std::size_t FEW_POINTS = 3; // fewer near the curve make no edge

/** \brief A face turned outside, and the points on it, in the frame of the cloud. */
struct OrientedFace
{
  SharpSurface::ConstPtr surface;
  std::vector<Eigen::Vector3d> points;
};

/** \brief A place on the curve where two faces are zero, and how far the point is from which it was found. */
struct Foot
{
  Eigen::Vector3d position;
  double distance;
};

/** \brief Finds the edges between faces. */
class EdgeFinder
{
public:
  EdgeFinder (const OrientedPoints &points, double tolerance);

  /** \brief The faces that a surface stands for: one for each side on which its points have their normals. */
  void
  addFaces (const SharpSurface::ConstPtr &surface);

  std::vector<SharpSurface::ConstPtr>
  edges () const;

private:
  /** \brief The places on the curve that points of the first face are near to. */
  std::vector<Foot>
  feetOf (const OrientedFace &face, const OrientedFace &other) const;

  bool
  findFoot (const SharpSurface &a, const SharpSurface &b, const Eigen::Vector3d &from, Foot &foot) const;

  /** \brief Adds the feet that have one of the other face beside them. */
  void
  addMatched (const std::vector<Foot> &feet, const std::vector<Foot> &others,
              std::vector<Eigen::Vector3d> &curve) const;

  /** \brief One of the points in each cell of a grid. */
  std::vector<Eigen::Vector3d>
  thinned (const std::vector<Eigen::Vector3d> &curve) const;

  SharpSurface::ConstPtr
  edgeBetween (const OrientedFace &face, const OrientedFace &other) const;

  const OrientedPoints &points_;
  double spacing_, tolerance_;
  double near_;    // how far points near a curve are from it
  double support_; // radius of the field's support, where it is chosen from the noise
  std::vector<OrientedFace> faces_;
};

EdgeFinder::EdgeFinder (const OrientedPoints &points, double tolerance) : points_ (points)
{
  const NeighborSearch::ConstPtr search = makeGridSearch (points.positions, 1);
  spacing_ = measureSpacing (points.positions, *search, 1);
  tolerance_ = tolerance > 0.0 ? tolerance : 0.5 * spacing_;
  near_ = NEAR * spacing_ + tolerance_;
  support_ = spacing_ * std::sqrt (chooseSupportSizes (points, *search, 1).within_faces / M_PI);
}

void
EdgeFinder::addFaces (const SharpSurface::ConstPtr &surface)
{
  std::array<OrientedFace, 2> sides;
  for (std::size_t i = 0; i < points_.size (); ++i)
  {
    const Eigen::Vector3d position = points_.positions[i].cast<double> () + points_.origin;
    if (!(std::abs (surface->theta (position)) <= tolerance_))
      continue;
    const double cosine = surface->thetaGradient (position).dot (points_.normals[i].cast<double> ());
    if (std::abs (cosine) > SAME_NORMAL)
      sides[cosine > 0.0 ? 0 : 1].points.push_back (position);
  }
  sides[0].surface = surface;
  sides[1].surface = makeReversed (surface);
  for (OrientedFace &side : sides)
    if (side.points.size () >= FEW_POINTS)
      faces_.push_back (std::move (side));
}

bool
EdgeFinder::findFoot (const SharpSurface &a, const SharpSurface &b, const Eigen::Vector3d &from, Foot &foot) const
{
  constexpr int STEPS = 10;
  constexpr double CLOSE = 1e-3; // spacings
  Eigen::Vector3d x = from;
  for (int step = 0; step < STEPS && (x - from).norm () <= 2.0 * near_; ++step)
  {
    Eigen::Matrix<double, 2, 3> slopes;
    slopes << a.thetaGradient (x).transpose (), b.thetaGradient (x).transpose ();
    const Eigen::Matrix2d products = slopes * slopes.transpose ();
    if (!(products.determinant () > SAME_FACE * SAME_FACE)) // the square of the sine between the unit gradients
      return false;
    const Eigen::Vector2d heights (a.theta (x), b.theta (x));
    const Eigen::Vector3d way = slopes.transpose () * (products.inverse () * heights);
    x -= way;
    if (way.norm () > CLOSE * spacing_)
      continue;
    foot = {x, (x - from).norm ()};
    return foot.distance <= near_;
  }
  return false;
}

std::vector<Foot>
EdgeFinder::feetOf (const OrientedFace &face, const OrientedFace &other) const
{
  std::vector<Foot> feet;
  Foot foot;
  for (const Eigen::Vector3d &point : face.points)
    if (std::abs (other.surface->theta (point)) <= near_ && findFoot (*face.surface, *other.surface, point, foot))
      feet.push_back (foot);
  return feet;
}

void
EdgeFinder::addMatched (const std::vector<Foot> &feet, const std::vector<Foot> &others,
                        std::vector<Eigen::Vector3d> &curve) const
{
  // From the first foot, for the tree works in float.
  const Eigen::Vector3d origin = others.front ().position;
  std::vector<Eigen::Vector3f> positions;
  for (const Foot &foot : others)
    positions.emplace_back ((foot.position - origin).cast<float> ());
  const NeighborSearch::ConstPtr search = makeKdTreeSearch (positions);
  std::vector<int> nearest;
  std::vector<float> squared;
  for (const Foot &foot : feet)
  {
    search->nearestK ((foot.position - origin).cast<float> (), 1, nearest, squared);
    if (!nearest.empty () && std::sqrt (static_cast<double> (squared.front ())) <= NEAR * spacing_)
      curve.push_back (foot.position);
  }
}

std::vector<Eigen::Vector3d>
EdgeFinder::thinned (const std::vector<Eigen::Vector3d> &curve) const
{
  const double side = 0.5 * spacing_;
  std::set<std::array<double, 3>> cells;
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d &p : curve)
  {
    const Eigen::Vector3d cell = ((p - points_.origin) / side).array ().floor ();
    if (cells.insert ({cell[0], cell[1], cell[2]}).second)
      points.push_back (p);
  }
  return points;
}

/** \brief Whether a face goes on up to the curve; before a chamfer or a fillet it ends at a distance. */
bool
reachesCurve (const std::vector<Foot> &feet, double near)
{
  const auto is_close = [&] (const Foot &foot) { return foot.distance < 0.5 * near; };
  const auto close = static_cast<std::size_t> (std::count_if (feet.begin (), feet.end (), is_close));
  return feet.size () >= FEW_POINTS && 4 * close >= feet.size (); // half of them, where points are spread evenly
}

SharpSurface::ConstPtr
EdgeFinder::edgeBetween (const OrientedFace &face, const OrientedFace &other) const
{
  const std::vector<Foot> feet = feetOf (face, other), other_feet = feetOf (other, face);
  if (!reachesCurve (feet, near_) || !reachesCurve (other_feet, near_))
    return nullptr;
  std::vector<Eigen::Vector3d> curve;
  addMatched (feet, other_feet, curve);
  addMatched (other_feet, feet, curve);
  if (curve.size () < 2 * FEW_POINTS)
    return nullptr;
  // The whole support around the edge must be within, and supports may be wider than the automatic ones.
  Extent::ConstPtr extent;
  if (!makePointsExtent (thinned (curve), support_, extent).ok ())
    return nullptr;
  return makeLimited (makeSharpBetween (face.surface, other.surface), extent);
}

std::vector<SharpSurface::ConstPtr>
EdgeFinder::edges () const
{
  std::vector<SharpSurface::ConstPtr> edges;
  for (std::size_t a = 0; a < faces_.size (); ++a)
    for (std::size_t b = a + 1; b < faces_.size (); ++b)
      if (SharpSurface::ConstPtr edge = edgeBetween (faces_[a], faces_[b]))
        edges.push_back (std::move (edge));
  return edges;
}

} // namespace

Outcome
sharpEdgesFromFaces (const OrientedPoints &points, const std::vector<FaceModel> &faces, double tolerance,
                     std::vector<SharpSurface::ConstPtr> &surfaces)
{
  if (!(tolerance >= 0.0) || !std::isfinite (tolerance))
    return {Status::INVALID_SETTING,
            "the tolerance of faces must be a positive, finite length, or 0 for half the spacing of the points"};
  if (std::none_of (points.normals.begin (), points.normals.end (),
                    [] (const Eigen::Vector3f &normal) { return normal.squaredNorm () > 0.0f; }))
    return {Status::NO_NORMALS, "sharp edges between faces need points with normals: estimate them first"};
  std::vector<SharpSurface::ConstPtr> models (faces.size ());
  for (std::size_t i = 0; i < faces.size (); ++i)
  {
    const Outcome outcome = makeSharpSurface (faces[i].model, faces[i].coefficients, models[i]);
    if (!outcome.ok ())
      return {outcome.status, "face " + std::to_string (i) + " (counted from 0): " + outcome.message};
  }
  EdgeFinder finder (points, tolerance);
  for (const SharpSurface::ConstPtr &model : models)
    finder.addFaces (model);
  surfaces = finder.edges ();
  return {};
}

} // namespace erkpa
