// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief Points that follow each other and lie close together. */
struct PointGroup
{
  std::size_t first, last;
  Eigen::Vector3d center;
  double extent; ///< none lies farther from the center
};

/** \brief Groups of points, about as large as the blocks of a grid: each shares one gathering of the field's nodes.
 * \param[in] position_of position_of (i) is the i-th point, which stays
 */
template <typename PositionOfT>
std::vector<PointGroup>
groupPoints (std::size_t count, double voxel, PositionOfT position_of)
{
  constexpr std::size_t MOST = 64;
  constexpr double EXTENT = 2.6; // voxels
  std::vector<PointGroup> groups;
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < count; ++i)
  {
    const Eigen::Vector3d &x = position_of (i);
    Eigen::AlignedBox3d grown = box;
    grown.extend (x);
    if (groups.empty () || i - groups.back ().first == MOST || 0.5 * grown.diagonal ().norm () > EXTENT * voxel)
    {
      groups.push_back ({i, i, x, 0.0});
      grown = Eigen::AlignedBox3d (x, x);
    }
    box = grown;
    groups.back ().last = i + 1;
    groups.back ().center = box.center ();
    groups.back ().extent = 0.5 * box.diagonal ().norm ();
  }
  return groups;
}

} // namespace erkpa
