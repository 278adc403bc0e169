// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lanes.h"

#include <xsimd/xsimd.hpp>

namespace erkpa::lanes
{

/** \brief The kernels of kernel.h in lanes; exactly zero at t = 1. */
template <typename B>
struct PaperKernel
{
  static constexpr bool IS_GENERAL = false; ///< whether supports may be flattened

  explicit PaperKernel (Kernel) {}

  B
  weight (B t) const
  {
    weights<1> (&t);
    return t;
  }

  /** \brief From t to the weights of N nodes at once: 1 - 10 t³ + 15 t⁴ - 6 t⁵ as (1 - t)³ (1 + 3 t + 6 t²): far from
   * the nodes all of them are near t = 1, where floats would lose what is left of the difference. */
  template <std::size_t N>
  [[gnu::always_inline]] void
  weights (B *t) const
  {
    const B one (1.0f), three (3.0f), six (6.0f);
    B s[N], p[N];
    for (std::size_t n = 0; n < N; ++n)
      p[n] = xsimd::fma (six, t[n], three);
    for (std::size_t n = 0; n < N; ++n)
      s[n] = one - t[n];
    for (std::size_t n = 0; n < N; ++n)
      p[n] = xsimd::fma (t[n], p[n], one);
    for (std::size_t n = 0; n < N; ++n)
      t[n] = s[n] * s[n];
    for (std::size_t n = 0; n < N; ++n)
      p[n] *= s[n];
    for (std::size_t n = 0; n < N; ++n)
      t[n] *= p[n];
  }

  /** \brief dw/dt / t. */
  B
  slope (B t) const
  {
    const B s = B (1.0f) - t;
    return B (-30.0f) * t * s * s;
  }
};

/** \brief Any of them, chosen at run time. */
template <typename B>
class AnyKernel
{
public:
  static constexpr bool IS_GENERAL = true;

  explicit AnyKernel (Kernel kernel) : kernel_ (kernel) {}

  B
  weight (B t) const
  {
    const B s = B (1.0f) - t, s2 = s * s;
    switch (kernel_)
    {
      case Kernel::WENDLAND_C2:
        return s2 * s2 * xsimd::fma (B (4.0f), t, B (1.0f));
      case Kernel::WENDLAND_C4:
        return s2 * s2 * s2 * xsimd::fma (t, xsimd::fma (B (35.0f), t, B (18.0f)), B (3.0f)) * B (1.0f / 3.0f);
      case Kernel::GAUSSIAN:
      {
        const B r = B (1.0f) - t * t;
        return xsimd::exp (B (-STEEPNESS) * t * t) * r * r * r;
      }
      case Kernel::PAPER:
        break;
    }
    return PaperKernel<B> (kernel_).weight (t);
  }

  template <std::size_t N>
  void
  weights (B *t) const
  {
    for (std::size_t n = 0; n < N; ++n)
      t[n] = weight (t[n]);
  }

  B
  slope (B t) const
  {
    const B s = B (1.0f) - t, s2 = s * s;
    switch (kernel_)
    {
      case Kernel::WENDLAND_C2:
        return B (-20.0f) * s2 * s;
      case Kernel::WENDLAND_C4:
        return B (-56.0f / 3.0f) * s2 * s2 * s * xsimd::fma (B (5.0f), t, B (1.0f));
      case Kernel::GAUSSIAN:
      {
        const B r = B (1.0f) - t * t;
        return -xsimd::exp (B (-STEEPNESS) * t * t) * r * r * xsimd::fma (B (2.0f * STEEPNESS), r, B (6.0f));
      }
      case Kernel::PAPER:
        break;
    }
    return PaperKernel<B> (kernel_).slope (t);
  }

private:
  static constexpr float STEEPNESS = 4.0f;
  Kernel kernel_;
};

} // namespace erkpa::lanes
