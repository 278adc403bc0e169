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

template <typename B>
B
dot (const B *a, const B *b)
{
  return xsimd::fma (a[2], b[2], xsimd::fma (a[1], b[1], a[0] * b[0]));
}

} // namespace erkpa::lanes
