// SPDX-License-Identifier: BSD-3-Clause
#include "surface_vertices.h"

#include "block_evaluator.h"
#include "block_groups.h"
#include "grid_bits.h"
#include "threads.h"
#include "wall_vertices.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace erkpa
{

namespace
{

constexpr double TOLERANCE = 1e-4; // of a voxel, along the edge
constexpr double MARGIN = 1e-3;    // of a voxel: a vertex keeps this far from the grid nodes, or triangles degenerate
constexpr int MAX_STEPS = 16;      // as many as halving an edge takes to TOLERANCE, where f jumps, and a few more
constexpr double LEAST_SHORT = 0.03, MOST_SHORT = 0.1; // of a voxel: steps after which nobody looks where they lead

/** \brief An edge of the grid on which f - iso changes its sign, and what is known of the root on it. */
struct EdgeRoot
{
  const GridBlock *block;
  int node, axis;
  bool low_inside;
  double t; ///< where it is sought next, as a share of the edge
  double t_low = 0.0, t_high = 1.0;

  EdgeRoot (const GridBlock &of, int from, int along, double low, double high)
      : block (&of), node (from), axis (along), low_inside (low < 0.0),
        t (std::clamp (low / (low - high), MARGIN, 1.0 - MARGIN))
  {
  }

  /** \brief Take up f - iso and its slope along the edge at t.
   * \return how far a step of Newton's moves the root; 0 where it is found, all of the edge where it is halved instead
   */
  double
  refine (double value, double slope)
  {
    if (std::abs (value) <= TOLERANCE * std::abs (slope) || t_high - t_low < TOLERANCE)
      return 0.0;
    ((value < 0.0) == low_inside ? t_low : t_high) = t;
    const double newton = t - value / slope;
    const bool is_newton = newton > t_low && newton < t_high;
    const double next = is_newton ? newton : 0.5 * (t_low + t_high);
    const double before = std::exchange (t, std::clamp (next, MARGIN, 1.0 - MARGIN));
    return is_newton ? std::abs (t - before) : 1.0;
  }
};

/** \brief Puts the vertices on the cut edges of blocks. */
class VertexPlacer
{
public:
  VertexPlacer (const ImplicitField &field, const PolygonizerOptions &options, const SparseGrid &grid,
                SurfaceVertices &vertices)
      : options_ (options), grid_ (grid), vertices_ (vertices),
        parts_ (partsOfBlock (field.typicalRadius () / grid.voxelSize ())),
        short_step_ (std::clamp (std::sqrt (2.0 * TOLERANCE * field.typicalRadius () / grid.voxelSize ()), LEAST_SHORT,
                                 MOST_SHORT))
  {
  }

  struct Worker
  {
    GridField field;
    std::vector<std::size_t> in_walls; ///< vertices of thickened walls
  };

  /** \brief Place the vertices of some blocks that share a gathering of the field's nodes: see BlockGroups. */
  void
  placeInBlocks (Worker &worker, const int *first_block, const int *last_block) const
  {
    std::vector<EdgeRoot> roots;
    for (const BlockPart &part : parts_)
    {
      roots.clear ();
      Eigen::AlignedBox3d box;
      for (const int *index = first_block; index != last_block; ++index)
      {
        const GridBlock &block = grid_.block (*index);
        const std::size_t before = roots.size ();
        listRoots (block, part.nodes, roots);
        if (roots.size () == before)
          continue;
        const Eigen::Vector3d low = grid_.position (block.first + part.first);
        box.extend (low);
        box.extend (Eigen::Vector3d (low.array () + part.side * grid_.voxelSize ()));
      }
      if (roots.empty ())
        continue;
      const Eigen::Vector3d center = box.center ();
      const double extent = 0.5 * box.diagonal ().norm ();
      if (worker.field.block.gather (center, extent, true))
        placeTogether (worker, roots);
      if (roots.empty ())
        continue;
      worker.field.local.gather (center, extent);
      for (EdgeRoot &root : roots)
        placeAlone (worker, root);
    }
  }

private:
  void
  listRoots (const GridBlock &block, std::uint64_t nodes, std::vector<EdgeRoot> &roots) const
  {
    for (const std::uint64_t octant : grid_bits::OCTANTS)
      for (int axis = 0; axis < 3; ++axis)
        for (std::uint64_t left = block.cut[static_cast<std::size_t> (axis)] & nodes & octant; left != 0;
             left &= left - 1)
        {
          const int node = __builtin_ctzll (left);
          const GridPlace high = grid_.step ({block.above[0], node}, 1 << axis);
          roots.emplace_back (block, node, axis, block.values[static_cast<std::size_t> (node)],
                              grid_.block (high.block).values[static_cast<std::size_t> (high.local)]);
        }
  }

  Eigen::Vector3d
  positionOf (const EdgeRoot &root) const
  {
    Eigen::Vector3d position = grid_.position (SparseGrid::pointAt (*root.block, root.node));
    position[root.axis] += root.t * grid_.voxelSize ();
    return position;
  }

  static std::size_t
  vertexOf (const EdgeRoot &root)
  {
    return static_cast<std::size_t> (SparseGrid::vertexOnEdge (*root.block, root.node, root.axis));
  }

  /** \brief All roots of a block by Newton steps from the linear guess, each step for all of them at once.
   *
   * A last short step is taken without a look at where it leads: what it leaves is of second order, unless f jumps,
   * which shows in the number of steps.
   * \param[in,out] roots those that want LocalField are left
   */
  void
  placeTogether (Worker &worker, std::vector<EdgeRoot> &roots) const
  {
    BlockField &field = worker.field.block;
    constexpr int MOST_SMOOTH = 5;
    std::vector<EdgeRoot> alone;
    for (int step = 0; !roots.empty (); ++step)
    {
      const double short_step = step < MOST_SMOOTH ? short_step_ : 0.0;
      field.clearPoints ();
      std::size_t taken = 0;
      for (const EdgeRoot root : roots)
      {
        const Eigen::Vector3d position = positionOf (root);
        if (!field.addPoint (position))
        {
          alone.push_back (root);
          continue;
        }
        roots[taken++] = root;
      }
      field.evaluate (true);
      std::size_t left = 0;
      for (std::size_t i = 0; i < taken; ++i)
      {
        EdgeRoot root = roots[i];
        const double slope = field.gradient (i)[root.axis] * grid_.voxelSize ();
        if (!field.isSettled (i))
          alone.push_back (root);
        else if (step < MAX_STEPS && root.refine (field.value (i) - options_.iso_level, slope) > short_step)
          roots[left++] = root;
        else
        {
          const std::size_t vertex = vertexOf (root);
          storeVertex (field, i, positionOf (root), vertex, vertices_);
          noteWall (worker, vertex, field.thickening (i));
        }
      }
      roots.erase (roots.begin () + static_cast<std::ptrdiff_t> (left), roots.end ());
    }
    roots = std::move (alone);
  }

  void
  placeAlone (Worker &worker, EdgeRoot &root) const
  {
    LocalField &local = worker.field.local;
    LocalSample sample;
    Eigen::Vector3d position;
    for (int step = 0;; ++step)
    {
      position = positionOf (root);
      sample = local.sample (position);
      if (step == MAX_STEPS || !sample.isDefined () ||
          root.refine (sample.value - options_.iso_level, sample.gradient[root.axis] * grid_.voxelSize ()) == 0.0)
        break;
    }
    const std::size_t vertex = vertexOf (root);
    storeVertex (local, sample, position, vertex, vertices_);
    noteWall (worker, vertex, local.thickening ());
  }

  void
  noteWall (Worker &worker, std::size_t vertex, double thickening) const
  {
    if (vertices_.found.empty ())
      return;
    vertices_.found[vertex] = vertices_.positions[vertex];
    if (thickening != 0.0)
      worker.in_walls.push_back (vertex);
  }

  const PolygonizerOptions &options_;
  const SparseGrid &grid_;
  SurfaceVertices &vertices_;
  const std::vector<BlockPart> &parts_;
  double short_step_; // voxels: f curves by about the inverse of the radius, so that it leaves no more than TOLERANCE
};

} // namespace

void
storeVertex (const LocalField &local, const LocalSample &sample, const Eigen::Vector3d &position, std::size_t vertex,
             SurfaceVertices &vertices)
{
  vertices.positions[vertex] = position;
  const double slope = sample.gradient.norm ();
  vertices.normals[vertex] = slope > 0.0 ? Eigen::Vector3d (sample.gradient / slope) : Eigen::Vector3d::Zero ();
  vertices.border_offsets[vertex] = sample.border_offset;
  if (vertices.has_sides)
  {
    vertices.faces[vertex] = local.face ();
    vertices.side_keys[vertex] = local.sideKey ();
  }
  if (const std::size_t channels = vertices.channels (); channels > 0)
    local.blendAttributes (&vertices.attributes[vertex * channels]);
}

void
storeVertex (const BlockField &field, std::size_t point, const Eigen::Vector3d &position, std::size_t vertex,
             SurfaceVertices &vertices)
{
  vertices.positions[vertex] = position;
  vertices.normals[vertex] = field.gradient (point).stableNormalized ();
  vertices.border_offsets[vertex] = field.borderOffset (point);
  if (vertices.has_sides)
  {
    vertices.faces[vertex] = field.face (point);
    vertices.side_keys[vertex] = field.sideKey (point);
  }
  const std::size_t channels = vertices.channels ();
  for (std::size_t c = 0; c < channels; ++c)
    vertices.attributes[vertex * channels + c] = field.attribute (point, c);
}

void
placeVertices (const ImplicitField &field, const PolygonizerOptions &options, const MomentLattice *lattice,
               SparseGrid &grid, SurfaceVertices &vertices, PolygonizerReport &report, const ProgressCallback &progress)
{
  const int channels = field.points ().channels;
  constexpr double MORE = 0.05; // vertices on creases and borders follow, and shall not move the others
  const auto count = static_cast<std::size_t> (grid.numberVertices ());
  vertices.has_sides = field.faces () != nullptr || !field.options ().sharp_surfaces.empty ();
  vertices.reserve (count + static_cast<std::size_t> (MORE * static_cast<double> (count)), channels);
  vertices.resize (count, channels);
  if (field.faces () != nullptr)
    vertices.found.resize (vertices.positions.size ());
  const VertexPlacer placer (field, options, grid, vertices);
  std::vector<int> blocks (static_cast<std::size_t> (grid.blockCount ()));
  std::iota (blocks.begin (), blocks.end (), 0);
  const BlockGroups groups (grid, std::move (blocks), field.typicalRadius () / grid.voxelSize ());
  std::vector<std::size_t> in_walls;
  constexpr std::size_t SLICE = 8192;
  for (std::size_t first = 0; first < groups.size (); first += SLICE)
  {
    const std::size_t last = std::min (first + SLICE, groups.size ());
    parallelFor (
        last - first, options.threads,
        [&] {
          return VertexPlacer::Worker{GridField (field, options, grid.voxelSize (), lattice), {}};
        },
        [&] (VertexPlacer::Worker &worker, std::size_t i)
        { placer.placeInBlocks (worker, groups.begin (first + i), groups.end (first + i)); },
        [&] (const VertexPlacer::Worker &worker)
        {
          worker.field.addTo (report);
          in_walls.insert (in_walls.end (), worker.in_walls.begin (), worker.in_walls.end ());
        });
    if (progress)
      progress (static_cast<double> (last) / static_cast<double> (groups.size ()));
  }
  std::sort (in_walls.begin (), in_walls.end ()); // whichever thread found them
  moveToFaces (field, options, in_walls, vertices, report);
}

} // namespace erkpa
