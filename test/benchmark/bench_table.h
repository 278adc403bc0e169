// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench_plan.h"

namespace bench
{

/** \brief The table on standard output, line by line as it is measured. */
void
printHead ();

void
printRow (const Row &row);

void
printFoot (const Plan &plan);

} // namespace bench
