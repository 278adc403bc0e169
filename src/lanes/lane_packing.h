// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_vector.h"

#include <cstddef>
#include <cstdint>

namespace erkpa::lanes
{

/** \brief The lanes of a vector that are kept, and what vectors hold in them, closed up.
 *
 * No branch depends on which ones are kept: none could foretell it.
 */
template <typename B>
class Packing
{
public:
  static constexpr std::size_t WIDTH = B::size;

  /** \brief Keeps, of the first \a count lanes, those where \a margin is not negative. */
  Packing (B margin, std::size_t count)
  {
    float margins[WIDTH];
    margin.store_unaligned (margins);
    for (std::size_t lane = 0; lane < (count < WIDTH ? count : WIDTH); ++lane)
    {
      kept_[size_] = static_cast<std::uint8_t> (lane);
      size_ += margins[lane] >= 0.0f ? 1 : 0;
    }
  }

  /** \brief How many are kept. */
  std::size_t
  size () const
  {
    return size_;
  }

  /** \brief Write the kept ones of \a values, and something in the rest of WIDTH places. */
  void
  pack (B values, float *to) const
  {
    float all[WIDTH];
    values.store_unaligned (all);
    for (std::size_t i = 0; i < WIDTH; ++i)
      to[i] = all[kept_[i]];
  }

  /** \brief The same of the numbers from \a first on. */
  void
  packNumbers (std::size_t first, std::uint32_t *to) const
  {
    for (std::size_t i = 0; i < WIDTH; ++i)
      to[i] = static_cast<std::uint32_t> (first + kept_[i]);
  }

  /** \brief The first \a count lanes from an array; nothing beyond these is read. */
  static B
  load (const float *from, std::size_t count)
  {
    if (count >= WIDTH)
      return B::load_unaligned (from);
    float all[WIDTH] = {};
    for (std::size_t lane = 0; lane < count; ++lane)
      all[lane] = from[lane];
    return B::load_unaligned (all);
  }

private:
  std::size_t size_ = 0;
  std::uint8_t kept_[WIDTH + 1] = {};
};

#ifdef __AVX512F__
template <>
class Packing<xsimd::batch<float, xsimd::avx512f>>
{
public:
  using B = xsimd::batch<float, xsimd::avx512f>;

  Packing (B margin, std::size_t count)
      : kept_ (_mm512_mask_cmp_ps_mask (firstLanes (count), margin, _mm512_setzero_ps (), _CMP_GE_OQ))
  {
  }

  std::size_t
  size () const
  {
    return static_cast<std::size_t> (__builtin_popcount (kept_));
  }

  void
  pack (B values, float *to) const
  {
    // By way of a register: compressing into memory is slow on some processors.
    _mm512_storeu_ps (to, _mm512_maskz_compress_ps (kept_, values));
  }

  void
  packNumbers (std::size_t first, std::uint32_t *to) const
  {
    const __m512i numbers = _mm512_add_epi32 (_mm512_set1_epi32 (static_cast<int> (first)),
                                              _mm512_setr_epi32 (0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
    _mm512_storeu_si512 (to, _mm512_maskz_compress_epi32 (kept_, numbers));
  }

  static B
  load (const float *from, std::size_t count)
  {
    return _mm512_maskz_loadu_ps (firstLanes (count), from);
  }

private:
  static __mmask16
  firstLanes (std::size_t count)
  {
    return static_cast<__mmask16> (count < 16 ? (1u << count) - 1u : 0xffffu);
  }

  __mmask16 kept_;
};
#elif defined(__AVX2__) && defined(__FMA__)
/** \brief For each set of eight lanes these lanes one after the other, a byte each. */
struct PackedLanes
{
  std::uint64_t lanes[256] = {};

  constexpr PackedLanes ()
  {
    for (unsigned set = 0; set < 256; ++set)
      for (unsigned lane = 0, shift = 0; lane < 8; ++lane)
        if ((set >> lane & 1u) != 0)
        {
          lanes[set] |= static_cast<std::uint64_t> (lane) << shift;
          shift += 8;
        }
  }
};

template <>
class Packing<xsimd::batch<float, xsimd::fma3<xsimd::avx2>>>
{
public:
  using B = xsimd::batch<float, xsimd::fma3<xsimd::avx2>>;

  Packing (B margin, std::size_t count)
      : Packing (static_cast<unsigned> (_mm256_movemask_ps (_mm256_cmp_ps (margin, _mm256_setzero_ps (), _CMP_GE_OQ))) &
                 (count < 8 ? (1u << count) - 1u : 0xffu))
  {
  }

  std::size_t
  size () const
  {
    return size_;
  }

  void
  pack (B values, float *to) const
  {
    _mm256_storeu_ps (to, _mm256_permutevar8x32_ps (values, order_));
  }

  void
  packNumbers (std::size_t first, std::uint32_t *to) const
  {
    const __m256i numbers = _mm256_add_epi32 (_mm256_set1_epi32 (static_cast<int> (first)), order_);
    _mm256_storeu_si256 (reinterpret_cast<__m256i *> (to), numbers);
  }

  static B
  load (const float *from, std::size_t count)
  {
    if (count >= 8)
      return _mm256_loadu_ps (from);
    const __m256i lanes = _mm256_setr_epi32 (0, 1, 2, 3, 4, 5, 6, 7);
    return _mm256_maskload_ps (from, _mm256_cmpgt_epi32 (_mm256_set1_epi32 (static_cast<int> (count)), lanes));
  }

private:
  /** \param[in] lanes bits of those that are kept */
  explicit Packing (unsigned lanes)
      : size_ (static_cast<std::size_t> (__builtin_popcount (lanes))),
        order_ (_mm256_cvtepu8_epi32 (_mm_cvtsi64_si128 (static_cast<long long> (PACKED.lanes[lanes]))))
  {
  }

  static constexpr PackedLanes PACKED{};

  std::size_t size_;
  __m256i order_;
};
#endif

} // namespace erkpa::lanes
