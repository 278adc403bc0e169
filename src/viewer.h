// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace erkpa
{

/** \brief Where a cloud is looked at from: a point, or infinitely far out. */
struct Viewer
{
  Eigen::Vector3f place = Eigen::Vector3f::UnitZ (); ///< the point, or the direction to it
  bool is_far = true;                                ///< whether it is a direction, of unit length

  /** \brief From \a x to the viewer, of any length. */
  Eigen::Vector3f
  from (const Eigen::Vector3f &x) const
  {
    return is_far ? place : Eigen::Vector3f (place - x);
  }
};

} // namespace erkpa
