// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/normals.h>

#include <vector>

namespace erkpa
{

/** \brief Give estimated normals their sign.
 *
 * Neighbours are linked from the surest pair to the least sure (Hoppe et al. 1992), with the sign under which one
 * normal is the mirror image of the other across the middle of the pair (König and Gumhold 2009): right on both
 * sides of a sharp edge. Each piece that hangs together is then turned as a whole: like the given normals in it;
 * else, where the view point is known and nearly all of the piece could be seen from it, towards it, point by
 * point; else outwards.
 * \param[in] points positions; a normal that is not zero was given and keeps its sign
 * \param[in] k neighbours that the normals were estimated from
 * \param[in,out] normals all normals, the given ones included
 */
Orientation
orientNormals (const OrientedPoints &points, const NeighborSearch &search, int k, const NormalOptions &options,
               std::vector<Eigen::Vector3f> &normals);

} // namespace erkpa
