// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "face_segmentation.h"
#include "node_links.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief Tells what fits to one smooth surface. In floats and squares: it is asked for every pair of neighbours. */
class SmoothnessTest
{
public:
  SmoothnessTest (const OrientedPoints &points, const SegmentationOptions &options)
      : points_ (points), chord_ (static_cast<float> (options.chord)),
        cosine_ (static_cast<float> (std::cos (options.angle))),
        far_cosine_ (static_cast<float> (std::cos (BRIDGE_ANGLE * options.angle))),
        squared_reach_ (static_cast<float> (std::pow (options.link_reach * options.spacing, 2)))
  {
  }

  /** \brief Whether two nodes fit to one smooth surface.
   * \param[in] squared their squared distance
   */
  bool
  areSmooth (int i, int j, float squared) const
  {
    return areSmooth (i, j, squared, cosine_, BEND);
  }

  /** \brief Whether to link two nodes. Those farther apart must agree better: they bridge gaps in narrow faces. */
  bool
  areLinked (int i, int j, float squared) const
  {
    return squared <= squared_reach_ ? areSmooth (i, j, squared, cosine_, BEND)
                                     : areSmooth (i, j, squared, far_cosine_, BRIDGE_BEND);
  }

private:
  static constexpr float BEND = 0.2f, BRIDGE_BEND = 0.08f;
  static constexpr double BRIDGE_ANGLE = 0.7;

  /** \brief Similar normals, and across them no step.
   * \param[in] bend how large a step may be as a share of the distance; that of a circular arc is zero
   */
  bool
  areSmooth (int i, int j, float squared, float least_cosine, float bend) const
  {
    const auto from = static_cast<std::size_t> (i), to = static_cast<std::size_t> (j);
    const Eigen::Vector3f &n = points_.normals[from], &m = points_.normals[to];
    const float step = 0.5f * std::abs ((points_.positions[to] - points_.positions[from]).dot (n + m));
    return n.dot (m) >= least_cosine && (step <= chord_ || step * step <= bend * bend * squared);
  }

  const OrientedPoints &points_;
  float chord_, cosine_, far_cosine_, squared_reach_;
};

/** \brief Links nodes with the neighbours that fit to them.
 *
 * Links go both ways, but for those of a length that only one of two nodes asks for. Far ones bridge gaps, and tell
 * faces apart in the balls of suspects: elsewhere near ones do. \param[out] is_suspect of each node, whether others are
 * close to it, too
 */
NodeLinks
linkNeighbors (const OrientedPoints &points, const NeighborSearch &search, const SegmentationOptions &options,
               int threads, std::vector<char> &is_suspect);

} // namespace erkpa
