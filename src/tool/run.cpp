// SPDX-License-Identifier: BSD-3-Clause
#include "run.h"

#include "cloud_reader.h"
#include "crease_writer.h"
#include "float_cloud.h"
#include "mesh_writer.h"
#include "output_file.h"
#include "progress_line.h"
#include "report.h"
#include "step.h"
#include "tool_error.h"

#include <erkpa/erkpa.h>
#include <erkpa/sharp_surface_io.h>

#include <memory>
#include <utility>

namespace erkpa::tool
{

namespace
{

using pcl::console::print_info;
using pcl::console::print_warn;

/** \brief Keeps PCL's messages back while it lives: what the library has to say reaches the user once, as our
 * error or among our results.
 */
class QuietLibrary
{
public:
  QuietLibrary ()
  {
    pcl::console::setVerbosityLevel (pcl::console::L_ALWAYS);
  }

  ~QuietLibrary ()
  {
    pcl::console::setVerbosityLevel (level_);
  }

  QuietLibrary (const QuietLibrary &) = delete;
  QuietLibrary &
  operator= (const QuietLibrary &) = delete;

private:
  pcl::console::VERBOSITY_LEVEL level_ = pcl::console::getVerbosityLevel ();
};

/** \brief One run of the program, step by step. */
class Reconstruction
{
public:
  explicit Reconstruction (CommandLine line) : line_ (std::move (line))
  {
    total_.tic ();
  }

  void
  run ()
  {
    for (const std::string *path :
         {&line_.output, &line_.values, &line_.report, &line_.saved_sharp_edges, &line_.creases})
      if (!path->empty ()) // better now than after the work
        OutputFile::check (*path);
    reconstruct (load ());
    writeFiles ();
  }

private:
  pcl::PCLPointCloud2
  load ()
  {
    if (!line_.query.empty ())
      queries_ = positionsOf (readCloud (line_.query).cloud);
    Step step ("Loading", line_.input);
    RawCloud raw = readCloud (line_.input);
    const PointOptions &points = line_.options.points;
    rounding_ = largestRounding (raw.cloud);
    pcl::PCLPointCloud2 cloud = toFloatFields (std::move (raw.cloud), {points.radius_field, points.confidence_field});
    NormalOptions &normals = line_.options.normals;
    if (!normals.has_view_point && raw.view_point)
    {
      normals.has_view_point = true;
      normals.view_point = *raw.view_point;
    }
    has_face_normals_ = raw.has_face_normals;
    times_.read = step.done (static_cast<std::size_t> (cloud.width) * cloud.height, "points");
    return cloud;
  }

  void
  reconstruct (const pcl::PCLPointCloud2 &cloud)
  {
    const bool meshes = !line_.output.empty ();
    Step step ("Computing", meshes ? "the surface" : "the field");
    {
      const QuietLibrary quiet;
      ProgressLine progress;
      const Outcome outcome =
          meshes ? erkpa::reconstruct (cloud, line_.options, mesh_, report_, &field_, progress.callback ())
                 : erkpa::computeField (cloud, line_.options, field_, report_, progress.callback ());
      if (!outcome.ok ())
        throw ToolError ("cannot reconstruct " + line_.input + ": " + outcome.message);
    }
    if (meshes)
      step.done (report_.triangles, "triangles");
    else
      step.done (report_.points.used, "nodes");
    tell ();
  }

  void
  tellNormals () const
  {
    const char *const how = report_.orientation == Orientation::VIEW_POINT ? "towards the view point"
                            : report_.orientation == Orientation::ONE_SIDE
                                ? "towards the side all of them are seen from"
                                : "from neighbour to neighbour";
    if (report_.points.without_normal > 0)
      print_info ("  estimated %zu normals, oriented %s\n", report_.points.without_normal, how);
    if (report_.normals_contradicted)
      print_warn ("  neighbours had normals that look opposite ways: oriented anew, %s\n", how);
    if (report_.normals_turned > 0)
      print_info ("  turned %zu normals that looked the other way than those around them\n", report_.normals_turned);
  }

