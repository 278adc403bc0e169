// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>

namespace erkpa
{

/** \brief Gives points near sharp edges the normal of the face they lie on.
 *
 * For normals that were estimated from all neighbours alike, which near an edge are those of neither face. Where a
 * quadric over the neighbours of a point explains them (but for positionNoise), its normal at the point is taken.
 * Elsewhere the quadrics and planes of the points around compete (Kuwahara's filter, on surfaces): the one that fits
 * its own neighbours and comes close to the point wins. It is then fitted again to those neighbours of the point that
 * lie on it and, in a second round, whose new normals are its own. Faces of three to four spacings, edges of 30
 * degrees and more and both sides of thin plates are kept apart; a point on the edge gets one of the faces.
 * \param[in] spacing measureSpacing
 * \param[in] k neighbours that the normals were estimated from; where there is noise half as many again are looked at
 * \param[in] threads 0 = all processors; the result does not depend on it
 * \param[in,out] points all normals given; nothing but the side they point to is used
 */
void
sharpenNormals (const NeighborSearch &search, double spacing, int k, int threads, OrientedPoints &points);

/** \brief Whether normals look like estimates that are smeared over sharp edges, which sharpenNormals would mend.
 *
 * Near an edge a smeared normal leans towards the normal of the other face; an exact one does not, and one with a
 * random error leans that way as often as away from it. Hence the median of that lean tells, as a share of the edge's
 * angle. No edges, no smear.
 */
bool
areNormalsSmeared (const NeighborSearch &search, double spacing, int k, int threads, const OrientedPoints &points);

} // namespace erkpa
