// SPDX-License-Identifier: BSD-3-Clause
#include "feature_loops.h"

#include "crease_loop.h"
#include "crease_turn.h"
#include "side_sampler.h"
#include "threads.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief Meshes the loops of one thread, as many at once as lie close together. */
class LoopMesher
{
public:
  LoopMesher (const ImplicitField &field, const PolygonizerOptions &options, double voxel,
              const SurfaceVertices &vertices, bool has_border)
      : options_ (options), voxel_ (voxel), vertices_ (vertices), sampler_ (field),
        channels_ (static_cast<std::size_t> (field.points ().channels)), has_border_ (has_border)
  {
  }

  /** \param[in] first,last the loops
   * \param[out] results of each
   */
  void
  mesh (const CellLoop *first, const CellLoop *last, MeshedLoop *results)
  {
    loops_.clear ();
    for (const CellLoop *loop = first; loop != last; ++loop)
      loops_.emplace_back (*loop, vertices_, options_.iso_level, voxel_, *results++);
    findSides ();
    for (CreaseLoop &loop : loops_)
      loop.start ();
    solve ();
    for (CreaseLoop &loop : loops_)
      loop.startInside ();
    solve ();
    for (CreaseLoop &loop : loops_)
      if (loop.result ().has_center)
        describeCenter (loop);
  }

  const SideSampler &
  sampler () const
  {
    return sampler_;
  }

private:
  /** \brief Find where creases cross the loops, and the sides of them that their vertices lie on. */
  void
  findSides ()
  {
    std::vector<Passage> passages;
    for (std::size_t i = 0; i < loops_.size (); ++i)
      loops_[i].listPassages (i, passages);
    if (passages.empty ())
      return; // most loops are where a sharp surface crosses a smooth one
    gather ();
    findCreases (passages);
    for (const Passage &passage : passages)
      if (passage.is_crease)
        loops_[passage.loop].cross (passage.a, passage.b);
  }

  /** \brief Prepare for points in and near the loops. */
  void
  gather ()
  {
    constexpr double NEAR = 0.7; // voxels that few points are away from the middles of their loops
    Eigen::AlignedBox3d box;
    for (const CreaseLoop &loop : loops_)
      box.extend (loop.around ());
    sampler_.gather (box.center (), 0.5 * box.diagonal ().norm () + NEAR * voxel_);
  }

  /** \brief Tell where the pieces of f on the sides of two neighbours turn against each other between them. */
  void
  findCreases (std::vector<Passage> &passages)
  {
    std::vector<Passage *> open;
    std::vector<std::vector<Side>> sides;
    std::vector<SideSampler::Question> questions;
    sides.reserve (passages.size ()); // questions point there
    for (Passage &passage : passages)
    {
      const Side one = sideOf (vertices_, static_cast<std::size_t> (std::min (passage.a, passage.b))),
                 other = sideOf (vertices_, static_cast<std::size_t> (std::max (passage.a, passage.b)));
      const Eigen::Vector3d middle = 0.5 * (one.place + other.place);
      passage.is_crease = turnBetween (normalOf (passage.a), normalOf (passage.b)) > CERTAIN_CREASE_TURN &&
                          sampler_.keepsApart (one.face, other.face, middle);
      if (passage.is_crease)
        continue;
      open.push_back (&passage);
      sides.push_back ({one, other});
      questions.push_back ({middle, &sides.back (), {}});
    }
    sampler_.sample (questions, LocalField::Slope::OF_THE_FIT);
    for (std::size_t i = 0; i < open.size (); ++i)
    {
      const LocalSample &one = questions[i].samples.front (), &other = questions[i].samples.back ();
      open[i]->is_crease =
          one.isDefined () && other.isDefined () && turnBetween (one.gradient, other.gradient) > LEAST_CREASE_TURN;
    }
  }

  const Eigen::Vector3d &
  normalOf (int v) const
  {
    return vertices_.normals[static_cast<std::size_t> (v)];
  }

  /** \brief Go on with all loops that are on their way, together, until they arrive. */
  void
  solve ()
  {
    std::vector<CreaseSolver *> solvers;
    for (CreaseLoop &loop : loops_)
      if (CreaseSolver *const solver = loop.solver ())
        solvers.push_back (solver);
    solveTogether (sampler_, std::move (solvers));
    for (CreaseLoop &loop : loops_)
      loop.arrive ();
  }

  void
  describeCenter (CreaseLoop &loop)
  {
    MeshedLoop &result = loop.result ();
    loop.describe ();
    result.attributes.resize (channels_);
    if (has_border_ || channels_ > 0)
      result.border_offset = sampler_.sample (result.position).border_offset;
    if (channels_ > 0)
      sampler_.blendAttributes (result.attributes.data ());
  }

  const PolygonizerOptions &options_;
  double voxel_;
  const SurfaceVertices &vertices_;
  SideSampler sampler_;
  std::size_t channels_;
  bool has_border_; // whether border offsets are wanted
  std::vector<CreaseLoop> loops_;
};

/** \brief The ends of runs of loops that lie close together.
 * \param[in] side,most of the box around a run, and loops in it
 */
std::vector<std::size_t>
findRuns (const LargeVector<CellLoop> &loops, const SurfaceVertices &vertices, double side, std::size_t most)
{
  std::vector<std::size_t> ends;
  Eigen::AlignedBox3d box;
  std::size_t first = 0;
  for (std::size_t i = 0; i < loops.size (); ++i)
  {
    const Eigen::Vector3d &place = vertices.positions[static_cast<std::size_t> (loops[i].ring.front ())];
    box.extend (place);
    if (i > first && (box.sizes ().maxCoeff () > side || i - first == most))
    {
      ends.push_back (i);
      box = Eigen::AlignedBox3d (place);
      first = i;
    }
  }
  if (!loops.empty ())
    ends.push_back (loops.size ());
  return ends;
}

} // namespace

std::vector<MeshedLoop>
meshLoops (const ImplicitField &field, const PolygonizerOptions &options, const LargeVector<CellLoop> &loops,
           double voxel, bool has_border, const SurfaceVertices &vertices, PolygonizerReport &report)
{
  constexpr double SIDE = 6.0; // voxels
  constexpr std::size_t MOST = 64;
  // One point after the other, each loop is quickest with a gathering of its own.
  const std::vector<std::size_t> ends =
      findRuns (loops, vertices, SIDE * voxel, BlockField::canSampleSides (field) ? MOST : 1);
  std::vector<MeshedLoop> meshed (loops.size ());
  parallelFor (
      ends.size (), options.threads, [&] { return LoopMesher (field, options, voxel, vertices, has_border); },
      [&] (LoopMesher &mesher, std::size_t i)
      {
        const std::size_t first = i == 0 ? 0 : ends[i - 1];
        mesher.mesh (loops.data () + first, loops.data () + ends[i], meshed.data () + first);
      },
      [&report] (const LoopMesher &mesher)
      {
        report.evaluations += mesher.sampler ().evaluations ();
        report.support_nodes += mesher.sampler ().supportNodes ();
      });
  return meshed;
}

} // namespace erkpa
