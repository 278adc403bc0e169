// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "found_nodes.h"
#include "point_grid.h"

#include <erkpa/extent.h>
#include <erkpa/sharp_surface.h>

#include <Eigen/Core>

#include <cstddef>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief The places along sharp edges between faces of points, and which of them stay in force. */
class EdgePlaces
{
public:
  /** \param[in] edges sharp surfaces; those that are no such edges always stay
   * \param[in] origin near the places, which are sought in float
   */
  EdgePlaces (const std::vector<SharpSurface::ConstPtr> &edges, const Eigen::Vector3d &origin, int threads);

  /** \brief Whether edges may be in force at \a x. */
  bool
  reach (const Eigen::Vector3d &x) const;

  /** \brief Take the edges of the face that runs through \a x out of force around it. */
  void
  clearFaceAt (const Eigen::Vector3d &x);

  /** \brief Take all edges out of force around \a x.
   * \param[in] small_wholly whether to take those of small faces out as a whole
   */
  void
  clearAllAt (const Eigen::Vector3d &x, bool small_wholly);

  /** \brief What is left of the edges; of those that lost places nothing where the rest is shorter than a length. */
  std::vector<SharpSurface::ConstPtr>
  rest (double shortest) const;

private:
  struct Edge
  {
    SharpSurface::ConstPtr whole, face, other;
    std::vector<Eigen::Vector3d> places;
    double reach = 0.0;
    std::vector<char> is_kept; // of the places
  };

  /** \brief An edge and one of its places. */
  using Place = std::pair<std::size_t, std::size_t>;

  void
  addEdge (const SharpSurface::ConstPtr &surface);

  void
  findAround (const Eigen::Vector3d &x);

  /** \brief Of the faces that meet around \a x, in the places found, the one that is nearest to it. */
  const SharpSurface *
  faceAt (const Eigen::Vector3d &x) const;

  SharpSurface::ConstPtr
  restOf (const Edge &edge, double shortest) const;

  Eigen::Vector3d origin_;
  std::vector<Edge> edges_;
  std::vector<Place> places_; // as in the grid
  PointGrid grid_;
  double reach_ = 0.0; // the largest
  std::vector<Place> around_;
  FoundNodes found_;
};

} // namespace erkpa
