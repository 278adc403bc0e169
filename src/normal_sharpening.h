// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>

namespace erkpa
{

void
sharpenNormals (const NeighborSearch &search, double spacing, int k, int threads, OrientedPoints &points);

bool
areNormalsSmeared (const NeighborSearch &search, double spacing, int k, int threads, const OrientedPoints &points);

} // namespace erkpa
