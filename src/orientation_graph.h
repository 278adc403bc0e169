// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief What a pair of nodes says about their signs. */
struct SignedLink
{
  int from, to;
  float weight; ///< positive: the same sign, negative: opposite signs
};

/** \brief Signs that agree with the links as far as possible.
 *
 * Where single links between neighbours are sure, and no third node contradicts, they hold: so most nodes of a smooth
 * surface come together. Then greedy contraction: the two sets of nodes that are surest of their relative sign become
 * one, and what their nodes say about every other set is added up. Takes O(m log m) steps for m links.
 * \param[in] between_neighbors so many of the links, the first ones, are between neighbours, sorted by where from
 * \return per node, whether it is opposite to its set
 */
std::vector<char>
agreeOnSigns (int count, const std::vector<SignedLink> &links, std::size_t between_neighbors, int threads);

/** \brief The piece that every node belongs to: what links hold together, named by its first node. */
std::vector<int>
piecesOf (int count, const std::vector<SignedLink> &links);

} // namespace erkpa
