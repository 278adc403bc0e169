// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/point_layout.h>

#include "node_table.h"
#include "noise.h"

namespace erkpa
{

PointLayout::PointLayout (const OrientedPoints &points, int threads)
    : grid (makePointGrid (points.positions, threads, spacing)), search (makeGridSearch (grid))
{
  const SupportSizes sizes = chooseSupportSizes (points, *search, threads);
  k = sizes.k;
  k_within_faces = sizes.within_faces;
}

} // namespace erkpa
