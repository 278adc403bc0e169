// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_intersections.h"

#include "parallel_collect.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

namespace erkpa
{

namespace
{

using Eigen::Vector3d;
using Triangle = std::array<int, 3>;
using Positions = LargeVector<Vector3d>;

const Vector3d &
at (const Positions &positions, int vertex)
{
  return positions[static_cast<std::size_t> (vertex)];
}

bool
hasVertex (const Triangle &triangle, int vertex)
{
  return std::find (triangle.begin (), triangle.end (), vertex) != triangle.end ();
}

/** \brief Six times the volume of the tetrahedron over a triangle, positive on the side its normal points to. */
double
volume (const Vector3d &a, const Vector3d &b, const Vector3d &c, const Vector3d &tip)
{
  return (b - a).cross (c - a).dot (tip - a);
}

/** \brief Whether the line from p to q, which lie on either side of a triangle's plane, passes through its inside. */
bool
pierces (const Vector3d &p, const Vector3d &q, const Vector3d &a, const Vector3d &b, const Vector3d &c)
{
  const double ab = volume (p, q, a, b), bc = volume (p, q, b, c), ca = volume (p, q, c, a);
  return (ab > 0.0 && bc > 0.0 && ca > 0.0) || (ab < 0.0 && bc < 0.0 && ca < 0.0);
}

/** \brief Whether a side of one triangle passes through the other; sides that end at it are left out. */
bool
hasPiercingSide (const Positions &positions, const Triangle &one, const Triangle &other)
{
  const Vector3d &a = at (positions, other[0]), &b = at (positions, other[1]), &c = at (positions, other[2]);
  const Vector3d normal = (b - a).cross (c - a);
  std::array<double, 3> heights{}; // of the vertices that are not shared; those have none
  for (std::size_t i = 0; i < 3; ++i)
    if (!hasVertex (other, one[i]))
      heights[i] = normal.dot (at (positions, one[i]) - a);
  for (std::size_t i = 0; i < 3; ++i)
  {
    const std::size_t next = (i + 1) % 3;
    if (heights[i] * heights[next] < 0.0 && pierces (at (positions, one[i]), at (positions, one[next]), a, b, c))
      return true;
  }
  return false;
}

struct Box
{
  Vector3d low, high;

  Box (const Positions &positions, const Triangle &triangle)
      : low (at (positions, triangle[0])), high (at (positions, triangle[0]))
  {
    for (const int v : triangle)
    {
      low = low.cwiseMin (at (positions, v));
      high = high.cwiseMax (at (positions, v));
    }
  }

  bool
  meets (const Box &other) const
  {
    return (low.array () <= other.high.array ()).all () && (other.low.array () <= high.array ()).all ();
  }
};

/** \brief Triangles by the cells of a grid that their boxes reach into. */
class CellTable
{
public:
  CellTable (const Positions &positions, const LargeVector<Triangle> &triangles, const std::vector<int> &which,
             double cell)
      : per_cell_ (1.0 / cell)
  {
    while (is_taken_.size () < PLACES * which.size ())
      is_taken_.resize (std::max<std::size_t> (64, 2 * is_taken_.size ()), 0);
    for (const int t : which)
      visitCells (Box (positions, triangles[static_cast<std::size_t> (t)]),
                  [&] (std::uint64_t key)
                  {
                    cells_[key].push_back (t);
                    is_taken_[placeOf (key)] = 1;
                  });
  }

  /** \brief Calls visit with the triangles in the cells of a box, those of several cells several times. */
  template <typename VisitT>
  void
  visit (const Box &box, VisitT visit) const
  {
    if (is_taken_.empty ())
      return;
    visitCells (box,
                [&] (std::uint64_t key)
                {
                  if (!is_taken_[placeOf (key)])
                    return; // most are far from all of them
                  const auto found = cells_.find (key);
                  if (found != cells_.end ())
                    for (const int t : found->second)
                      visit (t);
                });
  }

private:
  static constexpr std::size_t PLACES = 16; // per triangle

  template <typename VisitT>
  void
  visitCells (const Box &box, VisitT visit) const
  {
    const Vector3d low = (box.low * per_cell_).array ().floor (), high = (box.high * per_cell_).array ().floor ();
    const auto part = [] (double v) { return static_cast<std::uint64_t> (static_cast<std::int64_t> (v)) & 0x1fffff; };
    for (double x = low.x (); x <= high.x (); ++x)
      for (double y = low.y (); y <= high.y (); ++y)
        for (double z = low.z (); z <= high.z (); ++z)
          visit (part (x) << 42 | part (y) << 21 | part (z));
  }

  std::size_t
  placeOf (std::uint64_t key) const
  {
    return (key * 0x9e3779b97f4a7c15u >> 32) & (is_taken_.size () - 1);
  }

  double per_cell_;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
  std::vector<char> is_taken_; // by a number made of a cell's key
};

} // namespace

bool
passThrough (const Positions &positions, const Triangle &one, const Triangle &other)
{
  const auto is_shared = [&] (int v) { return hasVertex (other, v); };
  if (std::count_if (one.begin (), one.end (), is_shared) > 1)
    return false;
  return hasPiercingSide (positions, one, other) || hasPiercingSide (positions, other, one);
}

std::vector<std::pair<int, int>>
findIntersections (const Positions &positions, const LargeVector<Triangle> &triangles, const std::vector<int> &suspects,
                   double cell, int threads)
{
  std::vector<char> is_suspect (triangles.size (), 0);
  for (const int s : suspects)
    is_suspect[static_cast<std::size_t> (s)] = 1;
  const CellTable table (positions, triangles, suspects, cell);
  using Pairs = std::vector<std::pair<int, int>>;
  const auto find_with = [&] (std::size_t t, Pairs &pairs)
  {
    const Box box (positions, triangles[t]);
    table.visit (box,
                 [&] (int s)
                 {
                   const Triangle &suspect = triangles[static_cast<std::size_t> (s)];
                   if ((!is_suspect[t] || s < static_cast<int> (t)) && box.meets (Box (positions, suspect)) &&
                       passThrough (positions, suspect, triangles[t]))
                     pairs.emplace_back (s, static_cast<int> (t));
                 });
  };
  constexpr std::size_t STRETCH = 2048;
  Pairs pairs = parallelCollect<std::vector<std::pair<int, int>>> (
      triangles.size (), threads,
      [&] (std::size_t first, std::size_t last, Pairs &part)
      {
        for (std::size_t t = first; t < last; ++t)
          find_with (t, part);
      },
      STRETCH);
  std::sort (pairs.begin (), pairs.end ());
  pairs.erase (std::unique (pairs.begin (), pairs.end ()), pairs.end ());
  return pairs;
}

} // namespace erkpa
