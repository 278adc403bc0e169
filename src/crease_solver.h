// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "local_field.h"

#include <vector>

namespace erkpa
{

/** \brief Move a point to where the pieces of f on several sides have the value iso: one for a surface, two for a
 * crease, three for a corner.
 *
 * Newton steps of least norm, so that pieces that say the same do no harm.
 * \param[in] reach how far the point may move, a length
 * \param[in] tolerance it ends when steps get shorter than this, a length
 * \param[in,out] x the point; anywhere within reach where it fails
 * \param[out] gradients of the pieces there, all but for the last short step; null: not wanted
 * \return false where there is no such place within reach
 */
bool
moveToCrease (LocalField &local, const std::vector<Side> &sides, double iso, double reach, double tolerance,
              Eigen::Vector3d &x, std::vector<Eigen::Vector3d> *gradients = nullptr);

} // namespace erkpa
