// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "orientation_facets.h"
#include "orientation_graph.h"

#include <vector>

namespace erkpa
{

/** \brief What facets say about the signs of their neighbours'.
 * \param[in] nodes whose links are wanted, in ascending order
 * \return sorted by the nodes that they lead from
 */
std::vector<SignedLink>
linkNeighbors (const OrientedPoints &points, const NeighborSearch &search, const Facets &facets,
               const std::vector<int> &nodes, int threads);

} // namespace erkpa
