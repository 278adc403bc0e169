// SPDX-License-Identifier: BSD-3-Clause
#include "peak_loop.h"
#include "peak_rate.h"

namespace bench
{

float
runMultiplyAddsBaseline (std::size_t rounds)
{
  return runMultiplyAdds<xsimd::default_arch> (rounds);
}

} // namespace bench
