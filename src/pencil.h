// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/sharp_surface.h>

#include <array>
#include <vector>

namespace erkpa
{

/** \brief Three sharp surfaces through one line, as three faces that meet in a corner give.
 *
 * With a = scale_a θ_a and b = scale_b θ_b the third is a - b up to its own scale. Max, min and saddle of the three
 * faces differ from combinations of the θ⁺ by one function only: min (a⁺, b⁺).
 */
struct Pencil
{
  std::array<int, 3> surfaces;
  double scale_a, scale_b;
};

/** \brief The pencils among planes: triples that share a line to within \a tolerance (a length). Planes seen through
 * the same warp share the warped line. Limited ones must touch, for a corner lies in the extents of all its edges. Of
 * more than three planes without extents through one line so many triples as say all that they have to say. */
std::vector<Pencil>
findPencils (const std::vector<SharpSurface::ConstPtr> &surfaces, double tolerance);

} // namespace erkpa
