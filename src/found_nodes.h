// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace erkpa
{

/** \brief What a NeighborSearch finds. A thread keeps one from query to query, for its memory. */
struct FoundNodes
{
  std::vector<int> nodes;
  std::vector<float> squared; ///< distances from the place that was asked for
};

} // namespace erkpa
