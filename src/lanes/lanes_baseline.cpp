// SPDX-License-Identifier: BSD-3-Clause
#include "lane_election.h"
#include "lane_engine.h"
#include "lane_search.h"

namespace erkpa::lanes
{

namespace
{

using Arch = xsimd::default_arch;

constexpr Search SEARCH = makeSearch<Arch> ();

} // namespace

extern const Engine BASELINE;
constexpr Engine BASELINE{"baseline", xsimd::batch<float, Arch>::size, &SEARCH, evaluate<Arch>, measureTrees<Arch>};

} // namespace erkpa::lanes
