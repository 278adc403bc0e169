// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace erkpa
{

/** \brief Neighbours of a point, nearest first, with weights for a fit; memory of one thread. */
struct Neighborhood
{
  std::vector<int> nodes;
  std::vector<Eigen::Vector3f> positions;
  std::vector<float> weights;

  // of the query
  std::vector<int> indices;
  std::vector<float> squared_distances;
  std::vector<std::pair<float, int>> order;
};

} // namespace erkpa
