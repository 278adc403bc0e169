// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lanes/lanes.h"

#include <erkpa/implicit_field.h>

#include <cstddef>
#include <optional>

namespace erkpa
{

/** \brief The kernel in lanes; none where it is the caller's own, or asks for doubles. */
std::optional<lanes::Kernel>
laneKernelOf (const FieldOptions &options);

/** \brief What the lanes are to know of a field. */
lanes::Settings
laneSettingsOf (const ImplicitField &field);

/** \brief All ways to combine as many faces, in the order of treesOf (). */
lanes::Trees
laneTreesOf (std::size_t faces);

/** \brief Number of terms of a basis. */
std::size_t
termsOf (lanes::Basis basis);

} // namespace erkpa
