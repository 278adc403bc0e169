// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lanes/lanes.h"

#include <cstddef>

namespace bench
{

// Each in a unit of its own, compiled as that of the lanes for the same instruction set: see peak_loop.h.
float
runMultiplyAddsBaseline (std::size_t rounds);
float
runMultiplyAddsAvx2 (std::size_t rounds);
float
runMultiplyAddsAvx512 (std::size_t rounds);

/** \brief Seconds that this thread has had a processor for. */
double
threadSeconds ();

/** \brief Most floating-point operations per second that one thread can do with an engine's instruction set: a
 * multiply-add counts as two. The best of many short runs; measured once for each engine. */
double
peakRate (const erkpa::lanes::Engine &engine);

} // namespace bench
