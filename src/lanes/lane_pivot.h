// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_vector.h"
#include "lanes.h"

namespace erkpa::lanes
{

/** \brief See erkpa::floorOfPolynomial ().
 * \param[in] weight,spread Σ w and Σ w |u - centroid|²
 */
template <typename B>
B
floorOfPolynomial (Constraint constraint, int degree, B weight, B spread)
{
  if (degree == 0)
    return B (0.0f);
  if (constraint == Constraint::FUNCTIONAL)
    return degree == 1 ? B (2e-2f) * spread : B (1e-3f) * spread * spread / weight;
  return B (degree == 1 ? 1e-10f : 1e-4f) * weight;
}

/** \brief See erkpa::floorOfEnrichment ().
 * \param[in] moment the term's own
 */
template <typename B>
B
floorOfKink (Constraint constraint, B weight, B moment)
{
  return constraint == Constraint::HERMITE ? B (2e-5f) * weight : B (1e-3f) * moment;
}

/** \brief A pivot of the moment matrix, raised where it is below its floor: see MomentSystem. */
template <typename B>
struct LanePivot
{
  B pivot, floor; ///< as they were
  B raise, slope; ///< ρ, and dρ / dpivot

  /** \brief \return ρ + pivot; 1 where there is nothing to determine */
  B
  raiseFrom (B of_nodes, B least)
  {
    constexpr float LEAST = 1e-9f;
    const B zero (0.0f), one (1.0f);
    pivot = of_nodes;
    floor = least;
    raise = slope = zero;
    const auto is_low = pivot < floor;
    if (!xsimd::any (is_low))
      return xsimd::select (pivot > zero, pivot, one);
    const B share = xsimd::max (pivot / xsimd::select (floor > zero, floor, one), B (LEAST));
    raise = xsimd::select (is_low, floor * (one - share) * (one - share) / share, zero);
    slope = xsimd::select (is_low && share > B (LEAST), one - one / (share * share), zero);
    const B raised = xsimd::select (is_low, floor * share + raise, pivot);
    return xsimd::select (raised > zero, raised, one);
  }
};

} // namespace erkpa::lanes
