// SPDX-License-Identifier: BSD-3-Clause
#include "lane_engine.h"

namespace erkpa::lanes
{

void
evaluateBaseline (const Settings &settings, const Nodes &nodes, const Points &points, const SharpSurfaces &sharp,
                  const Scratch &scratch, const Samples &samples)
{
  evaluate<xsimd::default_arch> (settings, nodes, points, sharp, scratch, samples);
}

} // namespace erkpa::lanes
