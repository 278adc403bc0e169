// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>

#include <vector>

namespace erkpa
{

/** \brief Neighbours of a support where the points carry no noise. */
constexpr int CLEAN_SUPPORT = 20;

/** \brief The side of the square that a node has to itself: median over the nodes, from the 8 nearest of each. */
double
measureSpacing (const std::vector<Eigen::Vector3f> &positions, const NeighborSearch &search, int threads);

/** \brief How many neighbours are fitted together. */
struct SupportSizes
{
  int k = CLEAN_SUPPORT;            ///< where edges are not known: more would round them
  int within_faces = CLEAN_SUPPORT; ///< where faces are fitted apart
};

/** \brief How many neighbours it takes to average the noise out.
 *
 * The noise is the thickness of small neighbourhoods: the standard deviation of the 10 nearest nodes along their
 * thinnest direction, but for those whose normals look the other way: the far sides of thin walls. A fit to k nodes
 * within r tilts by about noise / (r sqrt k). Takes the smallest k, from CLEAN_SUPPORT on, for which this is below 0.01
 * in the median, or 0.0085 within faces, and most of CLEAN_SUPPORT are on the node's own side of a wall. It does not
 * depend on the number of threads.
 */
SupportSizes
chooseSupportSizes (const OrientedPoints &points, const NeighborSearch &search, int threads);

} // namespace erkpa
