// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "point_grid.h"

#include <erkpa/oriented_points.h>

#include <array>
#include <memory>
#include <vector>

namespace erkpa
{

/** \brief The nodes as arrays of floats in the order of a grid: what evaluations of whole blocks read. */
struct NodeTable
{
  /** \param[in] grid over the positions of \a points */
  NodeTable (const OrientedPoints &points, std::shared_ptr<const PointGrid> grid, int threads);

  std::shared_ptr<const PointGrid> grid;
  std::array<LargeVector<float>, 3> normals;
  LargeVector<float> confidences; ///< empty: all one
};

/** \brief A grid whose cells are about as large as the supports will be; \a spacing is measured by the way. */
std::shared_ptr<const PointGrid>
makePointGrid (const std::vector<Eigen::Vector3f> &positions, int threads, double &spacing);

/** \brief A search by such a grid over copies of any points, at least one. */
NeighborSearch::ConstPtr
makeGridSearch (const std::vector<Eigen::Vector3f> &positions, int threads);

} // namespace erkpa
