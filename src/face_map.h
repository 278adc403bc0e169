// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "nearby_nodes.h"

#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>
#include <erkpa/sharp_surface.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace erkpa
{

/** \brief A place where two faces are near each other. */
struct Meeting
{
  Eigen::Vector3f position; ///< local frame
  int face, other;          ///< the faces, face < other
  int surface;              ///< the sharp surface that keeps them apart; -1 where the one goes on into the other
  double reach;             ///< how far around the position this holds, a length
};

/** \brief Which face every node is on, and where faces are apart.
 *
 * Faces meet in creases and in the two sides of thin walls: there a sharp surface keeps them apart. Elsewhere
 * neighbouring faces are parts of one smooth surface.
 */
class FaceMap
{
public:
  /** \brief The map that sharp surfaces between faces of points make; null where there are none among them.
   * \param[in] grid over the positions of \a points
   * \param[in] surfaces any
   * \param[in] spacing distance between neighbouring nodes
   */
  static std::shared_ptr<const FaceMap>
  make (const OrientedPoints &points, const PointGrid &grid, const std::vector<SharpSurface::ConstPtr> &surfaces,
        double spacing, int threads);

  int
  faceOf (int node) const
  {
    return faces_[static_cast<std::size_t> (node)];
  }

  /** \brief Number of faces. */
  std::size_t
  count () const
  {
    return known_faces_.size ();
  }

  const std::vector<Meeting> &
  meetings () const
  {
    return meetings_;
  }

  /** \brief The meetings that points within \a extent of \a center may be in reach of, by their places in meetings ().
   */
  void
  meetingsNear (const Eigen::Vector3d &center, double extent, std::vector<int> &near) const;

private:
  FaceMap () = default;

  void
  addSurfaces (const OrientedPoints &points, const std::vector<SharpSurface::ConstPtr> &surfaces);

  void
  assignNodes (const OrientedPoints &points, double spacing, int threads);

  void
  findJoints (const OrientedPoints &points, const PointGrid &grid, double spacing, int threads);

  /** \brief Two nodes, the first one with the lower number. */
  struct Joint
  {
    int node, other;
    Eigen::Vector3f middle;
  };

  void
  addJoints (const OrientedPoints &points, double spacing, std::size_t first, std::size_t last, NearbyNodes &near,
             std::vector<Joint> &joints) const;

  bool
  areJoined (const OrientedPoints &points, int i, int j, double reach, std::vector<int> &meetings) const;

  std::vector<int> faces_; // of the nodes, by place in known_faces_
  std::vector<SharpSurface::ConstPtr> known_faces_;
  std::vector<Meeting> meetings_; // separations first
  double largest_reach_ = 0.0;
  NeighborSearch::ConstPtr search_; // over meetings_; null where there are none
};

/** \brief Whether a sharp surface keeps two faces of points apart: a FaceMap sees to it, not an enrichment. */
bool
separatesFaces (const SharpSurface &surface);

} // namespace erkpa
