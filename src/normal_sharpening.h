// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>

namespace erkpa
{

/** \brief What normals are estimated and mended by. */
struct NormalScale
{
  double spacing = 0.0; ///< measureSpacing
  double noise = 0.0;   ///< positionNoise
  int k = 0;            ///< neighbours that a normal is estimated from
};

/** \brief Gives points near sharp edges the normal of the face they lie on.
 *
 * For normals that were estimated from all neighbours alike, which near an edge are those of neither face. Where a
 * quadric over the neighbours of a point explains them (but for positionNoise), its normal at the point is taken.
 * Elsewhere the quadrics and planes of the points around compete (Kuwahara's filter, on surfaces): the one that fits
 * its own neighbours and comes close to the point wins. It is then fitted again to those neighbours of the point that
 * lie on it and, in a second round, whose new normals are its own. Faces of three to four spacings, edges of 30
 * degrees and more and both sides of thin plates are kept apart; a point on the edge gets one of the faces.
 * \param[in] scale where there is noise half as many neighbours again are looked at
 * \param[in] threads 0 = all processors; the result does not depend on it
 * \param[in,out] points all normals given; nothing but the side they point to is used
 */
void
sharpenNormals (const NeighborSearch &search, const NormalScale &scale, int threads, OrientedPoints &points);

/** \brief Whether normals look like estimates that are smeared over sharp edges, which sharpenNormals would mend.
 *
 * Near an edge a smeared normal leans towards the normal of the other face; an exact one does not, and one with a
 * random error leans that way as often as away from it. Hence the median of that lean tells, as a share of the edge's
 * angle. No edges, no smear. Some pieces of the cloud tell it, few of them where
 * they clearly say no.
 */
bool
areNormalsSmeared (const NeighborSearch &search, const NormalScale &scale, int threads, const OrientedPoints &points);

} // namespace erkpa
