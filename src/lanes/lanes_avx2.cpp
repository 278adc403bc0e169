// SPDX-License-Identifier: BSD-3-Clause
#include "lane_engine.h"
#include "lane_search.h"

namespace erkpa::lanes
{

void
evaluateAvx2 (const Settings &settings, const Nodes &nodes, const Points &points, const SharpSurfaces &sharp,
              const Scratch &scratch, const Samples &samples)
{
  evaluate<xsimd::fma3<xsimd::avx2>> (settings, nodes, points, sharp, scratch, samples);
}

extern const Search SEARCH_AVX2;
constexpr Search SEARCH_AVX2 = makeSearch<xsimd::fma3<xsimd::avx2>> ();

} // namespace erkpa::lanes
