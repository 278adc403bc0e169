// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "feature_loops.h"
#include "half_edges.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

namespace erkpa
{

/** \brief A triangle's directed area (twice that) and how narrow it is. */
struct TriangleShape
{
  Eigen::Vector3d area;
  double shortest; ///< squared length of its shortest side
  double others;   ///< product of those of the others

  TriangleShape (const Eigen::Vector3d &a, const Eigen::Vector3d &b, const Eigen::Vector3d &c)
      : area ((b - a).cross (c - a))
  {
    const double ab = (b - a).squaredNorm (), bc = (c - b).squaredNorm (), ca = (a - c).squaredNorm ();
    const double longest = std::max (ab, std::max (bc, ca)),
                 middle = std::max (std::min (ab, bc), std::min (std::max (ab, bc), ca));
    shortest = std::min (ab, std::min (bc, ca));
    others = middle * longest;
  }

  /** \brief Of its smallest angle. */
  double
  sine () const
  {
    return shortest > 0.0 ? std::sqrt (area.squaredNorm () / others) : 0.0;
  }

  /** \brief Whether that is below a bound: without a root, for it is asked of all triangles. */
  bool
  isNarrow (double bound) const
  {
    return area.squaredNorm () <= bound * bound * others;
  }
};

/** \brief Judges what the collapse or the flip of an edge would do to the surface and its creases.
 *
 * Triangles are held against the normals of f at their vertices where these are on no crease, and against themselves
 * where they are well shaped.
 */
class EdgeJudge
{
public:
  /** \param[in,out] edges the edges in \a creases get marked */
  EdgeJudge (double voxel, const std::vector<VertexPair> &creases, const SurfaceVertices &vertices, HalfEdges &edges);

  double
  squaredLength (int h) const
  {
    return (at (edges_.start (h)) - at (edges_.end (h))).squaredNorm ();
  }

  /** \brief Of the triangle with a half-edge. */
  TriangleShape
  shapeOf (int h) const
  {
    return {at (edges_.start (h)), at (edges_.end (h)), at (apex (h))};
  }

  /** \brief The sine of the smallest angle around the start of a half-edge once it is collapsed.
   * \return -1 where it must not be
   */
  double
  sineAfterCollapse (int h) const;

  /** \brief By how much the flip of an edge raises the sine of the smallest angle; -1 where it must not be flipped. */
  double
  gainOfFlip (int h) const;

  /** \brief Visit the vertices whose triangles count where edges of \a v collapse. */
  template <typename VisitT>
  void
  visitOwn (int v, VisitT visit) const
  {
    if (isPlain (v))
      visit (v);
    else
      edges_.visitNeighbors (v, visit);
  }

private:
  const Eigen::Vector3d &
  at (int v) const
  {
    return vertices_.positions[static_cast<std::size_t> (v)];
  }

  int
  apex (int h) const
  {
    return edges_.start (HalfEdges::previous (h));
  }

  bool
  isInside (int v) const
  {
    return edges_.place (v) == HalfEdges::Place::INSIDE;
  }

  bool
  isPlain (int v) const
  {
    return degrees_.empty () || degrees_[static_cast<std::size_t> (v)] == 0;
  }

  /** \brief Whether the triangles that a collapse near a crease or border moves pass through others around its end. */
  bool
  entangles (int h) const;

  /** \brief Whether a collapse along this half-edge moves a crease, or an end or corner of one, off its place. */
  bool
  movesCrease (int h) const;

  /** \brief Whether the crease through the start of a half-edge along it stays where it is without that vertex. */
  bool
  keepsCrease (int h) const;

  /** \brief Whether the diagonals a b and c d of a quadrilateral pass each other closely. */
  bool
  isNearlyFlat (int a, int b, int c, int d) const;

  /** \brief Where f looks at a vertex; zero on a crease, where it looks several ways. */
  Eigen::Vector3d
  facing (int v) const
  {
    if (!isPlain (v))
      return Eigen::Vector3d::Zero ();
    return vertices_.normals[static_cast<std::size_t> (v)];
  }

  double voxel_;
  const SurfaceVertices &vertices_;
  HalfEdges &edges_;
  std::vector<int> degrees_; // crease edges per vertex; empty where there are none
};

} // namespace erkpa
