// SPDX-License-Identifier: BSD-3-Clause
#include "surface_vertices.h"

#include "crease_solver.h"
#include "surface_tracking.h"
#include "threads.h"

#include <algorithm>
#include <cmath>

namespace erkpa
{

namespace
{

constexpr double TOLERANCE = 1e-4; // of a voxel, along the edge
constexpr double MARGIN = 1e-3;    // of a voxel: a vertex keeps this far from the grid nodes, or triangles degenerate
constexpr int MAX_STEPS = 12;

/** \brief Finds the root of f - iso on grid edges. */
class EdgeRoots
{
public:
  EdgeRoots (const SparseGrid &grid, const PolygonizerOptions &options) : grid_ (grid), options_ (options) {}

  /** \brief The root between two nodes with values of different sign; \a sample is taken there. */
  Eigen::Vector3d
  find (LocalField &local, const GridPoint &node, int axis, double low, double high, LocalSample &sample) const
  {
    const Eigen::Vector3d start = grid_.position (node);
    const double length = grid_.voxelSize ();
    double t = std::clamp (low / (low - high), MARGIN, 1.0 - MARGIN);
    double t_low = 0.0, t_high = 1.0;
    Eigen::Vector3d position;
    for (int step = 0;; ++step)
    {
      position = start;
      position[axis] += t * length;
      sample = local.sample (position);
      const double value = sample.value - options_.iso_level;
      if (step == MAX_STEPS || !sample.isDefined ())
        break;
      const double slope = sample.gradient[axis] * length;
      if (std::abs (value) <= TOLERANCE * std::abs (slope) || t_high - t_low < TOLERANCE)
        break;
      ((value < 0.0) == (low < 0.0) ? t_low : t_high) = t;
      const double newton = t - value / slope;
      const double next = newton > t_low && newton < t_high ? newton : 0.5 * (t_low + t_high);
      const double clamped = std::clamp (next, MARGIN, 1.0 - MARGIN);
      if (clamped == t)
        break;
      t = clamped;
    }
    return position;
  }

private:
  const SparseGrid &grid_;
  const PolygonizerOptions &options_;
};

void
storeVertex (const LocalField &local, const LocalSample &sample, const Eigen::Vector3d &position, std::size_t vertex,
             int channels, SurfaceVertices &vertices)
{
  vertices.positions[vertex] = position;
  const double slope = sample.gradient.norm ();
  vertices.normals[vertex] = slope > 0.0 ? Eigen::Vector3d (sample.gradient / slope) : Eigen::Vector3d::Zero ();
  vertices.border_offsets[vertex] = sample.border_offset;
  vertices.faces[vertex] = local.face ();
  vertices.side_keys[vertex] = local.sideKey ();
  if (channels > 0)
    local.blendAttributes (&vertices.attributes[vertex * static_cast<std::size_t> (channels)]);
}

/** \brief Moves a vertex of a thickened wall to the piece of f of its face; to the edge of the wall where that lies
 * beyond it. */
void
moveToFace (LocalField &local, const PolygonizerOptions &options, double voxel, std::size_t vertex,
            SurfaceVertices &vertices)
{
  constexpr double REACH = 1.5, BEYOND = 0.02; // voxels
  const Eigen::Vector3d start = vertices.positions[vertex];
  Eigen::Vector3d position = start;
  std::vector<Side> sides{{vertices.faces[vertex], start}};
  const auto move = [&]
  { return moveToCrease (local, sides, options.iso_level, REACH * voxel, TOLERANCE * voxel, position); };
  if (!move ())
    return;
  const double least_wall = local.thicken (0.0);
  const LocalSample there = local.sample (position);
  local.thicken (least_wall);
  if (std::abs (there.value - options.iso_level) > BEYOND * voxel && local.face () != vertices.faces[vertex])
  {
    sides.push_back ({local.face (), position});
    if (!move ())
      return;
  }
  vertices.positions[vertex] = position;
  const LocalSample piece = local.sampleOnSide (position, sides.front ());
  if (piece.isDefined () && piece.gradient.norm () > 0.0)
    vertices.normals[vertex] = piece.gradient.normalized ();
}

} // namespace

void
placeVertices (const ImplicitField &field, const PolygonizerOptions &options, SparseGrid &grid,
               SurfaceVertices &vertices, PolygonizerReport &report, const ProgressCallback &progress)
{
  const int channels = field.points ().channels;
  vertices.resize (static_cast<std::size_t> (grid.numberVertices ()), channels);
  vertices.found.resize (vertices.positions.size ());
  const EdgeRoots roots (grid, options);
  const auto place_on_edge = [&] (LocalField &local, const GridBlock &block, int node, int axis)
  {
    const GridPoint low = SparseGrid::pointAt (block, node);
    const GridPlace high = grid.find ({low.x + (axis == 0), low.y + (axis == 1), low.z + (axis == 2)});
    LocalSample sample;
    const Eigen::Vector3d position =
        roots.find (local, low, axis, block.values[static_cast<std::size_t> (node)],
                    grid.block (high.block).values[static_cast<std::size_t> (high.local)], sample);
    const auto vertex = static_cast<std::size_t> (SparseGrid::vertexOnEdge (block, node, axis));
    storeVertex (local, sample, position, vertex, channels, vertices);
    vertices.found[vertex] = position;
    if (local.thickening () != 0.0)
      moveToFace (local, options, grid.voxelSize (), vertex, vertices);
  };
  const auto place_in_block = [&] (LocalField &local, std::size_t index)
  {
    const GridBlock &block = grid.block (static_cast<int> (index));
    for (const BlockPart &part : partsOfBlock (field.typicalRadius () / grid.voxelSize ()))
    {
      if (((block.cut[0] | block.cut[1] | block.cut[2]) & part.nodes) == 0)
        continue;
      const double half = 0.5 * part.side * grid.voxelSize ();
      local.gather (grid.position (block.first + part.first).array () + half, std::sqrt (3.0) * half);
      for (int axis = 0; axis < 3; ++axis)
        for (int node = 0; node < GridBlock::NODES; ++node)
          if (block.cut[static_cast<std::size_t> (axis)] & part.nodes & std::uint64_t (1) << node)
            place_on_edge (local, block, node, axis);
    }
  };
  const auto blocks = static_cast<std::size_t> (grid.blockCount ());
  constexpr std::size_t SLICE = 8192;
  for (std::size_t first = 0; first < blocks; first += SLICE)
  {
    parallelFor (
        std::min (SLICE, blocks - first), options.threads, [&] { return fieldForGrid (field, grid.voxelSize ()); },
        [&] (LocalField &local, std::size_t i) { place_in_block (local, first + i); },
        [&report] (const LocalField &local)
        {
          report.evaluations += local.evaluations ();
          report.support_nodes += local.supportNodes ();
        });
    if (progress)
      progress (static_cast<double> (std::min (blocks, first + SLICE)) / static_cast<double> (blocks));
  }
}

void
projectVertices (const ImplicitField &field, const PolygonizerOptions &options, std::size_t first, double limit,
                 SurfaceVertices &vertices, PolygonizerReport &report)
{
  const int channels = field.points ().channels;
  vertices.resize (vertices.positions.size (), channels);
  const auto project = [&] (LocalField &local, std::size_t i)
  {
    const std::size_t vertex = first + i;
    const Eigen::Vector3d start = vertices.positions[vertex];
    Eigen::Vector3d position = start;
    local.gather (start, limit);
    LocalSample sample = local.sample (position);
    for (int step = 0; step < 3 && sample.isDefined (); ++step)
    {
      const double slope = std::max (sample.gradient.squaredNorm (), 1e-12);
      const Eigen::Vector3d next = position + (options.iso_level - sample.value) / slope * sample.gradient;
      if (!((next - start).norm () < limit))
        break;
      position = next;
      sample = local.sample (position);
    }
    storeVertex (local, sample, position, vertex, channels, vertices);
  };
  parallelFor (
      vertices.positions.size () - first, options.threads, [&] { return LocalField (field); }, project,
      [&report] (const LocalField &local)
      {
        report.evaluations += local.evaluations ();
        report.support_nodes += local.supportNodes ();
      });
}

} // namespace erkpa
