// SPDX-License-Identifier: BSD-3-Clause
#include "lanes.h"

namespace erkpa::lanes
{

// Each in a unit of its own, the only one compiled for that instruction set.
extern const Engine BASELINE, AVX2, AVX512;

namespace
{

struct Available
{
  const Engine *engines[3];
  std::size_t count = 0;

  Available ()
  {
    engines[count++] = &BASELINE;
#ifdef ERKPA_X86_LANES
    if (__builtin_cpu_supports ("avx2") != 0 && __builtin_cpu_supports ("fma") != 0)
      engines[count++] = &AVX2;
    if (__builtin_cpu_supports ("avx512f") != 0)
      engines[count++] = &AVX512;
#endif
  }
};

const Available &
available ()
{
  static const Available AVAILABLE;
  return AVAILABLE;
}

} // namespace

const Engine *const *
engines (std::size_t &count)
{
  count = available ().count;
  return available ().engines;
}

const Engine &
bestEngine ()
{
  return *available ().engines[available ().count - 1];
}

} // namespace erkpa::lanes
