// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace erkpa
{

/** \brief Below what a pivot of the moment matrix says that the nodes do not determine its term: a share of something.
 */
struct PivotFloor
{
  enum class Of
  {
    WEIGHT, ///< the nodes' total weight W
    SPREAD, ///< W (C / W)^p for a term of degree p, C = the weighted variance of the nodes, in all directions together
    MOMENT  ///< the term's own moment M_jj
  };

  double share;
  Of of;
};

/** \brief The floor of a polynomial of a degree.
 *
 * With functional values (eq. 2) nothing but the thickness of the nodes says anything about the slope across the
 * surface: below 14 % of the spread (2e-2 of its square) it is as likely noise, and a slope fitted to noise is useless.
 * A larger share would bear more noise, but bend clean curved surfaces, and count where nodes fill space.
 */
inline PivotFloor
floorOfPolynomial (int degree, bool functional)
{
  constexpr double FUNCTIONAL[] = {0.0, 2e-2, 1e-3}, OTHERS[] = {0.0, 1e-10, 1e-4};
  if (functional)
    return {FUNCTIONAL[degree], PivotFloor::Of::SPREAD};
  return {OTHERS[degree], PivotFloor::Of::WEIGHT};
}

/** \brief The floor of an enrichment.
 *
 * With gradients: a smaller one keeps it exact up to fewer nodes beyond its surface, a larger one fades it over a
 * longer way; on the edges of a box |f| was measured to stay below a third of the share, in units of ε. Without, it
 * counts as undetermined where the polynomials all but agree with it on the nodes, as on a perfect edge, and not where
 * only few nodes lie beyond its surface: there the paper's method takes it as it is.
 */
inline PivotFloor
floorOfEnrichment (bool fits_gradients)
{
  if (fits_gradients)
    return {2e-5, PivotFloor::Of::WEIGHT};
  return {1e-3, PivotFloor::Of::MOMENT};
}

} // namespace erkpa
