// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace bench
{

/** \brief As the system names it. */
std::string
processorName ();

} // namespace bench
