// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/extent.h>

#include "point_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief |way|, and its gradient with the end that lies nearer to x. */
double
lengthOf (const Eigen::Vector3d &way, Eigen::Vector3d *gradient)
{
  const double length = way.norm ();
  if (gradient != nullptr)
    *gradient = length > 0.0 ? Eigen::Vector3d (way / length) : Eigen::Vector3d::Zero ();
  return length;
}

class BoxExtent : public Extent
{
public:
  explicit BoxExtent (const Eigen::AlignedBox3d &box) : box_ (box) {}

  double
  distance (const Eigen::Vector3d &x, Eigen::Vector3d *gradient) const override
  {
    return lengthOf (x - x.cwiseMax (box_.min ()).cwiseMin (box_.max ()), gradient);
  }

  Eigen::AlignedBox3d
  bounds () const override
  {
    return box_;
  }

  ExtentParts
  parts () const override
  {
    return {ExtentParts::Kind::BOX, {box_.min (), box_.max ()}, 0.0};
  }

private:
  Eigen::AlignedBox3d box_;
};

class PolygonExtent : public Extent
{
public:
  PolygonExtent (std::vector<Eigen::Vector3d> vertices, double thickness);

  double
  distance (const Eigen::Vector3d &x, Eigen::Vector3d *gradient) const override
  {
    const Eigen::Vector3d local = frame_.transpose () * (x - center_);
    Eigen::Vector3d way = Eigen::Vector3d::Zero ();
    way.head<2> () = wayFromPolygon (local.head<2> ());
    if (thickness_ > 0.0)
      way[2] = local[2] - std::clamp (local[2], -thickness_, thickness_);
    const double length = lengthOf (way, gradient);
    if (gradient != nullptr)
      *gradient = frame_ * *gradient;
    return length;
  }

  Eigen::AlignedBox3d
  bounds () const override;

  ExtentParts
  parts () const override
  {
    return {ExtentParts::Kind::POLYGON, vertices_, thickness_};
  }

  /** \brief Why the vertices make no polygon; empty where they do. */
  std::string
  fault () const;

private:
  /** \brief From the nearest point of the polygon to \a p, in its plane; zero inside. */
  Eigen::Vector2d
  wayFromPolygon (const Eigen::Vector2d &p) const;

  bool
  sidesCross () const;

  std::vector<Eigen::Vector3d> vertices_;
  double thickness_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  Eigen::Matrix3d frame_ = Eigen::Matrix3d::Zero (); // columns: two directions in the plane, its normal; 0 without area
  std::vector<Eigen::Vector2d> corners_;             // the vertices in the plane
};

PolygonExtent::PolygonExtent (std::vector<Eigen::Vector3d> vertices, double thickness)
    : vertices_ (std::move (vertices)), thickness_ (thickness)
{
  for (const Eigen::Vector3d &vertex : vertices_)
    center_ += vertex / static_cast<double> (vertices_.size ());
  Eigen::Vector3d area = Eigen::Vector3d::Zero ();
  for (std::size_t i = 0; i < vertices_.size (); ++i)
    area += (vertices_[i] - center_).cross (vertices_[(i + 1) % vertices_.size ()] - center_);
  if (area.norm () > 0.0)
  {
    frame_.col (2) = area.normalized ();
    frame_.col (0) = frame_.col (2).unitOrthogonal ();
    frame_.col (1) = frame_.col (2).cross (frame_.col (0));
  }
  for (const Eigen::Vector3d &vertex : vertices_)
    corners_.emplace_back ((frame_.transpose () * (vertex - center_)).head<2> ());
}

Eigen::Vector2d
PolygonExtent::wayFromPolygon (const Eigen::Vector2d &p) const
{
  bool inside = false;
  Eigen::Vector2d shortest = Eigen::Vector2d::Constant (HUGE_VAL);
  for (std::size_t i = 0; i < corners_.size (); ++i)
  {
    const Eigen::Vector2d &a = corners_[i], &b = corners_[(i + 1) % corners_.size ()];
    const Eigen::Vector2d side = b - a, d = p - a;
    if ((a.y () > p.y ()) != (b.y () > p.y ()) && d.x () < d.y () / side.y () * side.x ())
      inside = !inside;
    const double share = side.squaredNorm () > 0.0 ? std::clamp (d.dot (side) / side.squaredNorm (), 0.0, 1.0) : 0.0;
    const Eigen::Vector2d way = d - share * side;
    if (way.squaredNorm () < shortest.squaredNorm ())
      shortest = way;
  }
  return inside ? Eigen::Vector2d::Zero () : shortest;
}

Eigen::AlignedBox3d
PolygonExtent::bounds () const
{
  constexpr double ALONG = 1e-12; // the normal has no such component but for rounding
  const Eigen::Vector3d normal = frame_.col (2);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector2d &corner : corners_)
    box.extend (center_ + frame_.leftCols<2> () * corner);
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool is_open = !(thickness_ > 0.0) && std::abs (normal[axis]) > ALONG;
    const double more = is_open ? std::numeric_limits<double>::infinity () : thickness_ * std::abs (normal[axis]);
    box.min ()[axis] -= more;
    box.max ()[axis] += more;
  }
  return box;
}

