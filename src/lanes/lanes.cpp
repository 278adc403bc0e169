// SPDX-License-Identifier: BSD-3-Clause
#include "lanes.h"

namespace erkpa::lanes
{

// Each in a unit of its own, the only one compiled for that instruction set.
void
evaluateBaseline (const Settings &settings, const Nodes &nodes, const Points &points, const SharpSurfaces &sharp,
                  const Scratch &scratch, const Samples &samples);
void
evaluateAvx2 (const Settings &settings, const Nodes &nodes, const Points &points, const SharpSurfaces &sharp,
              const Scratch &scratch, const Samples &samples);
void
evaluateAvx512 (const Settings &settings, const Nodes &nodes, const Points &points, const SharpSurfaces &sharp,
                const Scratch &scratch, const Samples &samples);
extern const Search SEARCH_BASELINE, SEARCH_AVX2, SEARCH_AVX512;

namespace
{

struct Available
{
  const Engine *engines[3];
  std::size_t count = 0;

  Available ()
  {
    static constexpr Engine BASELINE{"baseline", 4, &SEARCH_BASELINE, evaluateBaseline};
    engines[count++] = &BASELINE;
#ifdef ERKPA_X86_LANES
    static constexpr Engine AVX2{"AVX2", 8, &SEARCH_AVX2, evaluateAvx2};
    static constexpr Engine AVX512{"AVX-512", 16, &SEARCH_AVX512, evaluateAvx512};
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
