// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "face_segmentation.h"
#include "lanes/lanes.h"
#include "node_links.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief Tells what fits to one smooth surface. In floats and squares: it is asked for every pair of neighbours. */
class SmoothnessTest
{
public:
  explicit SmoothnessTest (const SegmentationOptions &options)
  {
    limits_.chord = static_cast<float> (options.chord);
    limits_.bend = BEND;
    limits_.far_bend = BRIDGE_BEND;
    limits_.cosine = static_cast<float> (std::cos (options.angle));
    limits_.far_cosine = static_cast<float> (std::cos (BRIDGE_ANGLE * options.angle));
    limits_.squared_reach = static_cast<float> (std::pow (options.link_reach * options.spacing, 2));
  }

  /** \brief Whether two nodes fit to one smooth surface: similar normals, and across them no step.
   * \param[in] squared their squared distance
   */
  bool
  areSmooth (const OrientedPoints &points, int i, int j, float squared) const
  {
    return fit (points, i, j, squared, limits_.cosine, limits_.bend);
  }

  /** \brief Whether to link two nodes. Those farther apart must agree better: they bridge gaps in narrow faces. */
  bool
  areLinked (const OrientedPoints &points, int i, int j, float squared) const
  {
    return squared <= limits_.squared_reach ? areSmooth (points, i, j, squared)
                                            : fit (points, i, j, squared, limits_.far_cosine, limits_.far_bend);
  }

  /** \brief What Engine::linkSmooth goes by, of which areLinked () is the definition. */
  const lanes::Smoothness &
  limits () const
  {
    return limits_;
  }

private:
  static constexpr float BEND = 0.2f, BRIDGE_BEND = 0.08f; // as a share of the distance; a circular arc has no step
  static constexpr double BRIDGE_ANGLE = 0.7;

  bool
  fit (const OrientedPoints &points, int i, int j, float squared, float least_cosine, float bend) const
  {
    const auto from = static_cast<std::size_t> (i), to = static_cast<std::size_t> (j);
    const Eigen::Vector3f &n = points.normals[from], &m = points.normals[to];
    const float step = 0.5f * std::abs ((points.positions[to] - points.positions[from]).dot (n + m));
    return n.dot (m) >= least_cosine && (step <= limits_.chord || step * step <= bend * bend * squared);
  }

  lanes::Smoothness limits_{};
};

/** \brief Links nodes with the neighbours that fit to them.
 *
 * Links go both ways, but for those of a length that only one of two nodes asks for. Far ones bridge gaps, and tell
 * faces apart in the balls of suspects: elsewhere near ones do.
 * \param[in] grid over the positions of \a points
 * \param[out] is_suspect of each node, whether others are close to it, too
 */
NodeLinks
linkNeighbors (const OrientedPoints &points, const PointGrid &grid, const SegmentationOptions &options, int threads,
               std::vector<char> &is_suspect);

} // namespace erkpa
