// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>

#include <cstddef>

namespace erkpa
{

/** \brief Whether normals agree on which side is out. */
enum class NormalSigns
{
  AGREE,
  SINGLE_ONES_FLIPPED, ///< some look the other way than nearly all around them
  MANY_FLIPPED,        ///< up to about a quarter do: most neighbours are right
  CONTRADICT           ///< neighbours look opposite ways as often as not: nobody has oriented them
};

/** \brief Judge by a sample.
 *
 * The other sides of thin walls are no contradiction: they lie behind each other.
 */
NormalSigns
judgeSigns (const NeighborSearch &search, int threads, const OrientedPoints &points);

/** \brief Turn the normals of points that look the other way than most of their neighbours on the same level.
 *
 * They would be faces of their own, on the back of a wall without thickness. Points of real walls lie on another level
 * than those of the other side; where single ones are flipped, nearly all neighbours have to say so.
 * \param[in] signs SINGLE_ONES_FLIPPED or MANY_FLIPPED
 * \return how many look the other way now
 */
std::size_t
turnFlippedNormals (const NeighborSearch &search, NormalSigns signs, int threads, OrientedPoints &points);

} // namespace erkpa
