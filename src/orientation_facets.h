// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>

#include <Eigen/Core>

#include <vector>

namespace erkpa
{

/** \brief The plane of the face that a point lies on, without a sign. */
struct Facet
{
  Eigen::Vector3f normal = Eigen::Vector3f::Zero ();
  float deviation = 0.0f; ///< of the points from it, input's unit of length
  float bend = 0.0f;      ///< angle that the normal turns by within a spacing, in radians
};

/** \brief What a cloud is taken for. */
enum class SurfaceKind
{
  CLOSED, ///< the boundary of solids: two sheets close together are the two sides of a wall or a gap
  OPEN    ///< a scan: two sheets close together are noise, or one behind the other, seen from the same side
};

/** \brief What orientNormals knows of a cloud before any sign is. */
struct Facets
{
  std::vector<Facet> of_node;
  SurfaceKind kind = SurfaceKind::CLOSED;
  int k = 0; ///< neighbours that a facet is from, at most
  double spacing = 0.0;
  double tolerance = 0.0; ///< distance from a plane up to which a point counts as lying on it
};

/** \brief Finds the face of every point, up to the crease and on either side of a thin wall.
 *
 * Planes through few neighbours compete for every point that lies on no smooth surface (Kuwahara's filter, as in
 * sharpenNormals, which needs the signs that are looked for here).
 * \param[in] k neighbours that \a normals were estimated from
 * \param[in] normals one per point, of any sign
 */
Facets
findFacets (const OrientedPoints &points, const NeighborSearch &search, SurfaceKind kind, int k, int threads,
            const std::vector<Eigen::Vector3f> &normals);

/** \brief The facets that estimated normals make by themselves, quickly: blended at edges, and of both sides of walls.
 */
Facets
facetsOfNormals (const OrientedPoints &points, const NeighborSearch &search, SurfaceKind kind, int k, int threads,
                 const std::vector<Eigen::Vector3f> &normals);

} // namespace erkpa
