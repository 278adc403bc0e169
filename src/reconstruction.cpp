// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/reconstruction.h>

#include "flaps.h"
#include "normal_flips.h"
#include "point_grid.h"
#include "spatial_order.h"
#include "stage_clock.h"
#include "support.h"
#include "support_size.h"
#include "text.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

namespace erkpa
{

namespace
{

/** \brief Points will ask for their neighbours again and again: have these close by. */
void
sortInSpace (int threads, OrientedPoints &points, PointLayout &layout)
{
  const PointLayout before = layout;
  reorder (before.grid->index ().data (), points);
  layout = PointLayout (points, threads);
  layout.k = before.k; // of a sample that has nothing to do with how the points lie
  layout.k_within_faces = before.k_within_faces;
}

Outcome
collect (const PointView &view, const SearchFactory &make_search, int threads,
         const std::shared_ptr<OrientedPoints> &shared, NeighborSearch::ConstPtr &search, PointLayout::ConstPtr &layout,
         Report &report)
{
  const StageClock clock (report.seconds_points);
  OrientedPoints &points = *shared;
  Outcome outcome = collectPoints (view, points, report.points, threads);
  if (!outcome.ok ())
    return outcome;
  if (points.size () <= Support::MIN_NODES)
    return {Status::TOO_FEW_POINTS, "the input has " + std::to_string (points.size ()) +
                                        " distinct, finite points of " + std::to_string (report.points.read) + " read" +
                                        (report.points.no_confidence > 0 ? " that have a positive confidence" : "") +
                                        ": a surface needs at least " + std::to_string (Support::MIN_NODES + 1)};
  const auto found = std::make_shared<PointLayout> (points, threads);
  if (report.points.without_normal > 0)
    sortInSpace (threads, points, *found);
  layout = found;
  search = make_search ? make_search (points) : makeKdTreeSearch ({shared, &shared->positions});
  return {};
}

/** \brief A radius far beyond the cloud makes one flat fit of everything, with zeros of rounding all over space. */
Outcome
checkRadius (const ImplicitField &field)
{
  if (field.supportSize ().kind () == SupportSize::Kind::NEAREST)
    return {};
  float size = 0.0f;
  for (const Eigen::Vector3f &p : field.points ().positions)
    size = std::max (size, p.norm ());
  constexpr float FAR = 20.0f;
  for (const float radius : field.supportSize ().radiiOfNodes (field.search (), 1))
  {
    if (!(radius > 0.0f) || !std::isfinite (radius))
      return {Status::INVALID_SETTING, "the function of the support radius is " + toText (radius) +
                                           " at a point: it must be positive and finite everywhere"};
    if (radius > FAR * size)
      return {Status::INVALID_SETTING, "the support radius of " + toText (radius) +
                                           " is far larger than the cloud, which fits in a ball of radius " +
                                           toText (size) + ": use a smaller one, or 0 to use k neighbours"};
  }
  return {};
}

Outcome
checkField (const ImplicitField &field)
{
  if (!(field.spacing () > 0.0))
    return {Status::TOO_FEW_POINTS, "the points lie closer together than floats can tell: scale the cloud up"};
  return checkRadius (field);
}

/** \brief Radii of the points' own leave no room for another way to choose the support. */
Outcome
checkOptions (const PointView &view, const FieldOptions &options)
{
  Outcome outcome = ImplicitField::checkOptions (options);
  if (outcome.ok () && !view.shapes.empty () && options.flatten < 1.0)
    return {Status::INVALID_SETTING,
            "the points have support shapes of their own, which exclude flatten: give one of them"};
  const bool has_other =
      options.k > 0 || options.radius > 0.0 || options.radius_ramp.axis >= 0 || options.radius_function;
  if (outcome.ok () && has_other && !view.radii.empty ())
    return {Status::INVALID_SETTING,
            "the points have support radii of their own, which exclude k, a radius, a ramp and a "
            "function of the support radius: give one of them"};
  return outcome;
}

Outcome
checkWarp (const OrientedPoints &points, const SpaceWarp *warp)
{
  for (std::size_t i = 0; warp != nullptr && i < points.size (); ++i)
    if (!warp->map (points.positions[i].cast<double> () + points.origin).cast<float> ().allFinite ())
      return {Status::INVALID_SETTING, "the space warp takes a point of the cloud to a place that is not finite"};
  return {};
}

/** \brief The field over points with normals. */
Outcome
makeField (const std::shared_ptr<const OrientedPoints> &points, const NeighborSearch::ConstPtr &search,
           const PointLayout::ConstPtr &layout, const Options &options, ImplicitField::ConstPtr &field, Report &report,
           const ProgressCallback &progress)
{
  const StageClock clock (report.seconds_field);
  Outcome outcome = checkWarp (*points, options.field.warp.get ());
  if (!outcome.ok ())
    return outcome;
  const auto made =
      std::make_shared<ImplicitField> (points, search, options.field, options.polygonizer.threads, layout);
  const bool by_nearest = made->options ().k > 0;
  report.k = by_nearest ? made->options ().k : 0;
  report.radius = by_nearest ? 0.0 : made->supportSize ().typical ();
  report.spacing = made->spacing ();
  outcome = checkField (*made);
  if (outcome.ok () && options.field.interpolation == Interpolation::COLLOCATION)
    outcome = interpolateNodes (*made, options.polygonizer.threads, report.collocation, progress);
  if (outcome.ok ())
    field = made;
  return outcome;
}

/** \brief Where sharp edges are known or sought, normals must be those of one face each; then find the edges. */
Outcome
respectSharpEdges (const PointLayout &layout, Options &options, OrientedPoints &points, Report &report)
{
  std::vector<SharpSurface::ConstPtr> &surfaces = options.field.sharp_surfaces;
  const SharpOptions &sharp = options.sharp;
  const int threads = options.polygonizer.threads;
  std::vector<Eigen::Vector3f> given; // but for their signs
  if (options.normals.sharpen)
  {
    const StageClock clock (report.seconds_normals);
    given = points.normals;
    report.normals = refineNormals (layout, report.points.without_normal > 0, threads, points);
  }
  const StageClock clock (report.seconds_sharp);
  std::vector<SharpSurface::ConstPtr> found, between;
  Outcome outcome;
  if (sharp.automatic)
    outcome = findSharpSurfaces (points, layout, sharp, threads, found);
  if (outcome.ok () && !sharp.faces.empty ())
    outcome = sharpEdgesFromFaces (points, sharp.faces, sharp.face_tolerance, between);
  // Faces are told apart by smoothed normals, fitted by those given: fits average noise without looking over edges.
  if (report.normals.smoothed && !report.normals.sharpened)
    points.normals = given;
  found.insert (found.end (), between.begin (), between.end ());
  report.sharp_surfaces = found;
  surfaces.insert (surfaces.end (), found.begin (), found.end ());
  return outcome;
}

/** \brief Estimate the normals that are missing, and see to it that all agree on which side is out. */
Outcome
completeNormals (const PointLayout &layout, const Options &options, OrientedPoints &points, Report &report)
{
  const StageClock clock (report.seconds_normals);
  if (report.points.without_normal > 0)
  {
    Outcome outcome = estimateNormals (points, layout, options.normals, report.orientation);
    if (!outcome.ok ())
      return outcome;
  }
  if (!options.normals.sharpen) // normals stay as they are
    return {};
  const int threads = options.polygonizer.threads;
  const NormalSigns signs = judgeSigns (*layout.search, threads, points);
  report.normals_contradicted = signs == NormalSigns::CONTRADICT;
  if (report.normals_contradicted)
    report.orientation = reorientNormals (points, layout, options.normals);
  else if (signs != NormalSigns::AGREE)
    report.normals_turned = turnFlippedNormals (*layout.search, signs, threads, points);
  return {};
}

/** \brief Have normals everywhere that respect sharp edges. */
Outcome
prepareNormals (PointLayout::ConstPtr &layout, Options &options, OrientedPoints &points, Report &report)
{
  const bool has_edges =
      options.sharp.automatic || !options.sharp.faces.empty () || !options.field.sharp_surfaces.empty ();
  Outcome outcome = completeNormals (*layout, options, points, report);
  if (report.normals_contradicted || report.normals_turned > 0) // which normals look the same way decides on supports
    layout = std::make_shared<const PointLayout> (points, options.polygonizer.threads);
  return outcome.ok () && has_edges ? respectSharpEdges (*layout, options, points, report) : outcome;
}

/** \brief The surface as a mesh whose vertices are joined along creases, measured. */
Outcome
meshField (const ImplicitField &field, const Options &options, TriangleMesh &mesh, Report &report,
           const ProgressCallback &progress)
{
  const StageClock total (report.seconds_total), clock (report.seconds_polygonizer);
  Outcome outcome = polygonize (field, options.polygonizer, mesh, report.polygonizer, progress);
  report.topology = measureTopology (mesh, options.polygonizer.threads);
  return outcome;
}

/** \brief Make the mesh anew without the edges that lead it into empty space.
 * \return false, and all is as before, where there are none, or it is no better
 */
bool
mendMesh (const Options &options, FlapEdges which, const ProgressCallback &progress, ImplicitField::ConstPtr &field,
          TriangleMesh &mesh, Report &report)
{
  const ImplicitField::ConstPtr field_before = field;
  const Report report_before = report;
  if (!mendFlaps (options, mesh, which, report, field))
    return false;
  TriangleMesh mended;
  const Outcome outcome = meshField (*field, options, mended, report, progress);
  if (outcome.ok () && report.topology.boundary_edges <= report_before.topology.boundary_edges)
  {
    std::swap (mesh, mended);
    return true;
  }
  field = field_before;
  report = report_before;
  return false;
}

/** \brief Split normals where that is asked for, and report what there is. */
void
finishMesh (const Options &options, TriangleMesh &mesh, Report &report)
{
  const StageClock total (report.seconds_total), clock (report.seconds_polygonizer);
  report.creases = mesh.creases;
  report.corners = findCorners (mesh.creases);
  if (options.polygonizer.split_normals)
    splitNormals (mesh);
  report.vertices = mesh.vertices.size ();
  report.triangles = mesh.triangles.size ();
}

} // namespace

Outcome
buildField (const PointView &view, const Options &options, const SearchFactory &make_search,
            ImplicitField::ConstPtr &field, Report &report, const ProgressCallback &progress)
{
  field.reset ();
  report = Report ();
  const LargePageKeeper keeper;
  const StageClock total (report.seconds_total);
  Outcome outcome = checkOptions (view, options.field);
  if (!outcome.ok ())
    return outcome;
  const auto points = std::make_shared<OrientedPoints> ();
  NeighborSearch::ConstPtr search;
  PointLayout::ConstPtr layout;
  outcome = collect (view, make_search, options.polygonizer.threads, points, search, layout, report);
  if (!outcome.ok ())
    return outcome;
  Options complete = options;
  outcome = prepareNormals (layout, complete, *points, report);
  return outcome.ok () ? makeField (points, search, layout, complete, field, report, progress) : outcome;
}

Outcome
buildMesh (const ImplicitField &field, const Options &options, TriangleMesh &mesh, Report &report,
           const ProgressCallback &progress)
{
  const LargePageKeeper keeper;
  Outcome outcome = meshField (field, options, mesh, report, progress);
  finishMesh (options, mesh, report);
  return outcome;
}

Outcome
buildMeshNearPoints (ImplicitField::ConstPtr &field, const Options &options, TriangleMesh &mesh, Report &report,
                     const ProgressCallback &progress)
{
  const LargePageKeeper keeper;
  double shown = 0.0;
  ProgressCallback never_back;
  if (progress)
    never_back = [&] (double done) { progress (shown = std::max (shown, done)); };
  Outcome outcome = meshField (*field, options, mesh, report, never_back);
  // Edges stand where the points are before a warp; values of nodes belong to the field they were found for; and other
  // levels are away from the points anyway.
  const bool can_mend = !report.sharp_surfaces.empty () && !options.field.warp && !field->hasNodeValues () &&
                        options.polygonizer.iso_level == 0.0;
  for (const FlapEdges which : {FlapEdges::OF_FACE, FlapEdges::ALL, FlapEdges::SMALL_WHOLLY})
    if (!outcome.ok () || !can_mend || !mendMesh (options, which, never_back, field, mesh, report))
      break;
  finishMesh (options, mesh, report);
  return outcome;
}

} // namespace erkpa
