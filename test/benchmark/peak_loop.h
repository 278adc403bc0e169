// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <xsimd/xsimd.hpp>

#include <cstddef>

namespace bench
{

/** \brief So many vectors, each with a chain of multiply-adds of its own: more than a processor has under way at once,
 * and with the two factors no more than the 16 registers of the narrow instruction sets. */
constexpr std::size_t CHAINS = 14;

/** \brief Multiply-adds as fast as an instruction set has them; where it has none, a product and a sum.
 * \return a number that depends on all of them, so that none can be left out
 */
template <typename ArchT>
float
runMultiplyAdds (std::size_t rounds)
{
  using B = xsimd::batch<float, ArchT>;
  B x[CHAINS];
  for (std::size_t i = 0; i < CHAINS; ++i)
    x[i] = B (static_cast<float> (i + 2)); // 1 would stay, and the compiler knows it
  const B factor (0.999f), term (0.001f);  // x goes to 1: nothing over- or underflows
  for (std::size_t round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < CHAINS; ++i)
      x[i] = xsimd::fma (x[i], factor, term);
  B sum (0.0f);
  for (std::size_t i = 0; i < CHAINS; ++i)
    sum += x[i];
  float values[B::size], result = 0.0f;
  sum.store_unaligned (values);
  for (const float value : values)
    result += value;
  return result;
}

} // namespace bench
