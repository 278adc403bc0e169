// SPDX-License-Identifier: BSD-3-Clause
#include "loop_triangulation.h"

#include <Eigen/Geometry>

#include <cstddef>

namespace erkpa
{

namespace
{

/** \brief The cheapest triangulations of the sub-polygons i..j of a polygon, by dynamic programming. */
class LoopTriangulator
{
public:
  static constexpr double FORBIDDEN = 1e12; // of the polygon's squared size

  explicit LoopTriangulator (const LoopShape &loop) : loop_ (loop), size_ (loop.size), is_flat_ (isFlat (loop))
  {
    for (int i = 1; i < size_; ++i)
    {
      scale_ += (at (i) - at (0)).squaredNorm ();
      entries_[static_cast<std::size_t> (i) - 1][static_cast<std::size_t> (i)] = {0.0, 0};
    }
    for (int length = 2; length < size_; ++length)
      for (int i = 0; i + length < size_; ++i)
        findBest (i, i + length);
  }

  void
  collect (int i, int j, LoopTriangles &triangles) const
  {
    if (j - i < 2)
      return;
    const int apex = entry (i, j).apex;
    triangles.corners[static_cast<std::size_t> (triangles.count++)] = {i, apex, j};
    collect (i, apex, triangles);
    collect (apex, j, triangles);
  }

  bool
  isAllowed () const
  {
    return entry (0, size_ - 1).cost < 0.5 * FORBIDDEN * scale_;
  }

private:
  /** \brief Whether the vertices look the same way, so that all triangulations agree with them alike. */
  static bool
  isFlat (const LoopShape &loop)
  {
    constexpr double LEAST_COSINE = 0.9994; // 2 degrees
    const auto size = static_cast<std::size_t> (loop.size);
    Eigen::Vector3d sum = loop.normals[0];
    for (std::size_t i = 1; i < size; ++i)
      sum += loop.normals[i];
    const double least = LEAST_COSINE * sum.norm ();
    bool is_flat = least > 0.0;
    for (std::size_t i = 0; i < size; ++i)
      is_flat = is_flat && loop.normals[i].dot (sum) >= least;
    return is_flat;
  }

  struct Entry
  {
    double cost;
    int apex;
  };

  const Entry &
  entry (int i, int j) const
  {
    return entries_[static_cast<std::size_t> (i)][static_cast<std::size_t> (j)];
  }

  const Eigen::Vector3d &
  at (int i) const
  {
    return loop_.positions[static_cast<std::size_t> (i)];
  }

  void
  findBest (int i, int j)
  {
    Entry best{0.0, 0};
    for (int apex = i + 1; apex < j; ++apex)
    {
      const double of_triangle = is_flat_ ? 0.0 : costOfTriangle (i, apex, j);
      const double cost = entry (i, apex).cost + entry (apex, j).cost + of_triangle;
      if (best.apex == 0 || cost < best.cost)
        best = {cost, apex};
    }
    const bool is_chord = j - i < size_ - 1;
    if (is_chord)
      best.cost += 0.01 * (at (j) - at (i)).squaredNorm () + (inOneFace (i, j) ? FORBIDDEN * scale_ : 0.0);
    entries_[static_cast<std::size_t> (i)][static_cast<std::size_t> (j)] = best;
  }

  bool
  inOneFace (int i, int j) const
  {
    return commonFace (loop_.edges[static_cast<std::size_t> (i)], loop_.edges[static_cast<std::size_t> (j)]) >= 0;
  }

  /** \brief Twice the area that the triangle loses when seen along its vertices' mean normal. */
  double
  costOfTriangle (int i, int k, int j) const
  {
    const Eigen::Vector3d area = (at (k) - at (i)).cross (at (j) - at (i));
    const auto &normals = loop_.normals;
    const Eigen::Vector3d normal = normals[static_cast<std::size_t> (i)] + normals[static_cast<std::size_t> (k)] +
                                   normals[static_cast<std::size_t> (j)];
    const double length = normal.norm ();
    return area.norm () - (length > 0.0 ? area.dot (normal) / length : 0.0);
  }

  const LoopShape &loop_;
  int size_;
  bool is_flat_;
  double scale_ = 0.0;
  std::array<std::array<Entry, 12>, 12> entries_;
};

} // namespace

bool
triangulateLoop (const LoopShape &loop, LoopTriangles &triangles)
{
  triangles.count = 0;
  if (loop.size == 3)
  {
    triangles.corners[0] = {0, 1, 2};
    triangles.count = 1;
    return true;
  }
  const LoopTriangulator triangulator (loop);
  triangulator.collect (0, loop.size - 1, triangles);
  return triangulator.isAllowed ();
}

} // namespace erkpa
