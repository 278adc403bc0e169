// SPDX-License-Identifier: BSD-3-Clause
#include "report.h"

#include "named_values.h"

#include <erkpa/version.h>

#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace erkpa::tool
{

namespace
{

using Json = nlohmann::ordered_json;

/** \brief The most memory the program has held so far, in units of 1024 * 1024 bytes. */
double
peakMemoryInMb ()
{
  rusage usage = {};
  getrusage (RUSAGE_SELF, &usage);
  return static_cast<double> (usage.ru_maxrss) / 1024.0;
}

Json
meshToJson (const Report &report)
{
  return {{"vertices", report.vertices},
          {"triangles", report.triangles},
          {"boundary_edges", report.topology.boundary_edges},
          {"non_manifold_edges", report.topology.non_manifold_edges},
          {"components", report.topology.components},
          {"euler", report.topology.euler},
          {"dropped_components", report.polygonizer.dropped_components}};
}

Json
sharpEdgesToJson (const CommandLine &line, const Report &report, double crease_length)
{
  return {{"given", line.options.field.sharp_surfaces.size ()},
          {"found", report.sharp_surfaces.size ()},
          {"normals_sharpened", report.normals.sharpened},
          {"normals_smoothed", report.normals.smoothed},
          {"creases", report.creases.size ()},
          {"corners", report.corners.size ()},
          {"crease_length", crease_length}};
}

Json
secondsToJson (const Report &report, const ToolTimes &times)
{
  return {{"read", times.read},
          {"points", report.seconds_points},
          {"normals", report.seconds_normals},
          {"sharp", report.seconds_sharp},
          {"field", report.seconds_field},
          {"polygonizer", report.seconds_polygonizer},
          {"of_polygonizer",
           {{"grid", report.polygonizer.seconds_grid},
            {"vertices", report.polygonizer.seconds_vertices},
            {"triangles", report.polygonizer.seconds_triangles},
            {"creases", report.polygonizer.seconds_creases},
            {"slivers", report.polygonizer.seconds_slivers}}},
          {"evaluate", times.evaluate},
          {"write", times.write},
          {"total", times.total}};
}

} // namespace

void
writeReport (const CommandLine &line, const Report &report, double crease_length, const ToolTimes &times,
             OutputFile &file)
{
  Json json;
  json["version"] = ERKPA_VERSION;
  json["input"] = line.input;
  json["output"] = line.output;
  json["points"] = {{"read", report.points.read},
                    {"used", report.points.used},
                    {"not_finite", report.points.not_finite},
                    {"duplicate", report.points.duplicate},
                    {"no_confidence", report.points.no_confidence},
                    {"without_normal", report.points.without_normal}};
  json["orientation"] = nameOf (ORIENTATIONS, report.orientation);
  json["normals_contradicted"] = report.normals_contradicted;
  json["normals_turned"] = report.normals_turned;
  json["k"] = report.k;
  json["radius"] = report.radius;
  json["spacing"] = report.spacing;
  json["collocation"] = {{"unknowns", report.collocation.unknowns},
                         {"nonzeros", report.collocation.nonzeros},
                         {"iterations", report.collocation.iterations},
                         {"residual", report.collocation.residual}};
  json["voxel_size"] = report.polygonizer.voxel_size;
  json["evaluations"] = report.polygonizer.evaluations;
  json["moment_sums"] = report.polygonizer.moment_sums;
  json["mean_nodes_per_evaluation"] = report.meanNodesPerEvaluation ();
  json["sharp_edges"] = sharpEdgesToJson (line, report, crease_length);
  json["mesh"] = meshToJson (report);
  json["seconds"] = secondsToJson (report, times);
  json["peak_memory_mb"] = peakMemoryInMb ();
  // a file name need not be UTF-8, and dump would throw
  file.write (json.dump (2, ' ', false, Json::error_handler_t::replace) + "\n");
  file.close ();
}

} // namespace erkpa::tool
