// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "orientation_facets.h"

#include <vector>

namespace erkpa
{

/** \brief The columns that a node lies in, but for those with a part of the surface along them. */
struct LayerVotes
{
  int outwards = 0; ///< columns that say its facet's normal points outwards, less those that say the contrary
  int even = 0;     ///< columns with an even number of layers, which have a say
  int odd = 0;      ///< the others: there are many where a surface is open
};

/** \brief What the layers of a closed surface say about its outside.
 *
 * A ray through a solid enters and leaves it by turns. The cloud is cut into columns along several directions; where
 * the facets in a column form an even number of layers, those of the first, third ... layer face the way the ray comes
 * from.
 * \return per node
 */
std::vector<LayerVotes>
votesOfLayers (const OrientedPoints &points, const Facets &facets, int threads);

} // namespace erkpa
