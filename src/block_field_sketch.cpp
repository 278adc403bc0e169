// SPDX-License-Identifier: BSD-3-Clause
//
// What BlockField says of the field around a point.
#include "block_field.h"

namespace erkpa
{

bool
BlockField::addSketchPoint (const Eigen::Vector3d &x)
{
  if (settings_.constraint == lanes::Constraint::FUNCTIONAL || settings_.basis == lanes::Basis::CONSTANT)
    return false;
  addPlain (x, false);
  return true;
}

bool
BlockField::sketch (std::size_t point, FieldSketch &sketch) const
{
  const std::size_t i = placeOf (point);
  if (plain_.states[i] != lanes::State::DEFINED)
    return false;
  const auto coefficient = [&] (std::size_t j) { return unit_ * static_cast<double> (plain_.coefficient (i, j)); };
  const double radius = unit_ * static_cast<double> (plain_.radii[i]);
  sketch.x = center_ + unit_ * plain_.position (i).cast<double> ();
  sketch.value = coefficient (0);
  sketch.slope = Eigen::Vector3d (coefficient (1), coefficient (2), coefficient (3)) / radius;
  sketch.bend = settings_.basis == lanes::Basis::SPHERICAL ? coefficient (4) / (radius * radius) : 0.0;
  return true;
}

} // namespace erkpa
