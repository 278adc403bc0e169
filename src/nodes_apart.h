// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "smooth_links.h"

#include <vector>

namespace erkpa
{

using NodeLists = std::vector<std::vector<int>>; ///< per node

/** \brief For every node the nodes that must not be on its face; both see it so. */
NodeLists
findNodesApart (const OrientedPoints &points, const NeighborSearch &search, const SegmentationOptions &options,
                const NodeLinks &links, const std::vector<char> &is_suspect, int threads);

} // namespace erkpa
