// SPDX-License-Identifier: BSD-3-Clause
#include "peak_loop.h"
#include "peak_rate.h"

namespace bench
{

float
runMultiplyAddsAvx2 (std::size_t rounds)
{
  return runMultiplyAdds<xsimd::fma3<xsimd::avx2>> (rounds);
}

} // namespace bench
