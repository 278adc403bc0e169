// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_packing.h"
#include "lane_vector.h"
#include "lanes.h"

namespace erkpa::lanes
{

/** \brief Calls take (first, packing, squared, d) for the points of stretches, so many at once as there are lanes:
 * which of them, from the first on, lie within the limit, their squared distances from the center and x_i - center. */
template <typename B, typename TakeT>
void
visitWithin (const float *const *positions, const Stretch *stretches, std::size_t count, const float *center,
             float limit, TakeT take)
{
  for (const Stretch *stretch = stretches; stretch != stretches + count; ++stretch)
    for (std::size_t first = stretch->first; first < stretch->last; first += B::size)
    {
      const std::size_t left = stretch->last - first;
      B d[3];
      for (std::size_t a = 0; a < 3; ++a)
        d[a] = Packing<B>::load (positions[a] + first, left) - B (center[a]);
      const B squared = dot (d, d);
      take (first, left, Packing<B> (B (limit) - squared, left), squared, d);
    }
}

/** \brief See Search::findWithin. */
template <typename B>
std::size_t
findWithin (const Cloud &cloud, const Stretch *stretches, std::size_t count, const float *center, float limit,
            const Found &found)
{
  std::size_t kept = 0;
  const float *const positions[] = {cloud.x, cloud.y, cloud.z};
  visitWithin<B> (positions, stretches, count, center, limit,
                  [&] (std::size_t first, std::size_t, const Packing<B> &packing, B squared, const B *)
                  {
                    packing.pack (squared, found.squared + kept);
                    packing.packNumbers (first, found.places + kept);
                    kept += packing.size ();
                  });
  return kept;
}

/** \brief See Search::copyWithin. */
template <typename B>
std::size_t
copyWithin (const Table &table, const Stretch *stretches, std::size_t count, const float *center, float limit,
            float scale, const Copies &copies)
{
  std::size_t kept = 0;
  visitWithin<B> (table.columns, stretches, count, center, limit,
                  [&] (std::size_t first, std::size_t left, const Packing<B> &packing, B squared, const B *d)
                  {
                    for (std::size_t a = 0; a < 3; ++a)
                      packing.pack (d[a] * B (scale), copies.columns[a] + kept);
                    for (std::size_t a = 3; a < (table.columns[3] != nullptr ? Table::COLUMNS : 3); ++a)
                      packing.pack (Packing<B>::load (table.columns[a] + first, left), copies.columns[a] + kept);
                    if (copies.squared != nullptr)
                      packing.pack (squared, copies.squared + kept);
                    packing.packNumbers (first, copies.places + kept);
                    kept += packing.size ();
                  });
  return kept;
}

/** \brief See Search::countWithin. */
template <typename B>
std::size_t
countWithin (const float *squared, std::size_t count, float limit)
{
  int within = 0;
  for (std::size_t i = 0; i < count; ++i)
    within += squared[i] <= limit ? 1 : 0;
  return static_cast<std::size_t> (within);
}

/** \brief The search in vectors of one instruction set. */
template <typename ArchT>
constexpr Search SEARCH{findWithin<xsimd::batch<float, ArchT>>, copyWithin<xsimd::batch<float, ArchT>>,
                        countWithin<xsimd::batch<float, ArchT>>};

} // namespace erkpa::lanes
