// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "orientation_graph.h"

#include <vector>

namespace erkpa
{

/** \brief Turn small regions whose signs the links to their surroundings speak against.
 *
 * Sets that became one are not parted again (agreeOnSigns), even where what they heard of each other later speaks
 * against it. From links that are not heeded a region grows, node by node, each time by the one that agrees most with
 * those in it; it is turned where its agreement with the nodes around falls below zero. So the sum over all links of
 * how far the signs are as they say only rises.
 * \param[in,out] flips per node; the last node is the outside, which stays
 */
void
turnRegions (const std::vector<SignedLink> &links, std::vector<char> &flips);

} // namespace erkpa
