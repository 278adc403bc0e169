// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/collocation.h>
#include <erkpa/implicit_field.h>
#include <erkpa/marching_cubes.h>
#include <erkpa/normals.h>
#include <erkpa/oriented_points.h>
#include <erkpa/sharp_detection.h>
#include <erkpa/triangle_mesh.h>

#include <functional>
#include <string>
#include <vector>

namespace erkpa
{

/** \brief Fields of the cloud that hold something about each point, by name; empty = none. */
struct PointOptions
{
  std::string radius_field;     ///< the support radius of the point, in the cloud's unit of length, positive
  std::string confidence_field; ///< how much the point counts, of any scale; points of zero or less are left out
};

/** \brief All settings of a reconstruction; every default of the library stands in these structs. */
struct Options
{
  PointOptions points;
  NormalOptions normals;
  SharpOptions sharp;
  FieldOptions field;
  PolygonizerOptions polygonizer;
};

/** \brief What a reconstruction did, stage by stage. */
struct Report
{
  PointCounts points;
  Orientation orientation = Orientation::NONE;
  bool normals_contradicted = false; ///< neighbours looked opposite ways: they were oriented as if none had a sign
  std::size_t normals_turned = 0;    ///< that looked the other way than those around them
  int k = 0;                         ///< neighbours of the support in force; 0 with a radius
  double radius = 0.0;               ///< support radius in force, the median where it varies; 0 with k
  RefinedNormals normals;            ///< what was done to the normals for the sake of sharp edges
  std::vector<SharpSurface::ConstPtr> sharp_surfaces; ///< the sharp edges that were found; not those given
  CollocationReport collocation;
  double spacing = 0.0; ///< typical distance between neighbouring points
  PolygonizerReport polygonizer;
  MeshTopology topology;       ///< of the mesh before its normals were split
  std::vector<Crease> creases; ///< lines over the mesh's vertices
  std::vector<int> corners;    ///< vertices in which more than two of them meet
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  double seconds_points = 0.0;      ///< gathering the points and building the search tree
  double seconds_normals = 0.0;     ///< estimating and orienting normals
  double seconds_sharp = 0.0;       ///< finding sharp edges
  double seconds_field = 0.0;       ///< settling the support, collocation
  double seconds_polygonizer = 0.0; ///< meshing
  double seconds_total = 0.0;

  /** \brief Mean number of nodes in the support of an evaluation. */
  double
  meanNodesPerEvaluation () const
  {
    return polygonizer.evaluations > 0
               ? static_cast<double> (polygonizer.support_nodes) / static_cast<double> (polygonizer.evaluations)
               : 0.0;
  }
};

/** \brief Makes the search over the nodes once they are known. */
using SearchFactory = std::function<NeighborSearch::ConstPtr (const OrientedPoints &)>;

/** \brief The first half of the way: cloud -> oriented points -> field.
 * \param[in] view the cloud
 * \param[in] options settings
 * \param[in] make_search the search to use, or empty for a KdTreeFLANN
 * \param[out] field the field; null on error
 * \param[in,out] report filled in
 * \param[in] progress may be empty; called where the field is the result of a long computation
 */
Outcome
buildField (const PointView &view, const Options &options, const SearchFactory &make_search,
            ImplicitField::ConstPtr &field, Report &report, const ProgressCallback &progress = {});

/** \brief The second half: field -> mesh, in the input's frame. */
Outcome
buildMesh (const ImplicitField &field, const Options &options, TriangleMesh &mesh, Report &report,
           const ProgressCallback &progress = {});

/** \brief The same, but sharp edges that were found do not lead the mesh away from the points: where they would, they
 * are taken out of \a field and of \a report, and the mesh is made anew.
 * \param[in,out] field from buildField () with the same options
 * \param[in,out] report from there
 */
Outcome
buildMeshNearPoints (ImplicitField::ConstPtr &field, const Options &options, TriangleMesh &mesh, Report &report,
                     const ProgressCallback &progress = {});

} // namespace erkpa
