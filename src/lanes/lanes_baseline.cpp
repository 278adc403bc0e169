// SPDX-License-Identifier: BSD-3-Clause
#include "lane_engine.h"
#include "lane_search.h"

namespace erkpa::lanes
{

void
evaluateBaseline (const Settings &settings, const Nodes &nodes, const Points &points, const SharpSurfaces &sharp,
                  const Scratch &scratch, const Samples &samples)
{
  evaluate<xsimd::default_arch> (settings, nodes, points, sharp, scratch, samples);
}

extern const Search SEARCH_BASELINE;
constexpr Search SEARCH_BASELINE = makeSearch<xsimd::default_arch> ();

} // namespace erkpa::lanes
