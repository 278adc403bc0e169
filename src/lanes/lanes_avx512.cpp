// SPDX-License-Identifier: BSD-3-Clause
#include "lane_election.h"
#include "lane_engine.h"
#include "lane_lattice_engine.h"
#include "lane_links.h"
#include "lane_search.h"

namespace erkpa::lanes
{

using Arch = xsimd::avx512f;
extern const Engine AVX512;
constexpr Engine AVX512{
    "AVX-512",       xsimd::batch<float, Arch>::size, &SEARCH<Arch>, &LATTICE<Arch>, evaluate<Arch>, measureTrees<Arch>,
    linkSmooth<Arch>};

} // namespace erkpa::lanes
