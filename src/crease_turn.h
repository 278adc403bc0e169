// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <cmath>

namespace erkpa
{

/** \brief Normals of two sides that turn by less than this are no crease: radians, 4 degrees. */
constexpr double LEAST_CREASE_TURN = 0.07;

/** \brief Angle between two directions of any length. */
inline double
turnBetween (const Eigen::Vector3d &a, const Eigen::Vector3d &b)
{
  return std::atan2 (a.cross (b).norm (), a.dot (b));
}

/** \brief What the normals of vertices on different sides of a sharp surface say about a crease between them. */
enum class CreaseSign
{
  NONE,
  UNCLEAR, ///< the field has to be asked
  CLEAR
};

inline CreaseSign
creaseSign (const Eigen::Vector3d &normal, const Eigen::Vector3d &other)
{
  constexpr double SMOOTH = 0.5 * LEAST_CREASE_TURN, SHARP = 10.0 * LEAST_CREASE_TURN;
  const double turn = turnBetween (normal, other);
  return turn < SMOOTH ? CreaseSign::NONE : turn > SHARP ? CreaseSign::CLEAR : CreaseSign::UNCLEAR;
}

} // namespace erkpa
