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

inline Eigen::Vector3d
positionOf (const OrientedPoints &points, int node)
{
  return points.positions[static_cast<std::size_t> (node)].cast<double> ();
}

inline Eigen::Vector3d
normalOf (const OrientedPoints &points, int node)
{
  return points.normals[static_cast<std::size_t> (node)].cast<double> ();
}

/** \brief Tells what fits to one smooth surface. */
class SmoothnessTest
{
public:
  SmoothnessTest (const OrientedPoints &points, const SegmentationOptions &options)
      : points_ (points), chord_ (options.chord), cosine_ (std::cos (options.angle)),
        far_cosine_ (std::cos (BRIDGE_ANGLE * options.angle)), link_reach_ (options.link_reach * options.spacing)
  {
  }

  /** \brief Whether two nodes fit to one smooth surface. */
  bool
  areSmooth (int i, int j) const
  {
    const Eigen::Vector3d way = positionOf (points_, j) - positionOf (points_, i);
    return areSmooth (i, j, way, way.norm (), cosine_, BEND);
  }

  /** \brief Whether to link two nodes. Those farther apart must agree better: they bridge gaps in narrow faces. */
  bool
  areLinked (int i, int j, double &distance) const
  {
    const Eigen::Vector3d way = positionOf (points_, j) - positionOf (points_, i);
    distance = way.norm ();
    return distance <= link_reach_ ? areSmooth (i, j, way, distance, cosine_, BEND)
                                   : areSmooth (i, j, way, distance, far_cosine_, BRIDGE_BEND);
  }

private:
  static constexpr double BEND = 0.2, BRIDGE_BEND = 0.08, BRIDGE_ANGLE = 0.7;

  /** \brief Similar normals, and across them no step.
   * \param[in] bend how large a step may be as a share of the distance; that of a circular arc is zero
   */
  bool
  areSmooth (int i, int j, const Eigen::Vector3d &way, double distance, double least_cosine, double bend) const
  {
    const Eigen::Vector3d n = normalOf (points_, i), m = normalOf (points_, j);
    return n.dot (m) >= least_cosine && 0.5 * std::abs (way.dot (n + m)) <= std::max (bend * distance, chord_);
  }

  const OrientedPoints &points_;
  double chord_, cosine_, far_cosine_, link_reach_;
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
