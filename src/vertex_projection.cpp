// SPDX-License-Identifier: BSD-3-Clause
#include "vertex_projection.h"

#include "point_groups.h"
#include "threads.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace erkpa
{

namespace
{

constexpr int STEPS = 3;

/** \brief A vertex on its way to the surface. */
struct Way
{
  std::size_t vertex;
  Eigen::Vector3d start, position;

  /** \brief Take a Newton step.
   * \return whether one was taken: none leads farther from the start than a limit
   */
  bool
  step (double value, const Eigen::Vector3d &gradient, double limit)
  {
    const double slope = std::max (gradient.squaredNorm (), 1e-12);
    const Eigen::Vector3d next = position - value / slope * gradient;
    if (!((next - start).norm () < limit))
      return false;
    position = next;
    return true;
  }
};

class VertexProjector
{
public:
  struct Worker
  {
    LocalField local;
    BlockField block;
    std::vector<Way> together, alone;
  };

  VertexProjector (const PolygonizerOptions &options, double limit, SurfaceVertices &vertices)
      : iso_level_ (options.iso_level), limit_ (limit), vertices_ (vertices)
  {
  }

  void
  project (Worker &worker, std::size_t first, const PointGroup &group) const
  {
    worker.together.clear ();
    worker.alone.clear ();
    for (std::size_t i = group.first; i < group.last; ++i)
      worker.together.push_back ({first + i, vertices_.positions[first + i], vertices_.positions[first + i]});
    if (worker.block.gather (group.center, group.extent + limit_, true))
      for (int step = 0; step <= STEPS && !worker.together.empty (); ++step)
        stepTogether (worker, step == STEPS);
    worker.alone.insert (worker.alone.end (), worker.together.begin (), worker.together.end ());
    for (Way &way : worker.alone)
      projectAlone (worker.local, way);
  }

private:
  /** \brief A step of all that are together; those that want LocalField leave them, as do those that arrive. */
  void
  stepTogether (Worker &worker, bool is_last) const
  {
    BlockField &block = worker.block;
    std::vector<Way> &ways = worker.together;
    block.clearPoints ();
    std::size_t taken = 0;
    for (const Way &way : ways)
      if (block.addPoint (way.position))
        ways[taken++] = way;
      else
        worker.alone.push_back (way);
    block.evaluate (true);
    std::size_t left = 0;
    for (std::size_t i = 0; i < taken; ++i)
    {
      Way way = ways[i];
      if (!block.isSettled (i))
        worker.alone.push_back (way);
      else if (!is_last && way.step (block.value (i) - iso_level_, block.gradient (i), limit_))
        ways[left++] = way;
      else
        storeVertex (block, i, way.position, way.vertex, vertices_);
    }
    ways.resize (left);
  }

  void
  projectAlone (LocalField &local, Way &way) const
  {
    local.gather (way.start, limit_);
    LocalSample sample = local.sample (way.position);
    for (int step = 0; step < STEPS && sample.isDefined (); ++step)
    {
      if (!way.step (sample.value - iso_level_, sample.gradient, limit_))
        break;
      sample = local.sample (way.position);
    }
    storeVertex (local, sample, way.position, way.vertex, vertices_);
  }

  double iso_level_, limit_;
  SurfaceVertices &vertices_;
};

} // namespace

void
projectVertices (const ImplicitField &field, const PolygonizerOptions &options, std::size_t first, double limit,
                 const MomentLattice *lattice, SurfaceVertices &vertices, PolygonizerReport &report)
{
  vertices.resize (vertices.positions.size (), field.points ().channels);
  const std::vector<PointGroup> groups =
      groupPoints (vertices.positions.size () - first, report.voxel_size,
                   [&] (std::size_t i) -> const Eigen::Vector3d & { return vertices.positions[first + i]; });
  const VertexProjector projector (options, limit, vertices);
  using Worker = VertexProjector::Worker;
  parallelFor (
      groups.size (), options.threads,
      [&] {
        return Worker{LocalField (field), BlockField (field, lanes::bestEngine (), lattice), {}, {}};
      },
      [&] (Worker &worker, std::size_t g) { projector.project (worker, first, groups[g]); },
      [&report] (const Worker &worker)
      {
        report.evaluations += worker.local.evaluations () + worker.block.evaluations ();
        report.support_nodes += worker.local.supportNodes () + worker.block.supportNodes ();
      });
}

} // namespace erkpa
