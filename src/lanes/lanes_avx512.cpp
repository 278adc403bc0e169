// SPDX-License-Identifier: BSD-3-Clause
#include "lane_engine.h"
#include "lane_search.h"

namespace erkpa::lanes
{

void
evaluateAvx512 (const Settings &settings, const Nodes &nodes, const Points &points, const SharpSurfaces &sharp,
                const Scratch &scratch, const Samples &samples)
{
  evaluate<xsimd::avx512f> (settings, nodes, points, sharp, scratch, samples);
}

extern const Search SEARCH_AVX512;
constexpr Search SEARCH_AVX512 = makeSearch<xsimd::avx512f> ();

} // namespace erkpa::lanes
