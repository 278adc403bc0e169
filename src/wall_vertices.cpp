// SPDX-License-Identifier: BSD-3-Clause
#include "wall_vertices.h"

#include "point_groups.h"
#include "side_sampler.h"
#include "threads.h"

#include <cmath>

namespace erkpa
{

namespace
{

constexpr double REACH = 1.5, BEYOND = 0.02, TOLERANCE = 1e-4; // voxels

/** \brief Moves the vertices of one thread, as many at once as lie close together. */
class WallMover
{
public:
  WallMover (const ImplicitField &field, double iso_level, double voxel, SurfaceVertices &vertices)
      : iso_level_ (iso_level), voxel_ (voxel), vertices_ (vertices), sampler_ (field)
  {
  }

  void
  move (const std::size_t *first, const std::size_t *last, const PointGroup &group)
  {
    constexpr double NEAR = 0.7; // voxels that few vertices move
    sampler_.gather (group.center, group.extent + NEAR * voxel_);
    ways_.clear ();
    for (const std::size_t *vertex = first; vertex != last; ++vertex)
      ways_.push_back ({*vertex, solverFor ({sideOf (vertices_, *vertex)}, vertices_.positions[*vertex])});
    solve ();
    turnToEdges ();
    solve ();
    for (const Way &way : ways_)
      finish (way);
  }

  const SideSampler &
  sampler () const
  {
    return sampler_;
  }

private:
  /** \brief A vertex on its way to its face, or the edge of that. */
  struct Way
  {
    std::size_t vertex;
    CreaseSolver solver;
  };

  CreaseSolver
  solverFor (std::vector<Side> sides, const Eigen::Vector3d &from) const
  {
    return {std::move (sides), from, iso_level_, REACH * voxel_, TOLERANCE * voxel_};
  }

  void
  solve ()
  {
    std::vector<CreaseSolver *> solvers;
    for (Way &way : ways_)
      solvers.push_back (&way.solver);
    solveTogether (sampler_, std::move (solvers));
  }

  /** \brief Send vertices where f is of another face, as their own has ended, to the edge between the two. */
  void
  turnToEdges ()
  {
    std::vector<Way *> there;
    std::vector<SideSampler::Look> looks;
    for (Way &way : ways_)
      if (way.solver.hasArrived ())
      {
        there.push_back (&way);
        looks.push_back ({way.solver.position (), NAN, -1});
      }
    sampler_.look (looks);
    for (std::size_t i = 0; i < there.size (); ++i)
    {
      const Side own = there[i]->solver.sides ().front ();
      const SideSampler::Look &at = looks[i];
      if (std::abs (at.value - iso_level_) > BEYOND * voxel_ && at.face != own.face)
        there[i]->solver = solverFor ({own, {at.face, at.x}}, at.x);
    }
  }

  void
  finish (const Way &way)
  {
    if (!way.solver.hasArrived ())
      return;
    vertices_.positions[way.vertex] = way.solver.position ();
    const Eigen::Vector3d &gradient = way.solver.gradients ().front ();
    if (gradient.norm () > 0.0)
      vertices_.normals[way.vertex] = gradient.normalized ();
  }

  double iso_level_, voxel_;
  SurfaceVertices &vertices_;
  SideSampler sampler_;
  std::vector<Way> ways_;
};

} // namespace

void
moveToFaces (const ImplicitField &field, const PolygonizerOptions &options, const std::vector<std::size_t> &which,
             SurfaceVertices &vertices, PolygonizerReport &report)
{
  const std::vector<PointGroup> groups =
      groupPoints (which.size (), report.voxel_size,
                   [&] (std::size_t i) -> const Eigen::Vector3d & { return vertices.positions[which[i]]; });
  parallelFor (
      groups.size (), options.threads,
      [&] { return WallMover (field, options.iso_level, report.voxel_size, vertices); },
      [&] (WallMover &mover, std::size_t g)
      { mover.move (which.data () + groups[g].first, which.data () + groups[g].last, groups[g]); },
      [&report] (const WallMover &mover)
      {
        report.evaluations += mover.sampler ().evaluations ();
        report.support_nodes += mover.sampler ().supportNodes ();
      });
}

} // namespace erkpa
