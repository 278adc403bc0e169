// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/reconstruction.h>

#include <string>

namespace erkpa::tool
{

/** \brief What the user asked for. File names are empty where the option was not given. */
struct CommandLine
{
  bool help = false;
  bool version = false;
  std::string input;
  std::string output;            ///< empty: no mesh is wanted
  std::string query;             ///< -evaluate, first value
  std::string values;            ///< -evaluate, second value
  std::string report;            ///< -report
  std::string sharp_edges;       ///< -sharp_edges, which options have already
  std::string saved_sharp_edges; ///< -save_sharp_edges
  std::string creases;           ///< -creases
  Options options;
};

/** \brief Reads the command line; options may begin with one dash or two.
 *
 * Throws a ToolError that names the option and the remedy. With -help or -version the rest is not looked at.
 */
CommandLine
parseCommandLine (int argc, const char *const *argv);

/** \brief The text of -help, with the defaults that stand in Options. */
std::string
helpText ();

} // namespace erkpa::tool
