// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Everything that touches the memory of a pcl::PointCloud stands in this header, so that it is compiled with the
// caller's flags: a program built with AVX lays out and frees Eigen-aligned memory differently from the library.

#include <erkpa/erkpa.h>
#include <erkpa/impl/cloud_adaptor.hpp>
#include <erkpa/sharp_surface_io.h>

#include <pcl/common/io.h>
#include <pcl/console/print.h>

#include <cstdint>
#include <utility>

namespace erkpa
{

template <typename PointNT>
template <typename StepT>
bool
ERKPA<PointNT>::guarded (StepT step)
{
  try
  {
    outcome_ = step ();
  }
  catch (...)
  {
    outcome_ = outcomeOfException ();
  }
  if (!outcome_.ok ())
  {
    field_.reset ();
    PCL_ERROR ("[%s::reconstruct] %s.\n", getClassName ().c_str (), outcome_.message.c_str ());
  }
  return outcome_.ok ();
}

template <typename PointNT>
Outcome
ERKPA<PointNT>::viewInput (PointView &view) const
{
  view = viewCloud (*input_);
  view.indices = use_indices_ && !fake_indices_ ? indices_.get () : nullptr;
  view.radii = radii_;
  view.confidences = confidences_;
  view.shapes = shapes_;
  const auto *data = reinterpret_cast<const std::uint8_t *> (input_->points.data ());
  const CloudBytes bytes{
      pcl::getFields<PointNT> (), data, sizeof (PointNT), input_->size () * sizeof (PointNT), input_->size (), 1};
  Outcome outcome = readField (bytes, options_.points.radius_field, view.radii);
  return outcome.ok () ? readField (bytes, options_.points.confidence_field, view.confidences) : outcome;
}

template <typename PointNT>
Outcome
ERKPA<PointNT>::makeField (const ProgressCallback &progress)
{
  field_.reset ();
  report_ = Report ();
  if (!input_)
    return {Status::NO_INPUT, "there is no input cloud: call setInputCloud () first"};
  if (use_sensor_origin_)
  {
    options_.normals.view_point = input_->sensor_origin_.template head<3> ().template cast<double> ();
    options_.normals.has_view_point = true;
  }
  SearchFactory make_search;
  if (tree_)
    make_search = [this] (const OrientedPoints &points) { return makePclSearch<PointNT> (tree_, points); };
  PointView view;
  Outcome outcome = viewInput (view);
  if (outcome.ok ())
    outcome = buildField (view, options_, make_search, field_, report_, progress);
  if (outcome.ok ())
    reportPoints (getClassName (), report_, options_);
  return outcome;
}

template <typename PointNT>
bool
ERKPA<PointNT>::makeMesh (TriangleMesh &mesh)
{
  const LargePageKeeper keeper; // what the field gives up serves the mesh
  // Only a field by collocation takes long to make.
  const double share = options_.field.interpolation == Interpolation::COLLOCATION ? 0.5 : 0.0;
  return guarded (
      [&]
      {
        Outcome outcome = makeField (partOf (progress_, 0.0, share));
        if (outcome.ok ())
          outcome = buildMeshNearPoints (field_, options_, mesh, report_, partOf (progress_, share, 1.0 - share));
        if (outcome.ok ())
          reportRounding (getClassName (), *field_, report_);
        return outcome;
      });
}

template <typename PointNT>
void
ERKPA<PointNT>::reconstruct (pcl::PolygonMesh &output)
{
  output = pcl::PolygonMesh ();
  TriangleMesh mesh;
  if (!makeMesh (mesh))
    mesh.clear ();
  const pcl::PCLHeader header = input_ ? input_->header : pcl::PCLHeader ();
  toPolygonMesh (mesh, kindOfAttributes<PointNT> (), header, output);
}

template <typename PointNT>
void
ERKPA<PointNT>::reconstruct (PointCloud &points, std::vector<pcl::Vertices> &polygons)
{
  TriangleMesh mesh;
  const bool made = makeMesh (mesh); // before points is cleared: it may be the input
  const pcl::PCLHeader header = input_ ? input_->header : pcl::PCLHeader ();
  points = PointCloud ();
  points.header = header;
  polygons.clear ();
  if (!made)
    return;
  toPointCloud (mesh, points);
  toPolygons (mesh, polygons);
}

template <typename PointNT>
ImplicitField::ConstPtr
ERKPA<PointNT>::computeField ()
{
  guarded ([this] { return makeField (progress_); });
  return field_;
}

template <typename PointNT>
bool
ERKPA<PointNT>::saveSharpSurfaces (const std::string &path) const
{
  const Outcome outcome =
      erkpa::saveSharpSurfaces (path, field_ ? field_->options ().sharp_surfaces : getSharpSurfaces ());
  if (!outcome.ok ())
    PCL_ERROR ("[%s::saveSharpSurfaces] %s.\n", getClassName ().c_str (), outcome.message.c_str ());
  return outcome.ok ();
}

template <typename PointNT>
void
ERKPA<PointNT>::setOptions (const Options &options)
{
  replaceOptions (options);
  use_sensor_origin_ = false;
}

} // namespace erkpa