bool
PolygonExtent::sidesCross () const
{
  const auto turn = [this] (std::size_t i, std::size_t j, std::size_t k)
  {
    const std::size_t n = corners_.size ();
    const Eigen::Vector2d a = corners_[j % n] - corners_[i % n], b = corners_[k % n] - corners_[i % n];
    return a.x () * b.y () - a.y () * b.x ();
  };
  for (std::size_t i = 0; i < corners_.size (); ++i)
    for (std::size_t j = i + 2; j < corners_.size (); ++j)
      if (turn (i, i + 1, j) * turn (i, i + 1, j + 1) < 0.0 && turn (j, j + 1, i) * turn (j, j + 1, i + 1) < 0.0)
        return true;
  return false;
}

std::string
PolygonExtent::fault () const
{
  constexpr double ROUGHLY = 0.1; // of the diameter
  Eigen::AlignedBox3d box;
  double height = 0.0;
  for (const Eigen::Vector3d &vertex : vertices_)
  {
    box.extend (vertex);
    height = std::max (height, std::abs (frame_.col (2).dot (vertex - center_)));
  }
  if (!(frame_.col (2).norm () > 0.0))
    return "but its area is zero";
  if (height > ROUGHLY * box.diagonal ().norm ())
    return "but they are not roughly in a plane";
  return sidesCross () ? "but its sides cross: give the vertices in order around it" : "";
}

class PointsExtent : public Extent
{
public:
  PointsExtent (std::vector<Eigen::Vector3d> points, double radius) : points_ (std::move (points)), radius_ (radius)
  {
    for (const Eigen::Vector3d &point : points_)
      center_ += point / static_cast<double> (points_.size ());
    for (const Eigen::Vector3d &point : points_)
      positions_.emplace_back ((point - center_).cast<float> ());
    grid_ = PointGrid (positions_, radius, 1);
  }

  double
  distance (const Eigen::Vector3d &x, Eigen::Vector3d *gradient) const override
  {
    if (!x.allFinite ())
      return HUGE_VAL;
    const Eigen::Vector3f &position = positions_[grid_.index ()[grid_.nearest (x - center_)]];
    const double beyond = lengthOf (x - center_ - position.cast<double> (), gradient) - radius_;
    if (gradient != nullptr && !(beyond > 0.0))
      gradient->setZero ();
    return std::max (beyond, 0.0);
  }

  Eigen::AlignedBox3d
  bounds () const override
  {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d &point : points_)
      box.extend (point);
    const double rounding = 1e-6 * box.diagonal ().norm (); // the positions are floats
    const Eigen::Vector3d more = Eigen::Vector3d::Constant (radius_ + rounding);
    return {box.min () - more, box.max () + more};
  }

  ExtentParts
  parts () const override
  {
    return {ExtentParts::Kind::POINTS, points_, radius_};
  }

private:
  std::vector<Eigen::Vector3d> points_;
  double radius_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  std::vector<Eigen::Vector3f> positions_; // of the points, from the center
  PointGrid grid_;
};

bool
areFinite (const std::vector<Eigen::Vector3d> &points)
{
  return std::all_of (points.begin (), points.end (), [] (const Eigen::Vector3d &p) { return p.allFinite (); });
}

Outcome
bad (const std::string &why)
{
  return {Status::INVALID_SETTING, why};
}

} // namespace

ExtentParts
Extent::parts () const
{
  return {};
}

Outcome
makeBoxExtent (const Eigen::Vector3d &low, const Eigen::Vector3d &high, Extent::ConstPtr &extent)
{
  const std::string needs = "the box of an extent needs two corners, the low one and the high one, ";
  if (!low.allFinite () || !high.allFinite ())
    return bad (needs + "but a coordinate is not finite");
  if ((low.array () > high.array ()).any ())
    return bad (needs + "but a coordinate of the low one is above that of the high one");
  extent = std::make_shared<BoxExtent> (Eigen::AlignedBox3d (low, high));
  return {};
}

Outcome
makePolygonExtent (const std::vector<Eigen::Vector3d> &vertices, double thickness, Extent::ConstPtr &extent)
{
  if (!(thickness >= 0.0) || !std::isfinite (thickness))
    return bad ("the thickness of a polygon's extent must be positive and finite, or 0 for any distance");
  const std::string needs = "the polygon of an extent needs at least three vertices in a plane, ";
  if (vertices.size () < 3)
    return bad (needs + "but " + std::to_string (vertices.size ()) + " are given");
  if (!areFinite (vertices))
    return bad (needs + "but a coordinate is not finite");
  const auto polygon = std::make_shared<PolygonExtent> (vertices, thickness);
  const std::string fault = polygon->fault ();
  if (!fault.empty ())
    return bad (needs + fault);
  extent = polygon;
  return {};
}

Outcome
makePointsExtent (const std::vector<Eigen::Vector3d> &points, double radius, Extent::ConstPtr &extent)
{
  if (!(radius > 0.0) || !std::isfinite (radius))
    return bad ("the radius of an extent around points must be positive and finite");
  if (points.empty () || !areFinite (points))
    return bad ("an extent around points needs at least one point, and finite coordinates");
  extent = std::make_shared<PointsExtent> (points, radius);
  return {};
}

} // namespace erkpa
