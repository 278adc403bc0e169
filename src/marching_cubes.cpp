// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/marching_cubes.h>

#include "border.h"
#include "cell_loops.h"
#include "cell_mesher.h"
#include "crease_edges.h"
#include "crease_lines.h"
#include "feature_loops.h"
#include "mesh_graph.h"
#include "sliver_removal.h"
#include "sparse_grid.h"
#include "surface_tracking.h"
#include "surface_vertices.h"
#include "text.h"
#include "threads.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace erkpa
{

namespace
{

using Triangle = std::array<int, 3>;

/** \brief Lengths of the box around the nodes. */
Eigen::Vector3d
extentOf (const ImplicitField &field)
{
  Eigen::Vector3f low = field.surfacePositions ().front (), high = low;
  for (const Eigen::Vector3f &p : field.surfacePositions ())
  {
    low = low.cwiseMin (p);
    high = high.cwiseMax (p);
  }
  return (high - low).cast<double> ();
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
  if (options.threads < 0)
    return bad ("the number of threads must be positive, or 0 for all processors");
  return {};
}

/** \brief Marks the edges that carry the vertices of the active cells. */
void
markCutEdges (const std::vector<GridPoint> &cells, SparseGrid &grid)
{
  for (const GridPoint &cell : cells)
  {
    const std::array<double, 8> values = grid.cornerValues (cell);
    for (int e = 0; e < 12; ++e)
    {
      const CellEdge edge = cellEdge (e);
      const int other = edge.corner | 1 << edge.axis;
      if ((values[static_cast<std::size_t> (edge.corner)] < 0.0) == (values[static_cast<std::size_t> (other)] < 0.0))
        continue;
      const GridPlace place = grid.place (cell + cornerOffset (edge.corner));
      grid.block (place.block).cut[static_cast<std::size_t> (edge.axis)] |= place.bit ();
    }
  }
}

/** \brief Put a vertex in the middle of each loop, with triangles around it. */
void
meshCentered (const std::vector<CellLoop> &loops, std::vector<Triangle> &triangles, SurfaceVertices &vertices)
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

/** \brief Drops the pieces of surface that too few nodes support; returns how many. */
std::size_t
dropUnsupported (const SparseGrid &grid, const std::vector<GridPoint> &cells_of_nodes, int min_points,
                 std::size_t vertex_count, std::vector<Triangle> &triangles)
{
  DisjointSets pieces (vertex_count);
  std::vector<char> used (vertex_count, 0);
  for (const Triangle &t : triangles)
  {
    pieces.unite (t[0], t[1]);
    pieces.unite (t[1], t[2]);
    for (const int v : t)
      used[static_cast<std::size_t> (v)] = 1;
  }
  std::vector<int> support (vertex_count, 0);
  for (const GridPoint &cell : cells_of_nodes)
  {
    if (cell.x == SurfaceTracker::NO_CELL || !grid.isActive (cell))
      continue;
    const CellLoops loops = traceLoops (grid.cornerValues (cell));
    const CellEdge edge = cellEdge (loops.edges[0][0]);
    const int vertex = grid.vertexOnEdge (cell + cornerOffset (edge.corner), edge.axis);
    if (used[static_cast<std::size_t> (vertex)])
      ++support[static_cast<std::size_t> (pieces.find (vertex))];
  }
  std::size_t dropped = 0;
  for (int v = 0; v < static_cast<int> (vertex_count); ++v)
    dropped +=
        used[static_cast<std::size_t> (v)] && pieces.find (v) == v && support[static_cast<std::size_t> (v)] < min_points
            ? 1
            : 0;
  triangles.erase (std::remove_if (triangles.begin (), triangles.end (),
                                   [&] (const Triangle &t)
                                   { return support[static_cast<std::size_t> (pieces.find (t[0]))] < min_points; }),
                   triangles.end ());
  return dropped;
}

Outcome
noSurface (const ImplicitField &field, double voxel, std::size_t dropped)
{
  std::string why = "no surface was found at the points: the support may hold too few of them (use a larger k or "
                    "radius), or the iso level may lie beyond them";
  if (voxel > 0.5 * extentOf (field).maxCoeff ())
    why = "no surface was found: the voxel of " + toText (voxel) + " is as large as the cloud, use a smaller one";
  else if (dropped > 0)
    why = "only small pieces of surface were found, which too few points support: are these points of a surface?";
  return {Status::NO_SURFACE, why};
}

/** \brief Gives vertices where the field has no gradient the mean direction of their triangles. */
void
fillNormals (const std::vector<Triangle> &triangles, SurfaceVertices &vertices)
{
  std::vector<Eigen::Vector3d> sums;
  const auto is_missing = [] (const Eigen::Vector3d &n) { return n.isZero (0.0); };
  if (std::none_of (vertices.normals.begin (), vertices.normals.end (), is_missing))
    return;
  sums.assign (vertices.normals.size (), Eigen::Vector3d::Zero ());
  for (const Triangle &t : triangles)
  {
    const auto at = [&] (std::size_t i) { return vertices.positions[static_cast<std::size_t> (t[i])]; };
    const Eigen::Vector3d area = (at (1) - at (0)).cross (at (2) - at (0));
    for (const int v : t)
      sums[static_cast<std::size_t> (v)] += area;
  }
  for (std::size_t v = 0; v < sums.size (); ++v)
    if (is_missing (vertices.normals[v]))
      vertices.normals[v] = sums[v].norm () > 0.0 ? Eigen::Vector3d (sums[v].normalized ()) : Eigen::Vector3d::UnitZ ();
}

TriangleMesh
toInputFrame (const OrientedPoints &points, const SurfaceVertices &vertices, std::vector<Triangle> &triangles,
              std::vector<Crease> creases)
{
  TriangleMesh mesh;
  mesh.creases = std::move (creases);
  mesh.vertices.reserve (vertices.positions.size ());
  mesh.normals.reserve (vertices.positions.size ());
  for (std::size_t v = 0; v < vertices.positions.size (); ++v)
  {
    mesh.vertices.emplace_back ((vertices.positions[v] + points.origin).cast<float> ());
    mesh.normals.emplace_back (vertices.normals[v].cast<float> ());
  }
  mesh.channels = points.channels;
  mesh.attributes = vertices.attributes;
  mesh.triangles.swap (triangles);
  removeUnusedVertices (mesh);
  return mesh;
}

} // namespace

double
chooseVoxelSize (const ImplicitField &field, const PolygonizerOptions &options)
{
  if (options.voxel_size > 0.0)
    return options.voxel_size;
  if (options.resolution > 0)
    return extentOf (field).maxCoeff () / options.resolution;
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
  Outcome outcome = checkOptions (options);
  if (!outcome.ok ())
    return outcome;
  const double voxel = report.voxel_size = chooseVoxelSize (field, options);
  const double cells = extentOf (field).maxCoeff () / voxel;
  if (!(cells < SparseGrid::LIMIT))
    return {Status::GRID_TOO_FINE,
            "a voxel of " + toText (voxel) + " is too small for the extent of the cloud: use a larger voxel size"};

  // Off the middle of the cloud by odd shares of a cell: faces of boxes then do not fall on grid nodes.
  SparseGrid grid (-voxel * Eigen::Vector3d (0.371, 0.437, 0.293), voxel);
  SurfaceTracker tracker (field, options, grid, report, partOf (progress, 0.0, 0.5));
  outcome = tracker.track ();
  if (!outcome.ok ())
    return outcome;
  markCutEdges (tracker.activeCells (), grid);
  SurfaceVertices vertices;
  placeVertices (field, options, grid, vertices, report, partOf (progress, 0.5, 0.5));

  const std::size_t on_edges = vertices.positions.size ();
  CellMesh cell_mesh = meshCells (grid, tracker.activeCells (), options.threads, vertices);
  std::vector<Triangle> triangles = std::move (cell_mesh.triangles);
  meshCentered (cell_mesh.centered_loops, triangles, vertices);
  projectVertices (field, options, on_edges, 0.3 * voxel, vertices, report);
  const std::vector<MeshedLoop> loops = meshLoops (field, options, cell_mesh.mixed_loops, voxel, vertices, report);
  std::vector<VertexPair> creases = addCreases (voxel, cell_mesh.mixed_loops, loops, triangles, vertices);
  const std::size_t in_cells = vertices.positions.size ();
  trimBorder (options.border_offset, triangles, vertices);
  projectVertices (field, options, in_cells, 0.1 * voxel, vertices, report);
  const int min_points = std::min (options.min_component_points, static_cast<int> (field.points ().size ()) / 2);
  report.dropped_components =
      dropUnsupported (grid, tracker.cellsOfNodes (), min_points, vertices.positions.size (), triangles);
  if (triangles.empty ())
    return noSurface (field, voxel, report.dropped_components);
  splitFans (triangles, vertices);
  fillNormals (triangles, vertices);
  removeSlivers (voxel, creases, triangles, vertices);
  std::vector<Crease> lines = traceCreases (field, options, creases, triangles, vertices);
  mesh = toInputFrame (field.points (), vertices, triangles, std::move (lines));
  return {};
}

} // namespace erkpa
