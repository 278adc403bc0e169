// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "neighborhood.h"

#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief All neighbours of a point. */
struct FacetNeighborhood : Neighborhood
{
  using Ways = Eigen::Array<float, Eigen::Dynamic, 3>;

  Ways ways; ///< scratch memory: from the point to its neighbours

  /** \brief The \a k nearest nodes of node \a i. */
  void
  gatherAll (const NeighborSearch &search, const std::vector<Eigen::Vector3f> &all, std::size_t i, int k)
  {
    gather (search, all, all[i], k, [] (std::size_t) { return true; });
  }
};

/** \brief Calls visit (normal) for the planes through the first neighbour and two others near it, once sorted. */
template <typename VisitT>
void
visitPlanes (const FacetNeighborhood &near, double spacing, VisitT visit)
{
  constexpr std::size_t CORNERS = 11;
  const auto smallest = static_cast<float> (0.2 * spacing * spacing); // twice the area of the triangle
  const std::size_t corners = std::min (near.positions.size (), CORNERS);
  const Eigen::Vector3f &x = near.positions.front ();
  for (std::size_t a = 1; a < corners; ++a)
    for (std::size_t b = a + 1; b < corners; ++b)
    {
      const Eigen::Vector3f normal = (near.positions[a] - x).cross (near.positions[b] - x);
      const float area = normal.norm ();
      if (area > smallest)
        visit (Eigen::Vector3f (normal / area));
    }
}

/** \brief Standard deviation of the points about a plane; the second sheet of a thin wall is not taken for noise.
 *
 * From what a plane through a node leaves of its nearest neighbours but for the outer half of them, which may be on
 * another sheet. Takes curvature for noise, which positionNoise does not.
 */
double
noiseOfSheets (const OrientedPoints &points, const NeighborSearch &search, double spacing, int threads);

} // namespace erkpa
