// SPDX-License-Identifier: BSD-3-Clause
//
// Repeats Table 1 of the paper: as many points, triangles and nodes per evaluation as there, on this machine.
#include "machine.h"
#include "paper_run.h"

#include "tool_error.h"

#include <omp.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

using paper::Method;
using paper::Row;

constexpr const char *USAGE = "usage: paper_table [FOLDER] [-row NAME] [-method functional|hermite] [-threads N]";

/** \brief A command line that makes no sense. */
class UsageError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

struct Arguments
{
  std::string folder;
  std::string row; ///< empty = all
  Method method = Method::FUNCTIONAL;
  int threads = 0; ///< 0 = all processors
};

int
parseThreads (const std::string &text)
{
  int threads = 0;
  const char *end = text.data () + text.size ();
  const auto [stop, error] = std::from_chars (text.data (), end, threads);
  if (error != std::errc () || stop != end || threads < 1)
    throw UsageError ("-threads " + text + ": give a whole number, at least 1");
  return threads;
}

Method
parseMethod (const std::string &text)
{
  if (text != "functional" && text != "hermite")
    throw UsageError ("-method " + text + ": give functional (the paper's) or hermite (the library's default)");
  return text == "hermite" ? Method::HERMITE : Method::FUNCTIONAL;
}

std::string
parseRow (const std::string &text)
{
  std::string keys;
  for (const Row &row : paper::rows ())
  {
    if (text == row.key)
      return text;
    keys += std::string (keys.empty () ? "" : ", ") + row.key;
  }
  throw UsageError ("-row " + text + ": there is no such row; give one of " + keys);
}

Arguments
parseArguments (const std::vector<std::string> &words)
{
  Arguments arguments;
  for (std::size_t i = 0; i < words.size (); ++i)
  {
    const std::string &word = words[i];
    const bool is_option = word == "-row" || word == "-method" || word == "-threads";
    if (is_option && i + 1 == words.size ())
      throw UsageError (word + ": its value is missing");
    if (word == "-row")
      arguments.row = parseRow (words[++i]);
    else if (word == "-method")
      arguments.method = parseMethod (words[++i]);
    else if (word == "-threads")
      arguments.threads = parseThreads (words[++i]);
    else if (word.empty () || word[0] == '-')
      throw UsageError (word + ": there is no such option");
    else if (!arguments.folder.empty ())
      throw UsageError (word + ": a second folder; give one");
    else if (!std::filesystem::is_directory (word))
      throw UsageError (word + ": there is no such folder");
    else
      arguments.folder = word;
  }
  return arguments;
}

void
printHead (const Arguments &arguments)
{
  const bool is_papers = arguments.method == Method::FUNCTIONAL;
  std::printf ("Table 1 of the paper, repeated with %s\n",
               is_papers ? "the paper's method: functional constraints, linear, its kernel, constant support radius"
                         : "the library's method: values and normals, spherical; constant support radius");
  std::printf ("here:  %s, %d threads\n", bench::processorName ().c_str (),
               arguments.threads > 0 ? arguments.threads : omp_get_max_threads ());
  std::printf ("paper: Pentium 4, 2.4 GHz, 512 MB, one thread; its figures stand in parentheses\n");
  std::printf ("Support radius and voxel are chosen so that nodes per evaluation and triangles are the paper's.\n");
  std::printf ("Points: Venus has the paper's count of vertices; Max Planck, screwdriver and Buddha are samples of\n"
               "those models of the same size, not the paper's own points. What is generated is another shape.\n\n");
  std::printf ("%-17s %7s %17s %13s %15s %17s %7s %7s %11s %8s %8s %7s %7s %6s  %s\n", "model", "points", "triangles",
               "nodes", "seconds", "evals/s", "ratio", "CPU s", "evaluations", "radius", "voxel", "peak MB", "pieces",
               "border", "points from");
  std::fflush (stdout);
}

/** \brief Reconstructs one row and prints it at once. */
bool
printRow (const Row &row, const Arguments &arguments)
{
  const paper::Model model = paper::loadModel (row, arguments.folder);
  const paper::Result result = paper::runRow (row, model, arguments.method, arguments.threads);
  if (!result.outcome.ok ())
  {
    std::printf ("%-17s failed: %s\n", row.title, result.outcome.message.c_str ());
    std::fflush (stdout);
    return false;
  }
  const erkpa::Report &report = result.report;
  const double per_second = static_cast<double> (report.polygonizer.evaluations) / result.seconds;
  std::printf ("%-17s %7zu %7zu (%7.0f) %6.0f (%4.0f) %8.2f (%4.0f) %9.0f (%5.0f) %7.1f %7.2f %11zu %8.4f %8.5f %7.0f "
               "%7zu %6zu  %s\n",
               row.title, report.points.used, report.triangles, row.triangles, report.meanNodesPerEvaluation (),
               row.nodes, result.seconds, row.seconds, per_second, row.evals_per_sec, per_second / row.evals_per_sec,
               result.cpu_seconds, report.polygonizer.evaluations, result.radius, report.polygonizer.voxel_size,
               result.peak_mb, report.topology.components, report.topology.boundary_edges, model.source.c_str ());
  std::fflush (stdout);
  return true;
}

void
printFoot ()
{
  std::printf ("\nSeconds: from the points to the mesh, search tree and polygonizer included; evals/s is evaluations\n"
               "over these seconds, and ratio that over the paper's. CPU s: of all threads together. Border: edges\n"
               "of one triangle. By its own figures the paper evaluates the field about 7.3 times per triangle.\n");
}

} // namespace

int
main (int argc, char **argv)
{
  try
  {
    const Arguments arguments = parseArguments (std::vector<std::string> (argv + 1, argv + argc));
    printHead (arguments);
    bool is_done = true;
    for (const Row &row : paper::rows ())
      if (arguments.row.empty () || arguments.row == row.key)
        is_done = printRow (row, arguments) && is_done;
    printFoot ();
    return is_done ? 0 : 1;
  }
  catch (const UsageError &error)
  {
    std::fprintf (stderr, "paper_table: %s\n%s\n", error.what (), USAGE);
    return 2;
  }
  catch (const std::exception &error)
  {
    std::fprintf (stderr, "paper_table: %s\n", error.what ());
    return 1;
  }
}
