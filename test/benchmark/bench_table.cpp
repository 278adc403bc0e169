// SPDX-License-Identifier: BSD-3-Clause
#include "bench_table.h"

#include "machine.h"

#include "lanes/lanes.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace bench
{

namespace
{

struct Column
{
  const char *title;
  const char *place; ///< in the result
  double scale;
  int decimals;
};

constexpr Column COLUMNS[] = {{"points s", "/seconds/points", 1.0, 3},
                              {"normals", "/seconds/normals", 1.0, 3},
                              {"sharp", "/seconds/sharp", 1.0, 3},
                              {"field", "/seconds/field", 1.0, 3},
                              {"grid", "/seconds/grid", 1.0, 3},
                              {"vertices", "/seconds/vertices", 1.0, 3},
                              {"cells", "/seconds/triangles", 1.0, 3},
                              {"creases", "/seconds/creases", 1.0, 3},
                              {"slivers", "/seconds/slivers", 1.0, 3},
                              {"output", "/seconds/output", 1.0, 3},
                              {"total s", "/seconds/total", 1.0, 3},
                              {"CPU s", "/cpu_seconds", 1.0, 3},
                              {"voxel", "/voxel", 1.0, 5},
                              {"Mtriangles", "/triangles", 1e-6, 3},
                              {"s/Mtri", "/seconds_per_million_triangles", 1.0, 2},
                              {"Mevals", "/evaluations", 1e-6, 3},
                              {"nodes", "/nodes_per_evaluation", 1.0, 1},
                              {"peak MB", "/peak_mb", 1.0, 0}};

int
widthOf (const char *title)
{
  return std::max (8, static_cast<int> (std::strlen (title)));
}

void
printNumber (const char *title, double number, bool is_known, int decimals)
{
  if (is_known)
    std::printf (" %*.*f", widthOf (title), decimals, number);
  else
    std::printf (" %*s", widthOf (title), "-");
}

/** \brief The result with what follows from it. */
Json
complete (const Json &result)
{
  Json completed = result;
  const double triangles = result.value ("triangles", 0.0);
  if (triangles > 0.0)
    completed["seconds_per_million_triangles"] = 1e6 * result["seconds"]["total"].get<double> () / triangles;
  return completed;
}

} // namespace

void
printHead ()
{
  std::printf ("%s, %s\n", processorName ().c_str (), erkpa::lanes::bestEngine ().name);
  std::printf ("%-8s %9s %-10s %3s", "shape", "points", "method", "thr");
  for (const Column &column : COLUMNS)
    std::printf (" %*s", widthOf (column.title), column.title);
  std::printf (" %8s %8s\n", "speed-up", "Poisson");
  std::fflush (stdout);
}

void
printRow (const Row &row)
{
  const int depth = row.run.poisson_depth;
  const std::string method = depth > 0 ? "Poisson " + std::to_string (depth) : "ERKPA";
  std::printf ("%-8s %9zu %-10s %3d", row.run.shape.c_str (), row.run.points, method.c_str (), row.run.threads);
  if (row.hasFailed ())
  {
    std::printf (" failed: %s\n", row.best ()["error"].get<std::string> ().c_str ());
    std::fflush (stdout);
    return;
  }
  const Json result = complete (row.best ());
  for (const Column &column : COLUMNS)
  {
    const Json::json_pointer place (column.place);
    const bool is_known = result.contains (place);
    printNumber (column.title, is_known ? column.scale * result[place].get<double> () : 0.0, is_known, column.decimals);
  }
  printNumber ("speed-up", row.speed_up, row.speed_up > 0.0, 2);
  printNumber ("Poisson", row.poisson_ratio, row.poisson_ratio > 0.0, 2);
  std::printf ("\n");
  std::fflush (stdout);
}

void
printFoot (const Plan &plan)
{
  std::printf ("\nSeconds: from the cloud to the pcl::PolygonMesh, of the fastest of %d; sharp: finding edges; grid:\n"
               "following the surface; cells: triangles in them, and borders; slivers: removing them; output: the\n"
               "pcl::PolygonMesh. CPU s: of all threads together. nodes: in the support of an evaluation. peak MB: of "
               "the process, cloud\n"
               "and mesh included. speed-up: over %d thread%s. Poisson: its time over ERKPA's. Both are medians.\n",
               plan.repeats, plan.threads.front (), plan.threads.front () == 1 ? "" : "s");
}

} // namespace bench
