// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/marching_cubes.h>

#include "border.h"
#include "cell_loops.h"
#include "cell_mesher.h"
#include "crease_edges.h"
#include "crease_lines.h"
#include "feature_loops.h"
#include "moment_lattice.h"
#include "parallel_collect.h"
#include "sliver_removal.h"
#include "sparse_grid.h"
#include "stage_clock.h"
#include "surface_pieces.h"
#include "surface_tracking.h"
#include "surface_vertices.h"
#include "text.h"
#include "vertex_projection.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

namespace erkpa
{

namespace
{

using Triangle = std::array<int, 3>;

/** \brief Lengths of the box around the nodes. */
Eigen::Vector3d
extentOf (const ImplicitField &field, int threads)
{
  using Boxes = std::vector<Eigen::AlignedBox3f>;
  const std::vector<Eigen::Vector3f> &nodes = field.surfacePositions ();
  Eigen::AlignedBox3f box;
  for (const Eigen::AlignedBox3f &part : parallelCollect<Boxes> (nodes.size (), threads,
                                                                 [&] (std::size_t first, std::size_t last, Boxes &boxes)
                                                                 {
                                                                   boxes.emplace_back ();
                                                                   for (std::size_t i = first; i < last; ++i)
                                                                     boxes.back ().extend (nodes[i]);
                                                                 }))
    box.extend (part);
  return box.sizes ().cast<double> ();
}

Outcome
checkOptions (const PolygonizerOptions &options)
{
  const auto bad = [] (const std::string &why) { return Outcome{Status::INVALID_SETTING, why}; };
  if (!(options.voxel_size >= 0.0) || !std::isfinite (options.voxel_size))
    return bad ("the voxel size must be positive and finite, or 0 for automatic");
  if (options.resolution < 0)
    return bad ("the grid resolution must be positive, or 0 for automatic");
  if (!std::isfinite (options.iso_level))
    return bad ("the iso level must be finite");
  if (!(options.moment_tolerance >= 0.0) || !(options.moment_tolerance < 1.0))
    return bad ("the tolerance of interpolated moments must be at least 0 (none are) and below 1");
  if (options.threads < 0)
    return bad ("the number of threads must be positive, or 0 for all processors");
  return {};
}

/** \brief Put a vertex in the middle of each loop, with triangles around it. */
void
meshCentered (const LargeVector<CellLoop> &loops, LargeVector<Triangle> &triangles, SurfaceVertices &vertices)
{
  for (const CellLoop &loop : loops)
  {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero ();
    for (const int v : loop.ring)
      middle += vertices.positions[static_cast<std::size_t> (v)] / static_cast<double> (loop.ring.size ());
    addFan (loop.ring, static_cast<int> (vertices.positions.size ()), triangles);
    vertices.positions.push_back (middle);
  }
}

Outcome
noSurface (const ImplicitField &field, int threads, double voxel, std::size_t dropped)
{
  std::string why = "no surface was found at the points: the support may hold too few of them (use a larger k or "
                    "radius), or the iso level may lie beyond them";
  if (voxel > 0.5 * extentOf (field, threads).maxCoeff ())
    why = "no surface was found: the voxel of " + toText (voxel) + " is as large as the cloud, use a smaller one";
  else if (dropped > 0)
    why = "only small pieces of surface were found, which too few points support: are these points of a surface?";
  return {Status::NO_SURFACE, why};
}

/** \brief Gives vertices where the field has no gradient the mean direction of their triangles. */
void
fillNormals (const LargeVector<Triangle> &triangles, int threads, SurfaceVertices &vertices)
{
  const auto is_missing = [&vertices] (int v) { return vertices.normals[static_cast<std::size_t> (v)].isZero (0.0); };
  const LargeVector<int> missing =
      parallelCollect<LargeVector<int>> (vertices.normals.size (), threads,
                                         [&] (std::size_t first, std::size_t last, LargeVector<int> &found)
                                         {
                                           for (int v = static_cast<int> (first); v < static_cast<int> (last); ++v)
                                             if (is_missing (v))
                                               found.push_back (v);
                                         });
  if (missing.empty ())
    return;
  std::vector<Eigen::Vector3d> sums (missing.size (), Eigen::Vector3d::Zero ());
  for (const Triangle &t : triangles)
  {
    const auto at = [&] (std::size_t i) { return vertices.positions[static_cast<std::size_t> (t[i])]; };
    for (const int v : t)
      if (is_missing (v))
        sums[static_cast<std::size_t> (std::lower_bound (missing.begin (), missing.end (), v) - missing.begin ())] +=
            (at (1) - at (0)).cross (at (2) - at (0));
  }
  for (std::size_t i = 0; i < missing.size (); ++i)
    vertices.normals[static_cast<std::size_t> (missing[i])] =
        sums[i].norm () > 0.0 ? Eigen::Vector3d (sums[i].normalized ()) : Eigen::Vector3d::UnitZ ();
}

/** \brief The vertices that triangles use, in their order. */
LargeVector<int>
findUsed (const LargeVector<Triangle> &triangles, std::size_t vertex_count, int threads)
{
  std::vector<std::atomic<char>> is_used (vertex_count);
  parallelRanges (triangles.size (), threads,
                  [&] (std::size_t first, std::size_t last)
                  {
                    for (std::size_t t = first; t < last; ++t)
                      for (const int v : triangles[t])
                        is_used[static_cast<std::size_t> (v)].store (1, std::memory_order_relaxed);
                  });
  return parallelCollect<LargeVector<int>> (vertex_count, threads,
                                            [&] (std::size_t first, std::size_t last, LargeVector<int> &used)
                                            {
                                              for (std::size_t v = first; v < last; ++v)
                                                if (is_used[v].load (std::memory_order_relaxed))
                                                  used.push_back (static_cast<int> (v));
                                            });
}

/** \brief The mesh of the vertices in use, in the frame of the cloud. */
TriangleMesh
toInputFrame (const OrientedPoints &points, int threads, const SurfaceVertices &vertices,
              LargeVector<Triangle> &triangles, std::vector<Crease> creases)
{
  const LargeVector<int> used = findUsed (triangles, vertices.positions.size (), threads);
  const auto channels = static_cast<std::size_t> (points.channels);
  TriangleMesh mesh;
  mesh.creases = std::move (creases);
  mesh.channels = points.channels;
  mesh.vertices.resize (used.size ());
  mesh.normals.resize (used.size ());
  mesh.attributes.resize (used.size () * channels);
  LargeVector<int> renumbered (vertices.positions.size ());
  parallelRanges (used.size (), threads,
                  [&] (std::size_t first, std::size_t last)
                  {
                    for (std::size_t i = first; i < last; ++i)
                    {
                      const auto v = static_cast<std::size_t> (used[i]);
                      renumbered[v] = static_cast<int> (i);
                      mesh.vertices[i] = (vertices.positions[v] + points.origin).cast<float> ();
                      mesh.normals[i] = vertices.normals[v].cast<float> ();
                      std::copy_n (vertices.attributes.data () + v * channels, channels,
                                   mesh.attributes.data () + i * channels);
                    }
                  });
  parallelRanges (triangles.size (), threads,
                  [&] (std::size_t first, std::size_t last)
                  {
                    for (std::size_t t = first; t < last; ++t)
                      for (int &v : triangles[t])
                        v = renumbered[static_cast<std::size_t> (v)];
                  });
  for (Crease &crease : mesh.creases)
    for (int &v : crease.vertices)
      v = renumbered[static_cast<std::size_t> (v)];
  mesh.triangles.swap (triangles);
  return mesh;
}

Outcome
followSurface (const PolygonizerOptions &options, SurfaceTracker &tracker, SparseGrid &grid, PolygonizerReport &report)
{
  const StageClock clock (report.seconds_grid);
  Outcome outcome = tracker.track ();
  if (outcome.ok ())
    grid.markCutEdges (options.threads);
  return outcome;
}

/** \brief The loops that creases run through, as triangles with their vertices and edges on these. */
std::vector<VertexPair>
meshCreases (const ImplicitField &field, const PolygonizerOptions &options, const LargeVector<CellLoop> &mixed_loops,
             bool has_border, LargeVector<Triangle> &triangles, SurfaceVertices &vertices, PolygonizerReport &report)
{
  const StageClock clock (report.seconds_creases);
  const std::vector<MeshedLoop> loops =
      meshLoops (field, options, mixed_loops, report.voxel_size, has_border, vertices, report);
  return addCreases (report.voxel_size, mixed_loops, loops, options.threads, triangles, vertices);
}

/** \brief Joins the vertices to a mesh that ends where the data do.
 * \param[in,out] vertices those in the middle of cells, on creases and borders are added
 * \param[out] creases edges of the mesh
 * \return the triangles; none where no data support a piece of surface
 */
LargeVector<Triangle>
meshSurface (const ImplicitField &field, const PolygonizerOptions &options, const MomentLattice *lattice,
             const SparseGrid &grid, const SurfaceTracker &tracker, SurfaceVertices &vertices,
             std::vector<VertexPair> &creases, PolygonizerReport &report)
{
  const StageClock clock (report.seconds_triangles);
  const double voxel = report.voxel_size;
  CellMesh cell_mesh = meshCells (grid, options.threads, vertices);
  const std::size_t at_middles = vertices.positions.size ();
  LargeVector<Triangle> triangles = std::move (cell_mesh.triangles);
  meshCentered (cell_mesh.centered_loops, triangles, vertices);
  projectVertices (field, options, at_middles, 0.3 * voxel, lattice, vertices, report);
  creases =
      meshCreases (field, options, cell_mesh.mixed_loops, !cell_mesh.border.empty (), triangles, vertices, report);
  report.seconds_triangles -= report.seconds_creases; // which passed on both clocks
  const std::size_t in_cells = vertices.positions.size ();
  trimBorder (options.border_offset, options.threads, cell_mesh.border, triangles, vertices);
  projectVertices (field, options, in_cells, 0.1 * voxel, lattice, vertices, report);
  const int min_points = std::min (options.min_component_points, static_cast<int> (field.points ().size ()) / 2);
  report.dropped_components =
      dropUnsupported (grid, tracker, min_points, options.threads, vertices.positions.size (), triangles);
  if (triangles.empty ())
    return triangles;
  splitFans (cell_mesh.border, options.threads, triangles, vertices);
  fillNormals (triangles, options.threads, vertices);
  vertices.border_offsets = LargeVector<double> (); // has done its work, as have the next two
  vertices.faces = LargeVector<int> ();
  vertices.side_keys = LargeVector<std::uint64_t> ();
  vertices.has_sides = false;
  return triangles;
}

/** \brief Puts triangles where f = iso; the grid is gone when they are there.
 * \param[out] creases edges of the mesh
 */
Outcome
meshField (const ImplicitField &field, const PolygonizerOptions &options, SurfaceVertices &vertices,
           std::vector<VertexPair> &creases, LargeVector<Triangle> &triangles, PolygonizerReport &report,
           const ProgressCallback &progress)
{
  const double voxel = report.voxel_size;
  // Off the middle of the cloud by odd shares of a cell: faces of boxes then do not fall on grid nodes.
  SparseGrid grid (-voxel * Eigen::Vector3d (0.371, 0.437, 0.293), voxel);
  const std::unique_ptr<MomentLattice> lattice = MomentLattice::make (field, options, voxel);
  SurfaceTracker tracker (field, options, lattice.get (), grid, report, partOf (progress, 0.0, 0.5));
  const Outcome outcome = followSurface (options, tracker, grid, report);
  report.moment_sums = lattice != nullptr ? lattice->size () : 0;
  if (!outcome.ok ())
    return outcome;
  {
    const StageClock clock (report.seconds_vertices);
    placeVertices (field, options, lattice.get (), grid, vertices, report, partOf (progress, 0.5, 0.5));
  }
  triangles = meshSurface (field, options, lattice.get (), grid, tracker, vertices, creases, report);
  return triangles.empty () ? noSurface (field, options.threads, voxel, report.dropped_components) : Outcome ();
}

} // namespace

double
chooseVoxelSize (const ImplicitField &field, const PolygonizerOptions &options)
{
  if (options.voxel_size > 0.0)
    return options.voxel_size;
  if (options.resolution > 0)
    return extentOf (field, options.threads).maxCoeff () / options.resolution;
  // A grid node further from the surface than supports reach would see no field.
  constexpr double OF_FLATTENED = 0.3;
  const double flatten = field.options ().flatten;
  const double voxel = options.voxel_per_feature * field.featureSize ();
  return flatten < 1.0 ? std::min (voxel, OF_FLATTENED * flatten * field.typicalRadius ()) : voxel;
}

Outcome
polygonize (const ImplicitField &field, const PolygonizerOptions &options, TriangleMesh &mesh,
            PolygonizerReport &report, const ProgressCallback &progress)
{
  mesh.clear ();
  report = PolygonizerReport ();
  const LargePageKeeper keeper;
  Outcome outcome = checkOptions (options);
  if (!outcome.ok ())
    return outcome;
  const double voxel = report.voxel_size = chooseVoxelSize (field, options);
  const double cells = extentOf (field, options.threads).maxCoeff () / voxel;
  if (!(cells < SparseGrid::LIMIT))
    return {Status::GRID_TOO_FINE,
            "a voxel of " + toText (voxel) + " is too small for the extent of the cloud: use a larger voxel size"};

  SurfaceVertices vertices;
  std::vector<VertexPair> creases;
  LargeVector<Triangle> triangles;
  outcome = meshField (field, options, vertices, creases, triangles, report, progress);
  if (!outcome.ok ())
    return outcome;
  {
    const StageClock clock (report.seconds_slivers);
    removeSlivers (voxel, creases, triangles, vertices, options.threads);
  }
  std::vector<Crease> lines;
  {
    const StageClock clock (report.seconds_creases);
    lines = traceCreases (field, options, creases, triangles, vertices);
  }
  const StageClock clock (report.seconds_triangles);
  mesh = toInputFrame (field.points (), options.threads, vertices, triangles, std::move (lines));
  return {};
}

} // namespace erkpa
