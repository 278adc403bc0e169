// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/normals.h>

#include <vector>

namespace erkpa
{

/** \brief Give estimated normals their sign.
 *
 * Signs are found on facets, which unlike the normals follow a sharp edge up to the crease and keep the two sides of a
 * thin wall apart (findFacets). Neighbours say whether they have the same sign, by their normals and by which side of
 * each facet the other one lies on (right at edges and between sheets); the layers of a closed surface say which side
 * is out (votesOfLayers). Sets of nodes grow from the surest to the least sure, all votes between them added up
 * (agreeOnSigns). Each piece that hangs together is then turned as a whole: like the given normals in it; else, where
 * the view point is known and nearly all of the piece could be seen from it, towards it, point by point; else
 * outwards. An estimated normal that lies across its facet, as on rims and in thin walls, is replaced by the facet's.
 * \param[in] points positions; a normal that is not zero was given and keeps its sign
 * \param[in] k neighbours that the normals were estimated from
 * \param[in,out] normals all normals, the given ones included
 */
Orientation
orientNormals (const OrientedPoints &points, const NeighborSearch &search, int k, const NormalOptions &options,
               std::vector<Eigen::Vector3f> &normals);

} // namespace erkpa
