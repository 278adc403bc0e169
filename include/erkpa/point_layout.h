// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>

#include <memory>

namespace erkpa
{

class PointGrid;

/** \brief How points lie in space: what every stage asks of them, found once. */
struct PointLayout
{
  using ConstPtr = std::shared_ptr<const PointLayout>;

  /** \param[in] points at least one
   * \param[in] threads 0 = all processors; the result does not depend on it
   */
  PointLayout (const OrientedPoints &points, int threads);

  double spacing = 0.0;                  ///< typical distance between neighbouring points; 0 where they coincide
  std::shared_ptr<const PointGrid> grid; ///< over their positions
  NeighborSearch::ConstPtr search;       ///< by this grid: where every point asks, it is quicker than a tree
  int k = 0;                             ///< neighbours it takes to average the noise out
  int k_within_faces = 0;                ///< the same where sharp edges are known, which it does not round
};

} // namespace erkpa
