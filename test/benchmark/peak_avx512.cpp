// SPDX-License-Identifier: BSD-3-Clause
#include "peak_loop.h"
#include "peak_rate.h"

namespace bench
{

float
runMultiplyAddsAvx512 (std::size_t rounds)
{
  return runMultiplyAdds<xsimd::avx512f> (rounds);
}

} // namespace bench
