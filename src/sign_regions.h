// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "orientation_graph.h"

#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief Turn small regions whose signs most links to their surroundings speak against.
 *
 * Sets that became one are not parted again (agreeOnSigns), even where what they heard of each other later speaks
 * against it. From links that are not heeded a region grows, node by node, each time by the one that leaves the least
 * agreement with the nodes around; it is turned where that falls below zero.
 * \param[in] links sorted by the nodes that they lead from; the first \a between_neighbors are between neighbours, the
 * others lead to the outside, which is the last node
 * \param[in,out] flips per node
 */
void
turnRegions (const std::vector<SignedLink> &links, std::size_t between_neighbors, std::vector<char> &flips);

} // namespace erkpa
