// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace erkpa
{

/** \brief f around a point, as the fit there continues: value + Σ_a (slope_a d_a + bend d_a²), d = y - x. */
struct FieldSketch
{
  Eigen::Vector3d x;
  double value;
  Eigen::Vector3d slope;
  double bend;

  /** \brief What a coordinate adds to the value. */
  double
  along (int axis, double y) const
  {
    const double d = y - x[axis];
    return d * (slope[axis] + bend * d);
  }

  double
  slopeAlong (int axis, double y) const
  {
    return slope[axis] + 2.0 * bend * (y - x[axis]);
  }
};

} // namespace erkpa
