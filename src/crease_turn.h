// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <cmath>

namespace erkpa
{

/** \brief Normals of two sides that turn by less than this are no crease: radians, 4 degrees. */
constexpr double LEAST_CREASE_TURN = 0.07;

/** \brief Normals of neighbouring vertices on faces that are apart are a crease for sure where they turn by more than
 * this. */
constexpr double CERTAIN_CREASE_TURN = 0.8; // radians, 46 degrees

/** \brief Angle between two directions of any length. */
inline double
turnBetween (const Eigen::Vector3d &a, const Eigen::Vector3d &b)
{
  return std::atan2 (a.cross (b).norm (), a.dot (b));
}

/** \brief Whether there may be a crease between vertices on different sides of a sharp surface, by their normals: a
 * round edge turns, too. */
inline bool
mayCrease (const Eigen::Vector3d &normal, const Eigen::Vector3d &other)
{
  constexpr double SMOOTH = 0.5; // of the least turn
  return turnBetween (normal, other) >= SMOOTH * LEAST_CREASE_TURN;
}

} // namespace erkpa
