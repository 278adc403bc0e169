// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_vector.h"
#include "lanes.h"

namespace erkpa::lanes
{

#ifdef __AVX512F__
/** \brief Appends to a list the numbers from \a first on of the lanes in a mask. */
template <typename B>
std::size_t
appendLanes (__mmask16 mask, std::size_t first, std::uint32_t *list)
{
  const __m512i numbers = _mm512_add_epi32 (_mm512_set1_epi32 (static_cast<int> (first)),
                                            _mm512_setr_epi32 (0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
  // By way of a register: compressing into memory is slow on some processors.
  _mm512_storeu_si512 (list, _mm512_maskz_compress_epi32 (mask, numbers));
  return static_cast<std::size_t> (__builtin_popcount (mask));
}

template <typename B>
__mmask16
firstLanes (std::size_t count)
{
  return static_cast<__mmask16> (count < 16 ? (1u << count) - 1u : 0xffffu);
}
#endif

/** \brief Appends to a list the numbers from \a first on of those lanes, of \a count, where \a margin is not negative.
 * \param[out] list has room for as many as there are lanes
 * \return how many
 */
template <typename B>
std::size_t
appendWhere (B margin, std::size_t first, std::size_t count, std::uint32_t *list)
{
#ifdef __AVX512F__
  if constexpr (IS_WIDEST<B>)
    return appendLanes<B> (_mm512_mask_cmp_ps_mask (firstLanes<B> (count), margin, _mm512_setzero_ps (), _CMP_GE_OQ),
                           first, list);
#endif
  float margins[B::size];
  margin.store_unaligned (margins);
  std::size_t appended = 0;
  for (std::size_t i = 0; i < (count < B::size ? count : B::size); ++i)
  {
    list[appended] = static_cast<std::uint32_t> (first + i);
    appended += margins[i] >= 0.0f ? 1 : 0; // no branch, which none could foretell
  }
  return appended;
}

/** \brief Copies what an array holds at some places, which ascend; those that follow each other at once. */
template <typename B>
void
pick (const float *from, const std::uint32_t *places, std::size_t count, float *picked)
{
  constexpr std::size_t WIDTH = B::size;
  std::size_t i = 0;
  for (; i + WIDTH <= count; i += WIDTH)
    if (places[i + WIDTH - 1] - places[i] == WIDTH - 1)
      B::load_unaligned (from + places[i]).store_unaligned (picked + i);
    else
      for (std::size_t j = i; j < i + WIDTH; ++j)
        picked[j] = from[places[j]];
  for (; i < count; ++i)
    picked[i] = from[places[i]];
}

#ifdef __AVX512F__
/** \brief Closes up what arrays hold, from \a first on, in the lanes where \a margin is not negative, as appendWhere ()
 * does it with their numbers. */
template <typename B>
void
closeUpWhere (B margin, std::size_t first, std::size_t count, const float *const *from, std::size_t arrays,
              float *const *to, std::size_t place)
{
  const __mmask16 there = firstLanes<B> (count);
  const __mmask16 kept = _mm512_mask_cmp_ps_mask (there, margin, _mm512_setzero_ps (), _CMP_GE_OQ);
  for (std::size_t a = 0; a < arrays; ++a)
    _mm512_storeu_ps (to[a] + place, _mm512_maskz_compress_ps (kept, _mm512_maskz_loadu_ps (there, from[a] + first)));
}
#endif

/** \brief See Search::findWithin. */
template <typename B>
std::size_t
findWithin (const Cloud &cloud, const Stretch *stretches, std::size_t count, const float *center, float limit,
            const Found &found)
{
  std::size_t kept = 0;
  for (const Stretch *stretch = stretches; stretch != stretches + count; ++stretch)
#ifdef __AVX512F__
    if constexpr (IS_WIDEST<B>)
      for (std::size_t first = stretch->first; first < stretch->last; first += 16)
      {
        const __mmask16 lanes = firstLanes<B> (stretch->last - first);
        const __m512 dx = _mm512_sub_ps (_mm512_maskz_loadu_ps (lanes, cloud.x + first), _mm512_set1_ps (center[0]));
        const __m512 dy = _mm512_sub_ps (_mm512_maskz_loadu_ps (lanes, cloud.y + first), _mm512_set1_ps (center[1]));
        const __m512 dz = _mm512_sub_ps (_mm512_maskz_loadu_ps (lanes, cloud.z + first), _mm512_set1_ps (center[2]));
        const __m512 squared = _mm512_fmadd_ps (dz, dz, _mm512_fmadd_ps (dy, dy, _mm512_mul_ps (dx, dx)));
        const __mmask16 mask = _mm512_mask_cmp_ps_mask (lanes, squared, _mm512_set1_ps (limit), _CMP_LE_OQ);
        _mm512_storeu_ps (found.squared + kept, _mm512_maskz_compress_ps (mask, squared));
        kept += appendLanes<B> (mask, first, found.places + kept);
      }
    else
#endif
      for (std::size_t place = stretch->first; place < stretch->last; ++place)
      {
        const float dx = cloud.x[place] - center[0], dy = cloud.y[place] - center[1], dz = cloud.z[place] - center[2];
        const float squared = dx * dx + dy * dy + dz * dz;
        found.places[kept] = static_cast<std::uint32_t> (place);
        found.squared[kept] = squared;
        kept += squared <= limit ? 1 : 0;
      }
  return kept;
}

#ifdef __AVX512F__
/** \brief copyWithin () for sixteen points at once. */
template <typename B>
std::size_t
copyLanesWithin (const Table &table, const Stretch &stretch, const float *center, float limit, float scale,
                 const Copies &copies, std::size_t kept)
{
  for (std::size_t first = stretch.first; first < stretch.last; first += 16)
  {
    const __mmask16 lanes = firstLanes<B> (stretch.last - first);
    __m512 d[3];
    for (std::size_t a = 0; a < 3; ++a)
      d[a] = _mm512_sub_ps (_mm512_maskz_loadu_ps (lanes, table.columns[a] + first), _mm512_set1_ps (center[a]));
    const __m512 squared = _mm512_fmadd_ps (d[2], d[2], _mm512_fmadd_ps (d[1], d[1], _mm512_mul_ps (d[0], d[0])));
    const __mmask16 mask = _mm512_mask_cmp_ps_mask (lanes, squared, _mm512_set1_ps (limit), _CMP_LE_OQ);
    for (std::size_t a = 0; a < 3; ++a)
      _mm512_storeu_ps (copies.columns[a] + kept,
                        _mm512_maskz_compress_ps (mask, _mm512_mul_ps (d[a], _mm512_set1_ps (scale))));
    for (std::size_t a = 3; a < Table::COLUMNS; ++a)
      _mm512_storeu_ps (copies.columns[a] + kept,
                        _mm512_maskz_compress_ps (mask, _mm512_maskz_loadu_ps (lanes, table.columns[a] + first)));
    if (copies.squared != nullptr)
      _mm512_storeu_ps (copies.squared + kept, _mm512_maskz_compress_ps (mask, squared));
    kept += appendLanes<B> (mask, first, copies.places + kept);
  }
  return kept;
}
#endif

/** \brief See Search::copyWithin. */
template <typename B>
std::size_t
copyWithin (const Table &table, const Stretch *stretches, std::size_t count, const float *center, float limit,
            float scale, const Copies &copies)
{
#ifdef __AVX512F__
  if constexpr (IS_WIDEST<B>)
  {
    std::size_t kept = 0;
    for (const Stretch *stretch = stretches; stretch != stretches + count; ++stretch)
      kept = copyLanesWithin<B> (table, *stretch, center, limit, scale, copies, kept);
    return kept;
  }
#endif
  const std::size_t kept =
      findWithin<B> ({table.columns[0], table.columns[1], table.columns[2]}, stretches, count, center, limit,
                     {copies.places, copies.squared != nullptr ? copies.squared : copies.columns[0]});
  for (std::size_t a = 0; a < Table::COLUMNS; ++a)
    pick<B> (table.columns[a], copies.places, kept, copies.columns[a]);
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t i = 0; i < kept; ++i)
      copies.columns[a][i] = (copies.columns[a][i] - center[a]) * scale;
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
