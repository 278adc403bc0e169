// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/sharp_surface.h>

#include <array>
#include <cstddef>
#include <string>

namespace erkpa
{

/** \brief How many coefficients a model has. */
std::size_t
coefficientCount (SurfaceModel model);

/** \brief makeSharpSurface () with coefficients in double.
 * \param[in] count how many of \a coefficients are given
 */
Outcome
makeModelSurface (SurfaceModel model, const std::array<double, 7> &coefficients, std::size_t count,
                  SharpSurface::ConstPtr &surface);

} // namespace erkpa
