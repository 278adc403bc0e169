// SPDX-License-Identifier: BSD-3-Clause
#include "lane_engine.h"

namespace erkpa::lanes
{

void
evaluateAvx2 (const Settings &settings, const Nodes &nodes, const Points &points, const Scratch &scratch,
              const Samples &samples)
{
  evaluate<xsimd::fma3<xsimd::avx2>> (settings, nodes, points, scratch, samples);
}

} // namespace erkpa::lanes
