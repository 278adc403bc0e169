// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "command_line.h"
#include "output_file.h"

namespace erkpa::tool
{

/** \brief Seconds of the stages that the library does not see. */
struct ToolTimes
{
  double read = 0.0;
  double evaluate = 0.0;
  double write = 0.0;
  double total = 0.0;
};

/** \brief Writes what was done as JSON; the file is closed, not yet committed.
 * \param[in] crease_length of all creases together
 */
void
writeReport (const CommandLine &line, const Report &report, double crease_length, const ToolTimes &times,
             OutputFile &file);

} // namespace erkpa::tool
