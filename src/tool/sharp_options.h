// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "command_line.h"

#include <boost/program_options.hpp>

namespace erkpa::tool
{

/** \brief Reads the options that say where the surface is sharp, and what to write about it. */
void
takeSharpEdges (const boost::program_options::variables_map &variables, CommandLine &line);

} // namespace erkpa::tool
