// SPDX-License-Identifier: BSD-3-Clause
#include "sliver_removal.h"

#include "edge_judge.h"
#include "mesh_regions.h"
#include "parallel_collect.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>

namespace erkpa
{

namespace
{

using Triangle = std::array<int, 3>;

// Lengths are in voxels, angles given by their sines.
constexpr double SHORT = 0.2;             // sides that collapse
constexpr double LONGEST_COLLAPSED = 0.6; // of a sliver
constexpr double REGION = 48.0;           // for one thread at a time
constexpr double SLIVER = 0.09;           // smallest angle (5 degrees)
constexpr double NARROW = 0.17;           // smallest angle that calls for a flip (10 degrees)
constexpr double LEAST_GAIN = 0.05;       // by which a flip must widen the smallest angle

class SliverRemover
{
public:
  SliverRemover (double voxel, int threads, const std::vector<VertexPair> &creases, LargeVector<Triangle> &triangles,
                 const SurfaceVertices &vertices)
      : short_ (square (SHORT * voxel)), longest_collapsed_ (square (LONGEST_COLLAPSED * voxel)), threads_ (threads),
        edges_ (std::move (triangles), vertices.positions.size (), threads), judge_ (voxel, creases, vertices, edges_),
        regions_ (REGION * voxel, vertices.positions, threads), changed_in_ (vertices.positions.size (), 0)
  {
  }

  void
  run ()
  {
    queue_ = parallelCollect<LargeVector<ShortEdge>> (
        3 * edges_.triangleCount (), threads_,
        [this] (std::size_t first, std::size_t last, LargeVector<ShortEdge> &found)
        {
          for (std::size_t h = first; h < last; ++h)
            queueIfShort (static_cast<int> (h), found);
        });
    collapseQueued ();
    const LargeVector<int> narrow = findNarrow ();
    constexpr int PASSES = 4;
    bool changed = true;
    for (pass_ = 1; pass_ <= PASSES && changed; ++pass_)
    {
      changed = mendAll (narrow);
      collapseQueued ();
    }
  }

  /** \brief The triangles that are left; the creases become those that are left. */
  LargeVector<Triangle>
  finish (std::vector<VertexPair> &creases)
  {
    if (!creases.empty ())
    {
      creases.clear ();
      for (int h = 0; h < static_cast<int> (3 * edges_.triangleCount ()); ++h)
        if (edges_.onCrease (h) && edges_.isAlive (h) && edges_.twin (h) < h)
          creases.push_back (orderedPair (edges_.start (h), edges_.end (h)));
      std::sort (creases.begin (), creases.end ());
    }
    return edges_.release ();
  }

private:
  using ShortEdge = std::pair<double, int>; // squared length and half-edge

  /** \brief What one thread finds while it changes the mesh. */
  struct Worker
  {
    LargeVector<ShortEdge> queue; // edges that have become short
    bool changed = false;
  };

  static double
  square (double x)
  {
    return x * x;
  }

  void
  queueIfShort (int h, LargeVector<ShortEdge> &queue) const
  {
    if (edges_.start (h) > edges_.end (h))
      return; // its twin is queued
    const double length = judge_.squaredLength (h);
    if (length < short_)
      queue.emplace_back (length, h);
  }

  /** \brief Visit the vertices whose triangles count for \a sides sides of a triangle from \a h on. */
  template <typename VisitT>
  void
  visitOwn (int h, int sides, VisitT visit) const
  {
    judge_.visitOwn (edges_.start (h), visit);
    judge_.visitOwn (edges_.end (h), visit);
    if (sides > 1)
      judge_.visitOwn (edges_.start (HalfEdges::previous (h)), visit);
  }

  /** \brief Run work (worker, half-edge) for each of many in which the triangles at \a sides sides from it on may
   * change. \param[in] at at (job) is the half-edge \return whether any changed the mesh
   */
  template <typename AtT, typename NeedT, typename BeforeT, typename WorkT>
  bool
  runAll (std::size_t count, int sides, AtT at, NeedT is_needed, BeforeT before, WorkT work)
  {
    bool changed = false;
    regions_.run (
        count, [&] (std::size_t job) { return edges_.isAlive (at (job)) ? edges_.start (at (job)) : -1; },
        [&] (std::size_t job, auto visit)
        {
          const int h = at (job);
          if (edges_.isAlive (h) && is_needed (h))
            visitOwn (h, sides, [&] (int v) { edges_.visitNeighbors (v, visit); });
        },
        before, [] { return Worker (); }, [&] (Worker &worker, std::size_t job) { work (worker, at (job)); },
        [&] (Worker &worker)
        {
          queue_.insert (queue_.end (), worker.queue.begin (), worker.queue.end ());
          changed = changed || worker.changed;
        });
    return changed;
  }

