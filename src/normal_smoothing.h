// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief Some numbers below \a size, evenly spread: enough for a quantile that does not depend on which they are. */
std::vector<std::size_t>
spreadSample (std::size_t size);

/** \brief Bilateral filter of normals (Zheng et al. 2011, on points): means over neighbours that are near and alike.
 * \param[in] spacing measureSpacing: the weight falls with the distance as a Gaussian of 1.5 spacings
 * \param[in] passes how often; each reads the normals that the one before has left
 * \param[in] neighbors how many points a mean is over, its own among them
 * \param[in] sigma_degrees the weight falls with the angle between the normals as a Gaussian of this width
 */
void
smoothNormals (const NeighborSearch &search, double spacing, int passes, int neighbors, double sigma_degrees,
               int threads, OrientedPoints &points);

/** \brief Random error of the normals, root mean square angle in degrees.
 *
 * From what is left of a normal when the linear function of the position that fits its neighbours' normals is taken
 * off: the median over the points, so that what happens at sharp edges does not count. Sees no error that neighbours
 * share.
 */
double
normalNoise (const NeighborSearch &search, double spacing, int threads, const OrientedPoints &points);

/** \brief Standard deviation of the points about the surface along its normal, input's unit of length.
 *
 * What is left of small neighbourhoods beside a quadric, in the flatter part of them; edges do not count.
 */
double
positionNoise (const NeighborSearch &search, double spacing, int threads, const OrientedPoints &points);

} // namespace erkpa
