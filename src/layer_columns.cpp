// SPDX-License-Identifier: BSD-3-Clause
#include "layer_columns.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace erkpa
{

namespace
{

constexpr std::int64_t IN_A_ROW = std::int64_t (1) << 30; // columns, at most

/** \brief The column that a point lies in. */
struct Column
{
  std::int64_t number;
  Eigen::Vector3f middle; ///< as far out as the point
  Eigen::Vector3f way;    ///< of unit length, away from the viewer
};

/** \brief Columns side by side, or out of a point through the squares of a cube around it. */
class Columns
{
public:
  Columns (const Viewer &viewer, double width) : viewer_ (viewer), width_ (static_cast<float> (width))
  {
    const Eigen::Vector3f way = -viewer_.place;
    u_ = way.unitOrthogonal ();
    v_ = way.cross (u_);
  }

  Column
  of (const Eigen::Vector3f &x) const
  {
    return viewer_.is_far ? parallelOf (x) : pencilOf (x);
  }

  /** \brief Where depths are counted from. */
  Eigen::Vector3f
  origin () const
  {
    return viewer_.is_far ? Eigen::Vector3f::Zero () : viewer_.place;
  }

private:
  Column
  parallelOf (const Eigen::Vector3f &x) const
  {
    const float a = x.dot (u_) / width_, b = x.dot (v_) / width_;
    const Eigen::Vector3f to_middle = width_ * (offsetInCell (a) * u_ + offsetInCell (b) * v_);
    return {numberOf (0, a, b), x + to_middle, -viewer_.place};
  }

  Column
  pencilOf (const Eigen::Vector3f &x) const
  {
    const Eigen::Vector3f ray = x - viewer_.place;
    Eigen::Index axis = 0;
    const float depth = ray.cwiseAbs ().maxCoeff (&axis);
    const Eigen::Index second = (axis + 1) % 3, third = (axis + 2) % 3;
    const float scale = depth > 0.0f ? 1.0f / (depth * width_) : 0.0f, a = ray[second] * scale, b = ray[third] * scale;
    Eigen::Vector3f middle = ray;
    middle[second] += depth * width_ * offsetInCell (a);
    middle[third] += depth * width_ * offsetInCell (b);
    const std::int64_t face = 2 * axis + (ray[axis] < 0.0f ? 1 : 0);
    return {numberOf (face, a, b), viewer_.place + middle, middle.stableNormalized ()};
  }

  /** \brief From a number to the middle between the whole ones around it. */
  static float
  offsetInCell (float a)
  {
    return std::floor (a) + 0.5f - a;
  }

  static std::int64_t
  numberOf (std::int64_t face, float a, float b)
  {
    return (face * IN_A_ROW + wholeOf (a)) * IN_A_ROW + wholeOf (b);
  }

  /** \brief The whole number below; strays far out share the outermost columns. */
  static std::int64_t
  wholeOf (float a)
  {
    constexpr float FARTHEST = 0.49f * static_cast<float> (IN_A_ROW);
    return static_cast<std::int64_t> (std::floor (a > -FARTHEST ? std::min (a, FARTHEST) : -FARTHEST));
  }

  Viewer viewer_;
  float width_;
  Eigen::Vector3f u_, v_;
};

/** \brief A number that has nothing to do with those of the columns beside it. */
std::uint64_t
scrambled (std::int64_t number)
{
  const std::uint64_t mixed = static_cast<std::uint64_t> (number) * 0x9e3779b97f4a7c15u;
  return mixed >> 32;
}

} // namespace

std::vector<Crossing>
lookAtLayers (const OrientedPoints &points, const Facets &facets, const Viewer &viewer, double width,
              std::uint64_t one_in)
{
  constexpr float LEAST_SLOPE = 0.05f;
  const Columns columns (viewer, width);
  const Eigen::Vector3f origin = columns.origin ();
  std::vector<Crossing> crossings;
  crossings.reserve (points.size () / one_in);
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    const Eigen::Vector3f &x = points.positions[i];
    const Facet &facet = facets.of_node[i];
    const Column column = columns.of (x);
    if (one_in > 1 && scrambled (column.number) % one_in != 0)
      continue;
    const float slope = facet.normal.dot (column.way), steepness = std::max (LEAST_SLOPE, std::abs (slope));
    crossings.push_back ({column.number,
                          (column.middle - origin).dot (column.way) -
                              facet.normal.dot (column.middle - x) / std::copysign (steepness, slope),
                          (2.0f * facet.deviation + facet.bend * static_cast<float> (facets.spacing)) / steepness,
                          slope, static_cast<int> (i)});
  }
  std::sort (crossings.begin (), crossings.end ());
  return crossings;
}

bool
isLastOfLayer (const Crossing *node, const Crossing *end, double spacing)
{
  constexpr double LEAST_GAP = 0.25; // between layers, in spacings
  return node + 1 == end || node[1].depth - node->depth > std::max (static_cast<float> (LEAST_GAP * spacing),
                                                                    node->thickness + node[1].thickness);
}

int
countLayers (const Crossing *begin, const Crossing *end, double spacing)
{
  constexpr float STEEPEST = 0.4f;
  int layers = 0;
  for (const Crossing *c = begin; c != end; ++c)
  {
    if (std::abs (c->slope) < STEEPEST)
      return 0;
    layers += isLastOfLayer (c, end, spacing) ? 1 : 0;
  }
  return layers;
}

} // namespace erkpa
