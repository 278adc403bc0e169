// SPDX-License-Identifier: BSD-3-Clause
//
// erkpa_reconstruct: from the file of a point cloud to the file of a mesh.
#include "command_line.h"
#include "run.h"

#include <erkpa/large_pages.h>
#include <erkpa/version.h>

#include <pcl/console/print.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

namespace erkpa::tool
{

namespace
{

void
runCommandLine (int argc, const char *const *argv)
{
  const CommandLine line = parseCommandLine (argc, argv);
  if (line.help)
    std::fputs (helpText ().c_str (), stdout);
  else if (line.version)
    std::puts ("erkpa_reconstruct " ERKPA_VERSION);
  else
    run (line);
}

/** \brief The one line of a failure, whatever verbosity PCL is set to. */
int
fail (const char *message)
{
  pcl::console::print_color (stderr, pcl::console::TT_BRIGHT, pcl::console::TT_RED, "erkpa_reconstruct: %s", message);
  std::fputs ("\n", stderr);
  return EXIT_FAILURE;
}

} // namespace
} // namespace erkpa::tool

int
main (int argc, char **argv)
{
  erkpa::preferLargePages ();
  const erkpa::LargePageKeeper keeper;
  try
  {
    erkpa::tool::runCommandLine (argc, argv);
    return EXIT_SUCCESS;
  }
  catch (const std::bad_alloc &)
  {
    return erkpa::tool::fail ("there is not enough memory; use a larger -voxel or fewer points");
  }
  catch (const std::exception &error)
  {
    return erkpa::tool::fail (error.what ());
  }
}
