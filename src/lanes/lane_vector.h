// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <xsimd/xsimd.hpp>

#include <type_traits>

namespace erkpa::lanes
{

/** \brief Whether vectors are those of AVX-512, for which xsimd 8 lacks what follows. */
template <typename B>
constexpr bool IS_WIDEST =
#ifdef __AVX512F__
    std::is_same_v<B, xsimd::batch<float, xsimd::avx512f>>;
#else
    false;
#endif

/** \brief c - a b, rounded once. */
template <typename B>
B
fnma (const B &a, const B &b, const B &c)
{
#ifdef __AVX512F__
  if constexpr (IS_WIDEST<B>)
    return _mm512_fnmadd_ps (a, b, c);
  else
#endif
    return xsimd::fnma (a, b, c);
}

/** \brief The processor's estimate of 1/√s, to a dozen bits at least. */
template <typename B>
B
inverseRoot (const B &s)
{
#ifdef __AVX512F__
  if constexpr (IS_WIDEST<B>)
    return _mm512_rsqrt14_ps (s);
  else
#endif
#if defined(__x86_64__) || defined(__i386__)
    return xsimd::rsqrt (s);
#else
  return B (1.0f) / xsimd::sqrt (s); // other estimates are too coarse for one Newton step
#endif
}

/** \brief Of COUNT sums so many are taken up at once: as many as there are registers, in groups of about the same size.
 */
template <typename B, int COUNT, int MOST = B::size == 16 ? 26 : 12>
constexpr int SUMS_AT_ONCE = (COUNT + (COUNT + MOST - 1) / MOST - 1) / ((COUNT + MOST - 1) / MOST);

template <typename B>
B
dot (const B *a, const B *b)
{
  return xsimd::fma (a[2], b[2], xsimd::fma (a[1], b[1], a[0] * b[0]));
}

/** \brief Counts, lane by lane, how often something holds; fewer than 2^24 times. */
template <typename B>
class LaneCount
{
public:
  using Mask = decltype (B () < B ());

  void
  add (const Mask &holds)
  {
#if defined(__AVX2__) && !defined(__AVX512F__)
    counts_ = _mm256_sub_epi32 (counts_, _mm256_castps_si256 (holds)); // a lane of the mask is -1
#else
    counts_ = xsimd::select (holds, counts_ + B (1.0f), counts_);
#endif
  }

  B
  count () const
  {
#if defined(__AVX2__) && !defined(__AVX512F__)
    return _mm256_cvtepi32_ps (counts_);
#else
    return counts_;
#endif
  }

private:
#if defined(__AVX2__) && !defined(__AVX512F__)
  __m256i counts_ = _mm256_setzero_si256 ();
#else
  B counts_ = B (0.0f);
#endif
};

} // namespace erkpa::lanes
