// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/impl/cloud_adaptor.hpp>
#include <erkpa/sharp_edge_settings.h>
#include <erkpa/sharp_surface_io.h>

#include <pcl/console/print.h>

#include <algorithm>
#include <utility>

namespace erkpa
{

namespace
{

bool
refuse (const char *method, const std::string &why)
{
  PCL_ERROR ("[erkpa::ERKPA::%s] %s.\n", method, why.c_str ());
  return false;
}

/** \brief The surface that coefficients describe; null, with a PCL_ERROR, where there is none. */
SharpSurface::ConstPtr
surfaceOf (const char *method, const pcl::ModelCoefficients &coefficients, pcl::SacModel model, SurfaceModel &kind)
{
  SharpSurface::ConstPtr surface;
  Outcome outcome{Status::INVALID_SETTING, "the model " + std::to_string (static_cast<int> (model)) +
                                               " is none of plane, sphere, cylinder, cone"};
  if (surfaceModelOf (model, kind))
    outcome = makeSharpSurface (kind, coefficients.values, surface);
  if (!outcome.ok ())
    refuse (method, outcome.message);
  return surface;
}

SharpSurface::ConstPtr
sharpSurfaceOf (const pcl::ModelCoefficients &coefficients, pcl::SacModel model)
{
  SurfaceModel kind = SurfaceModel::PLANE;
  return surfaceOf ("addSharpEdge", coefficients, model, kind);
}

} // namespace

bool
SharpEdgeSettings::addSharpEdge (const pcl::ModelCoefficients &coefficients)
{
  return addSharpEdge (coefficients, pcl::SACMODEL_PLANE);
}

bool
SharpEdgeSettings::addSharpEdge (const pcl::ModelCoefficients &coefficients, const Extent::ConstPtr &extent)
{
  const SharpSurface::ConstPtr plane = sharpSurfaceOf (coefficients, pcl::SACMODEL_PLANE);
  if (!plane)
    return false;
  if (!extent)
    return refuse ("addSharpEdge", "the extent of the plane is null");
  addSharpSurface (makeLimited (plane, extent));
  return true;
}

bool
SharpEdgeSettings::addSharpEdge (const pcl::ModelCoefficients &coefficients, pcl::SacModel model)
{
  const SharpSurface::ConstPtr surface = sharpSurfaceOf (coefficients, model);
  if (!surface)
    return false;
  if (planeBehind (*surface) != nullptr)
  {
    sharp_edges_.push_back (coefficients);
    edge_planes_.push_back (surface);
  }
  addSharpSurface (surface);
  return true;
}

bool
SharpEdgeSettings::addSharpEdge (const pcl::ModelCoefficients &face, pcl::SacModel model,
                                 const pcl::ModelCoefficients &other, pcl::SacModel other_model)
{
  const SharpSurface::ConstPtr of_face = sharpSurfaceOf (face, model), of_other = sharpSurfaceOf (other, other_model);
  if (!of_face || !of_other)
    return false;
  const SharpSurface::ConstPtr between = makeSharpBetween (of_face, of_other);
  if (!between)
    return refuse ("addSharpEdge", "the two planes are parallel: they meet in no edge");
  addSharpSurface (between);
  return true;
}

void
SharpEdgeSettings::addSharpSurface (const SharpSurface::ConstPtr &surface)
{
  if (surface)
    options_.field.sharp_surfaces.push_back (surface);
}

bool
SharpEdgeSettings::setSharpEdges (std::vector<pcl::ModelCoefficients> edges)
{
  const SharpEdgeSettings old = *this;
  clearSharpEdges ();
  for (const pcl::ModelCoefficients &edge : edges)
    if (!addSharpEdge (edge))
    {
      *this = old;
      return false;
    }
  return true;
}

void
SharpEdgeSettings::setSharpSurfaces (const std::vector<SharpSurface::ConstPtr> &surfaces)
{
  const std::vector<SharpSurface::ConstPtr> all = surfaces; // they may be our own
  std::vector<pcl::ModelCoefficients> old_edges;
  std::vector<SharpSurface::ConstPtr> old_planes;
  old_edges.swap (sharp_edges_);
  old_planes.swap (edge_planes_);
  options_.field.sharp_surfaces.clear ();
  for (const SharpSurface::ConstPtr &surface : all)
  {
    addSharpSurface (surface);
    const auto plane = std::find (old_planes.begin (), old_planes.end (), surface);
    if (!surface || plane == old_planes.end ())
      continue;
    sharp_edges_.push_back (old_edges[static_cast<std::size_t> (plane - old_planes.begin ())]);
    edge_planes_.push_back (surface);
  }
}

bool
SharpEdgeSettings::removeSharpSurface (std::size_t index)
{
  std::vector<SharpSurface::ConstPtr> surfaces = getSharpSurfaces ();
  if (index >= surfaces.size ())
    return refuse ("removeSharpSurface", "there is no sharp surface " + std::to_string (index) +
                                             " (counted from 0) of " + std::to_string (surfaces.size ()));
  surfaces.erase (surfaces.begin () + static_cast<std::ptrdiff_t> (index));
  setSharpSurfaces (surfaces);
  return true;
}

void
SharpEdgeSettings::clearSharpEdges ()
{
  sharp_edges_.clear ();
  edge_planes_.clear ();
  options_.field.sharp_surfaces.clear ();
}

bool
SharpEdgeSettings::loadSharpSurfaces (const std::string &path)
{
  std::vector<SharpSurface::ConstPtr> surfaces;
  const Outcome outcome = erkpa::loadSharpSurfaces (path, surfaces);
  if (!outcome.ok ())
    return refuse ("loadSharpSurfaces", outcome.message);
  for (const SharpSurface::ConstPtr &surface : surfaces)
    addSharpSurface (surface);
  return true;
}

bool
SharpEdgeSettings::addFace (const pcl::ModelCoefficients &coefficients, pcl::SacModel model)
{
  FaceModel face;
  if (!surfaceOf ("addFace", coefficients, model, face.model))
    return false;
  face.coefficients = coefficients.values;
  options_.sharp.faces.push_back (face);
  return true;
}

void
SharpEdgeSettings::replaceOptions (const Options &options)
{
  options_ = options;
  sharp_edges_.clear ();
  edge_planes_.clear ();
}

} // namespace erkpa
