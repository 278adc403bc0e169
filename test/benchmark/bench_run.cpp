// SPDX-License-Identifier: BSD-3-Clause
#include "bench_run.h"

#include "bench_shapes.h"

#include <erkpa/erkpa.h>

#ifdef ERKPA_BENCH_POISSON
#include <pcl/surface/poisson.h>
#endif

#include <pcl/common/common.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>

namespace bench
{

namespace
{

using Clock = std::chrono::steady_clock;

double
secondsSince (Clock::time_point start)
{
  return std::chrono::duration<double> (Clock::now () - start).count ();
}

rusage
usage ()
{
  rusage usage = {};
  getrusage (RUSAGE_SELF, &usage);
  return usage;
}

double
cpuSeconds ()
{
  const rusage used = usage ();
  const auto seconds = [] (const timeval &time)
  { return static_cast<double> (time.tv_sec) + 1e-6 * static_cast<double> (time.tv_usec); };
  return seconds (used.ru_utime) + seconds (used.ru_stime);
}

Json
describe (const erkpa::Report &report, double total)
{
  Json seconds{{"points", report.seconds_points},
               {"normals", report.seconds_normals},
               {"sharp", report.seconds_sharp},
               {"field", report.seconds_field},
               {"grid", report.polygonizer.seconds_grid},
               {"vertices", report.polygonizer.seconds_vertices},
               {"triangles", report.polygonizer.seconds_triangles},
               {"creases", report.polygonizer.seconds_creases},
               {"slivers", report.polygonizer.seconds_slivers}};
  seconds["output"] = std::max (0.0, total - report.seconds_total);
  seconds["total"] = total;
  return {{"seconds", seconds},
          {"triangles", report.triangles},
          {"vertices", report.vertices},
          {"boundary_edges", report.topology.boundary_edges},
          {"evaluations", report.polygonizer.evaluations},
          {"nodes_per_evaluation", report.meanNodesPerEvaluation ()},
          {"voxel", report.polygonizer.voxel_size},
          {"sharp_surfaces_found", report.sharp_surfaces.size ()}};
}

Json
reconstruct (const Run &run, const Shape &shape)
{
  erkpa::ERKPA<pcl::PointNormal> erkpa;
  erkpa.setNumberOfThreads (run.threads);
  erkpa.setAutomaticSharpEdges (shape.is_automatic);
  for (const Eigen::Vector4d &plane : shape.planes)
  {
    pcl::ModelCoefficients coefficients;
    for (const double value : plane)
      coefficients.values.push_back (static_cast<float> (value));
    erkpa.addSharpEdge (coefficients);
  }
  erkpa.setInputCloud (shape.cloud);
  pcl::PolygonMesh mesh;
  const Clock::time_point start = Clock::now ();
  erkpa.reconstruct (mesh);
  const double total = secondsSince (start);
  if (erkpa.getStatus () != erkpa::Status::OK)
    return {{"error", erkpa.getStatusMessage ()}};
  return describe (erkpa.getReport (), total);
}

/** \brief Longest side of the box around the cloud. */
double
extentOf (const pcl::PointCloud<pcl::PointNormal> &cloud)
{
  pcl::PointNormal low, high;
  pcl::getMinMax3D (cloud, low, high);
  return static_cast<double> ((high.getVector3fMap () - low.getVector3fMap ()).maxCoeff ());
}

Json
reconstructByPoisson ([[maybe_unused]] const Run &run, [[maybe_unused]] const Shape &shape)
{
#ifdef ERKPA_BENCH_POISSON
  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setDepth (run.poisson_depth);
  poisson.setThreads (run.threads);
  poisson.setInputCloud (shape.cloud);
  pcl::PolygonMesh mesh;
  const Clock::time_point start = Clock::now ();
  poisson.reconstruct (mesh);
  const double total = secondsSince (start);
  if (mesh.polygons.empty ())
    return {{"error", "pcl::Poisson made no mesh"}};
  const double cell = static_cast<double> (poisson.getScale ()) * extentOf (*shape.cloud) / (1 << run.poisson_depth);
  return {{"seconds", {{"total", total}}},
          {"triangles", mesh.polygons.size ()},
          {"voxel", cell},
          {"depth", run.poisson_depth}};
#else
  return {{"error", "built without pcl::Poisson"}};
#endif
}

/** \brief In the child. */
Json
runHere (const Run &run)
{
  try
  {
    const Shape shape = makeShape (run.shape, run.points);
    const double before = cpuSeconds ();
    Json result = run.poisson_depth > 0 ? reconstructByPoisson (run, shape) : reconstruct (run, shape);
    result["cpu_seconds"] = cpuSeconds () - before;
    result["peak_mb"] = static_cast<double> (usage ().ru_maxrss) / 1024.0;
    result["extent"] = extentOf (*shape.cloud);
    return result;
  }
  catch (const std::exception &error)
  {
    return {{"error", error.what ()}};
  }
}

bool
writeAll (int file, const std::string &text)
{
  std::size_t written = 0;
  while (written < text.size ())
  {
    const ssize_t count = write (file, text.data () + written, text.size () - written);
    if (count < 0 && errno != EINTR)
      return false;
    written += count > 0 ? static_cast<std::size_t> (count) : 0;
  }
  return true;
}

std::string
readAll (int file)
{
  std::string text;
  char buffer[4096];
  for (;;)
  {
    const ssize_t count = read (file, buffer, sizeof buffer);
    if (count > 0)
      text.append (buffer, static_cast<std::size_t> (count));
    else if (count == 0 || errno != EINTR)
      return text;
  }
}

Json
resultOf (const std::string &text, int status)
{
  if (WIFSIGNALED (status))
    return {{"error", std::string ("the process was ended: ") + strsignal (WTERMSIG (status))}};
  Json result = Json::parse (text, nullptr, false);
  return result.is_object () ? result : Json{{"error", "the process ended without a result"}};
}

} // namespace

bool
hasPoisson ()
{
#ifdef ERKPA_BENCH_POISSON
  return true;
#else
  return false;
#endif
}

Json
measure (const Run &run)
{
  int ends[2];
  if (pipe (ends) != 0)
    return {{"error", std::strerror (errno)}};
  std::fflush (nullptr);
  const pid_t child = fork ();
  if (child == 0)
  {
    close (ends[0]);
    const bool is_done = writeAll (ends[1], runHere (run).dump ());
    _exit (is_done ? 0 : 1);
  }
  close (ends[1]);
  if (child < 0)
  {
    close (ends[0]);
    return {{"error", std::strerror (errno)}};
  }
  const std::string text = readAll (ends[0]);
  close (ends[0]);
  int status = 0;
  while (waitpid (child, &status, 0) < 0 && errno == EINTR)
  {
  }
  return resultOf (text, status);
}

} // namespace bench
