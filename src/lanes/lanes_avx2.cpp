// SPDX-License-Identifier: BSD-3-Clause
#include "lane_election.h"
#include "lane_engine.h"
#include "lane_lattice_engine.h"
#include "lane_links.h"
#include "lane_search.h"

namespace erkpa::lanes
{

using Arch = xsimd::fma3<xsimd::avx2>;
extern const Engine AVX2;
constexpr Engine AVX2{
    "AVX2",          xsimd::batch<float, Arch>::size, &SEARCH<Arch>, &LATTICE<Arch>, evaluate<Arch>, measureTrees<Arch>,
    linkSmooth<Arch>};

} // namespace erkpa::lanes