  /** \brief Collapse short edges, the shortest first, and those that become short thereby. */
  void
  collapseQueued ()
  {
    constexpr int PASSES = 4;
    for (int pass = 0; pass < PASSES && !queue_.empty (); ++pass)
    {
      LargeVector<ShortEdge> queue;
      queue.swap (queue_);
      runAll (
          queue.size (), 1, [&] (std::size_t job) { return queue[job].second; },
          [this] (int h) { return judge_.squaredLength (h) < short_; },
          [&] (std::uint32_t a, std::uint32_t b) { return queue[a] < queue[b]; },
          [this] (Worker &worker, int h) { collapseBetterWay (h, worker); });
    }
    queue_.clear ();
  }

  LargeVector<int>
  findNarrow () const
  {
    return parallelCollect<LargeVector<int>> (edges_.triangleCount (), threads_,
                                              [this] (std::size_t first, std::size_t last, LargeVector<int> &found)
                                              {
                                                for (std::size_t t = first; t < last; ++t)
                                                  if (isNarrow (static_cast<int> (3 * t)))
                                                    found.push_back (static_cast<int> (3 * t));
                                              });
  }

  bool
  isNarrow (int h) const
  {
    return edges_.isAlive (h) && judge_.shapeOf (h).isNarrow (NARROW);
  }

  /** \brief Mend the triangles around which anything has changed since the last pass. */
  bool
  mendAll (const LargeVector<int> &narrow)
  {
    const auto is_new = [this] (int h)
    {
      bool any = pass_ == 1;
      visitOwn (h, 3, [&] (int v) { any = any || changed_in_[static_cast<std::size_t> (v)] >= pass_ - 1; });
      return any;
    };
    return runAll (
        narrow.size (), 3, [&] (std::size_t job) { return narrow[job]; },
        [&] (int h) { return isNarrow (h) && is_new (h); }, std::less<std::uint32_t> (),
        [this] (Worker &worker, int h) { worker.changed = mend (h, worker) || worker.changed; });
  }

  /** \brief Collapse or flip a side of a narrow triangle. */
  bool
  mend (int h, Worker &worker)
  {
    const double sine = judge_.shapeOf (h).sine ();
    std::array<std::pair<double, int>, 3> sides;
    for (int i = 0; i < 3; ++i)
      sides[static_cast<std::size_t> (i)] = {judge_.squaredLength (h + i), h + i};
    std::sort (sides.begin (), sides.end ());
    if (sides[0].first < short_ && collapseBetterWay (sides[0].second, worker))
      return true;
    if (flipBestSide (h))
      return true;
    for (const auto &[length, side] : sides)
      if (sine < SLIVER && length < longest_collapsed_ && collapseBetterWay (side, worker))
        return true;
    return false;
  }

  /** \brief Collapse an edge onto the vertex that leaves the wider angles. */
  bool
  collapseBetterWay (int h, Worker &worker)
  {
    const int back = edges_.twin (h);
    if (back < 0)
      return false;
    const double forth_sine = judge_.sineAfterCollapse (h), back_sine = judge_.sineAfterCollapse (back);
    if (std::max (forth_sine, back_sine) < 0.0)
      return false;
    const int chosen = forth_sine >= back_sine ? h : back, kept = edges_.end (chosen);
    edges_.collapse (chosen);
    markChanged (kept);
    edges_.around (kept,
                   [&] (int side)
                   {
                     queueIfShort (side, worker.queue);
                     queueIfShort (HalfEdges::previous (side), worker.queue);
                   });
    return true;
  }

  /** \brief Flip the side of a triangle where that helps most. */
  bool
  flipBestSide (int first)
  {
    int best = -1;
    double best_gain = LEAST_GAIN;
    for (int h = first; h < first + 3; ++h)
    {
      const double gain = judge_.gainOfFlip (h);
      if (gain > best_gain)
      {
        best_gain = gain;
        best = h;
      }
    }
    if (best < 0)
      return false;
    edges_.flip (best);
    markChanged (edges_.start (best));
    markChanged (edges_.end (best));
    return true;
  }

  void
  markChanged (int v)
  {
    edges_.visitNeighbors (v, [this] (int w) { changed_in_[static_cast<std::size_t> (w)] = pass_; });
  }

  double short_, longest_collapsed_; // squared lengths
  int threads_;
  HalfEdges edges_;
  EdgeJudge judge_;
  MeshRegions regions_;
  LargeVector<ShortEdge> queue_;
  signed char pass_ = 0;                // over the narrow triangles
  std::vector<signed char> changed_in_; // per vertex: the last pass in which its triangles changed
};

} // namespace

void
removeSlivers (double voxel, std::vector<VertexPair> &creases, LargeVector<Triangle> &triangles,
               const SurfaceVertices &vertices, int threads)
{
  SliverRemover remover (voxel, threads, creases, triangles, vertices);
  remover.run ();
  triangles = remover.finish (creases);
}

} // namespace erkpa