  /** \brief What is worth knowing about the points and the mesh. */
  void
  tell () const
  {
    const PointCounts &points = report_.points;
    if (points.no_confidence > 0)
      print_info ("  left out %zu points of no confidence\n", points.no_confidence);
    if (points.not_finite + points.duplicate > 0)
      print_info ("  left out %zu points that are not finite and %zu that repeat another\n", points.not_finite,
                  points.duplicate);
    if (has_face_normals_)
      print_info ("  took the normals from the faces of the file\n");
    tellNormals ();
    const CollocationReport &collocation = report_.collocation;
    if (collocation.unknowns > 0)
      print_info ("  collocation of %zu values: largest miss %g of the support radius\n", collocation.unknowns,
                  collocation.residual);
    if (line_.options.sharp.automatic || !line_.options.sharp.faces.empty ())
      print_info ("  found %zu sharp edges\n", report_.sharp_surfaces.size ());
    if (!report_.creases.empty ())
      print_info ("  %zu creases, %zu corners\n", report_.creases.size (), report_.corners.size ());
    if (!line_.output.empty ())
      print_info ("  %zu vertices, %zu pieces, %zu boundary edges\n", report_.vertices, report_.topology.components,
                  report_.topology.boundary_edges);
    constexpr double TOLERABLE = 0.1; // of the spacing: beyond, the surface shows steps
    if (rounding_ > TOLERABLE * report_.spacing)
      print_warn ("%s: as floats the coordinates are off by up to %g; subtract an offset from them first\n",
                  line_.input.c_str (), rounding_);
  }

  /** \brief Writes all files before any of them takes its name. */
  void
  writeFiles ()
  {
    std::vector<std::unique_ptr<OutputFile>> files;
    const auto newFile = [&files] (const std::string &path) -> OutputFile &
    {
      files.push_back (std::make_unique<OutputFile> (path));
      return *files.back ();
    };
    if (!line_.values.empty ())
      evaluate (newFile (line_.values));
    if (!line_.output.empty ())
    {
      Step step ("Saving", line_.output);
      writeMesh (mesh_, line_.output, line_.options.polygonizer.threads, newFile (line_.output));
      times_.write = step.done (mesh_.triangles.size (), "triangles");
    }
    if (!line_.creases.empty ())
      writeCreases (mesh_, report_.creases, line_.creases, newFile (line_.creases));
    if (!line_.saved_sharp_edges.empty ())
      saveSharpEdges (newFile (line_.saved_sharp_edges));
    times_.total = total_.toc () * 1e-3;
    if (!line_.report.empty ())
      writeReport (line_, report_, lengthOf (mesh_, report_.creases), times_, newFile (line_.report));
    for (const std::unique_ptr<OutputFile> &file : files)
      file->commit ();
  }

  /** \brief Those in force: given and found. */
  void
  saveSharpEdges (OutputFile &file)
  {
    std::string text;
    const Outcome outcome = writeSharpSurfaces (field_->options ().sharp_surfaces, text);
    if (!outcome.ok ())
      throw ToolError ("cannot write " + line_.saved_sharp_edges + ": " + outcome.message);
    file.write (text);
    file.close ();
  }

  void
  evaluate (OutputFile &file)
  {
    constexpr int DIGITS = 9; // tells any two floats apart
    Step step ("Evaluating", line_.query);
    std::vector<FieldSample> samples;
    field_->evaluate (queries_, samples, line_.options.polygonizer.threads);
    for (std::size_t i = 0; i < queries_.size (); ++i)
    {
      for (const double coordinate : queries_[i])
      {
        file.writeNumber (coordinate, DIGITS);
        file.write (" ");
      }
      file.writeNumber (samples[i].value, DIGITS);
      for (const double component : samples[i].gradient)
      {
        file.write (" ");
        file.writeNumber (component, DIGITS);
      }
      file.write ("\n");
    }
    file.close ();
    times_.evaluate = step.done (queries_.size (), "points");
  }

  CommandLine line_;
  std::vector<Eigen::Vector3d> queries_;
  double rounding_ = 0.0;
  bool has_face_normals_ = false;
  TriangleMesh mesh_;
  ImplicitField::ConstPtr field_;
  Report report_;
  ToolTimes times_;
  pcl::console::TicToc total_;
};

} // namespace

void
run (const CommandLine &line)
{
  Reconstruction (line).run ();
}

} // namespace erkpa::tool
