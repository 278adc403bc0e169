// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <vector>

namespace erkpa
{

/** \brief The places of positions that repeat an earlier one, sorted; -0 is 0. */
std::vector<int>
findRepeated (const std::vector<Eigen::Vector3f> &positions, int threads);

} // namespace erkpa
