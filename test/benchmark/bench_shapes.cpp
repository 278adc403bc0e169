// SPDX-License-Identifier: BSD-3-Clause
#include "bench_shapes.h"

#include "shapes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <random>

namespace bench
{

namespace
{

using Cloud = pcl::PointCloud<pcl::PointNormal>;

void
add (const Eigen::Vector3d &position, const Eigen::Vector3d &normal, Cloud &cloud)
{
  pcl::PointNormal point;
  point.getVector3fMap () = position.cast<float> ();
  point.getNormalVector3fMap () = normal.cast<float> ();
  cloud.push_back (point);
}

/** \brief A ring whose tube is thicker here and thinner there. */
class BumpyTorus
{
public:
  BumpyTorus ()
  {
    constexpr int STEPS = 240;
    constexpr double MARGIN = 1.02; // between the steps
    for (int i = 0; i < STEPS; ++i)
      for (int j = 0; j < STEPS; ++j)
        largest_ = std::max (largest_, MARGIN * at (2.0 * M_PI * i / STEPS, 2.0 * M_PI * j / STEPS).area.norm ());
  }

  void
  sample (std::size_t count, Cloud &cloud)
  {
    std::uniform_real_distribution<double> turn (0.0, 2.0 * M_PI), share (0.0, largest_);
    while (cloud.size () < count)
    {
      const double u = turn (random_), v = turn (random_);
      const Piece piece = at (u, v);
      const double size = piece.area.norm ();
      if (share (random_) < size)
        add (piece.position, piece.area / size, cloud);
    }
  }

private:
  /** \brief A point, and the vector along its normal whose length is its area per du dv. */
  struct Piece
  {
    Eigen::Vector3d position, area;
  };

  static Piece
  at (double u, double v)
  {
    constexpr double RING = 1.0, TUBE = 0.35, BUMP = 0.12;
    const double thickness = TUBE * (1.0 + BUMP * std::sin (7.0 * u) * std::sin (4.0 * v));
    const double by_u = 7.0 * TUBE * BUMP * std::cos (7.0 * u) * std::sin (4.0 * v);
    const double by_v = 4.0 * TUBE * BUMP * std::sin (7.0 * u) * std::cos (4.0 * v);
    const Eigen::Vector3d out (std::cos (u), std::sin (u), 0.0), along (-std::sin (u), std::cos (u), 0.0);
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ ();
    const Eigen::Vector3d from_tube = std::cos (v) * out + std::sin (v) * up;
    const Eigen::Vector3d around = -std::sin (v) * out + std::cos (v) * up;
    const Eigen::Vector3d step_u = (RING + thickness * std::cos (v)) * along + by_u * from_tube;
    const Eigen::Vector3d step_v = thickness * around + by_v * from_tube;
    return {RING * out + thickness * from_tube, step_u.cross (step_v)};
  }

  std::mt19937 random_{29};
  double largest_ = 0.0; // area per du dv
};

class Box
{
public:
  void
  sample (std::size_t count, Cloud &cloud)
  {
    std::uniform_real_distribution<double> unit (-1.0, 1.0);
    const Eigen::Vector3d half = halves ();
    std::discrete_distribution<int> axis_of ({half[1] * half[2], half[0] * half[2], half[0] * half[1]});
    while (cloud.size () < count)
    {
      const int axis = axis_of (random_);
      Eigen::Vector3d position (unit (random_), unit (random_), unit (random_));
      const double side = unit (random_) < 0.0 ? -1.0 : 1.0;
      position[axis] = side;
      add (attitude () * half.cwiseProduct (position), attitude () * (side * Eigen::Vector3d::Unit (axis)), cloud);
    }
  }

  static std::vector<Eigen::Vector4d>
  planes ()
  {
    std::vector<Eigen::Vector4d> planes = shapes::boxBisectors (halves ());
    for (Eigen::Vector4d &plane : planes)
      plane.head<3> () = attitude () * plane.head<3> ();
    return planes;
  }

private:
  static Eigen::Vector3d
  halves ()
  {
    return {1.0, 0.7, 0.5};
  }

  static Eigen::Matrix3d
  attitude ()
  {
    return Eigen::AngleAxisd (0.7, Eigen::Vector3d (1.0, 2.0, 3.0).normalized ()).toRotationMatrix ();
  }

  std::mt19937 random_{31};
};

} // namespace

const std::vector<std::string> &
shapeNames ()
{
  static const std::vector<std::string> NAMES{"torus", "box", "box_auto"};
  return NAMES;
}

Shape
makeShape (const std::string &name, std::size_t count)
{
  Shape shape;
  shape.cloud.reset (new Cloud);
  shape.cloud->reserve (count);
  if (name == "torus")
  {
    BumpyTorus ().sample (count, *shape.cloud);
    return shape;
  }
  Box ().sample (count, *shape.cloud);
  shape.is_automatic = name == "box_auto";
  if (!shape.is_automatic)
    shape.planes = Box::planes ();
  return shape;
}

} // namespace bench
