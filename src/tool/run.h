// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "command_line.h"

namespace erkpa::tool
{

/** \brief Does what the command line asks for; throws a ToolError and leaves all files as they were on
 * failure. */
void
run (const CommandLine &line);

} // namespace erkpa::tool
