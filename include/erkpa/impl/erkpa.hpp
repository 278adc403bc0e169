// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Everything that touches the memory of a pcl::PointCloud stands in this header, so that it is compiled with the
// caller's flags: a program built with AVX lays out and frees Eigen-aligned memory differently from the library.

#include <erkpa/erkpa.h>
#include <erkpa/impl/cloud_adaptor.hpp>

#include <pcl/common/io.h>
#include <pcl/console/print.h>

#include <cstdint>
#include <exception>
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
  catch (const std::bad_alloc &)
  {
    outcome_ = {Status::INTERNAL_ERROR, "out of memory: use a larger voxel size or fewer points"};
  }
  catch (const std::exception &error)
  {
    outcome_ = {Status::INTERNAL_ERROR, error.what ()};
  }
  catch (...)
  {
    outcome_ = {Status::INTERNAL_ERROR, "a function given by the caller threw something that is no std::exception"};
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
  // Only a field by collocation takes long to make.
  const double share = options_.field.interpolation == Interpolation::COLLOCATION ? 0.5 : 0.0;
  return guarded (
      [&]
      {
        Outcome outcome = makeField (partOf (progress_, 0.0, share));
        if (outcome.ok ())
          outcome = buildMesh (*field_, options_, mesh, report_, partOf (progress_, share, 1.0 - share));
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
  const bool made = makeMesh (mesh);
  const pcl::PCLHeader header = input_ ? input_->header : pcl::PCLHeader ();
  toPolygonMesh (made ? mesh : TriangleMesh (), kindOfAttributes<PointNT> (), header, output);
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
SharpSurface::ConstPtr
ERKPA<PointNT>::sharpSurfaceOf (const pcl::ModelCoefficients &coefficients, pcl::SacModel model) const
{
  SharpSurface::ConstPtr surface;
  SurfaceModel kind = SurfaceModel::PLANE;
  Outcome outcome{Status::INVALID_SETTING, "the model " + std::to_string (static_cast<int> (model)) +
                                               " is none of plane, sphere, cylinder, cone"};
  if (surfaceModelOf (model, kind))
    outcome = makeSharpSurface (kind, coefficients.values, surface);
  if (!outcome.ok ())
    PCL_ERROR ("[%s::addSharpEdge] %s.\n", getClassName ().c_str (), outcome.message.c_str ());
  return surface;
}

template <typename PointNT>
bool
ERKPA<PointNT>::addSharpEdge (const pcl::ModelCoefficients &coefficients)
{
  return addSharpEdge (coefficients, pcl::SACMODEL_PLANE);
}

template <typename PointNT>
bool
ERKPA<PointNT>::addSharpEdge (const pcl::ModelCoefficients &coefficients, pcl::SacModel model)
{
  const SharpSurface::ConstPtr surface = sharpSurfaceOf (coefficients, model);
  if (!surface)
    return false;
  if (planeBehind (*surface) != nullptr)
    sharp_edges_.push_back (coefficients);
  addSharpSurface (surface);
  return true;
}

template <typename PointNT>
bool
ERKPA<PointNT>::addSharpEdge (const pcl::ModelCoefficients &face, pcl::SacModel model,
                              const pcl::ModelCoefficients &other, pcl::SacModel other_model)
{
  const SharpSurface::ConstPtr of_face = sharpSurfaceOf (face, model), of_other = sharpSurfaceOf (other, other_model);
  if (!of_face || !of_other)
    return false;
  const SharpSurface::ConstPtr between = makeSharpBetween (of_face, of_other);
  if (!between)
    PCL_ERROR ("[%s::addSharpEdge] the two planes are parallel: they meet in no edge.\n", getClassName ().c_str ());
  addSharpSurface (between);
  return between != nullptr;
}

template <typename PointNT>
void
ERKPA<PointNT>::addSharpSurface (const SharpSurface::ConstPtr &surface)
{
  if (surface)
    options_.field.sharp_surfaces.push_back (surface);
}

template <typename PointNT>
bool
ERKPA<PointNT>::setSharpEdges (std::vector<pcl::ModelCoefficients> edges)
{
  std::vector<pcl::ModelCoefficients> old_edges;
  std::vector<SharpSurface::ConstPtr> old_surfaces;
  old_edges.swap (sharp_edges_);
  old_surfaces.swap (options_.field.sharp_surfaces);
  for (const pcl::ModelCoefficients &edge : edges)
  {
    if (addSharpEdge (edge))
      continue;
    sharp_edges_.swap (old_edges);
    options_.field.sharp_surfaces.swap (old_surfaces);
    return false;
  }
  return true;
}

template <typename PointNT>
void
ERKPA<PointNT>::setOptions (const Options &options)
{
  options_ = options;
  sharp_edges_.clear ();
  use_sensor_origin_ = false;
}

} // namespace erkpa
