// SPDX-License-Identifier: BSD-3-Clause
#include "sliver_removal.h"

#include "edge_judge.h"

#include <algorithm>

namespace erkpa
{

namespace
{

using Triangle = std::array<int, 3>;

// Lengths are in voxels, angles given by their sines.
constexpr double SHORT = 0.2;             // sides that collapse
constexpr double LONGEST_COLLAPSED = 0.6; // of a sliver
constexpr double SLIVER = 0.09;           // smallest angle (5 degrees)
constexpr double NARROW = 0.17;           // smallest angle that calls for a flip (10 degrees)
constexpr double LEAST_GAIN = 0.05;       // by which a flip must widen the smallest angle

class SliverRemover
{
public:
  SliverRemover (double voxel, const std::vector<VertexPair> &creases, std::vector<Triangle> &triangles,
                 const SurfaceVertices &vertices)
      : short_ (square (SHORT * voxel)), longest_collapsed_ (square (LONGEST_COLLAPSED * voxel)),
        triangles_ (triangles), edges_ (triangles, vertices.positions.size ()),
        judge_ (voxel, creases, vertices, edges_)
  {
  }

  void
  run ()
  {
    for (int h = 0; h < static_cast<int> (3 * triangles_.size ()); ++h)
      queueIfShort (h);
    collapseQueued ();
    std::vector<int> narrow;
    for (int h = 0; h < static_cast<int> (3 * triangles_.size ()); h += 3)
      if (edges_.isAlive (h) && judge_.shapeOf (h).sine < NARROW)
        narrow.push_back (h);
    constexpr int PASSES = 4;
    bool changed = true;
    for (int pass = 0; pass < PASSES && changed; ++pass)
    {
      changed = false;
      for (const int h : narrow)
        changed = (edges_.isAlive (h) && mend (h)) || changed;
      collapseQueued ();
    }
  }

  /** \brief Drop what vanished; the creases are those that are left. */
  std::vector<VertexPair>
  finish ()
  {
    std::vector<VertexPair> creases;
    for (int h = 0; h < static_cast<int> (3 * triangles_.size ()); ++h)
      if (edges_.onCrease (h) && edges_.isAlive (h) && edges_.twin (h) < h)
        creases.push_back (orderedPair (edges_.start (h), edges_.end (h)));
    std::sort (creases.begin (), creases.end ());
    edges_.collect (triangles_);
    return creases;
  }

private:
  static double
  square (double x)
  {
    return x * x;
  }

  void
  queueIfShort (int h)
  {
    if (edges_.start (h) > edges_.end (h))
      return; // its twin is queued
    const double length = judge_.squaredLength (h);
    if (length < short_)
      queue_.emplace_back (length, h);
  }

  /** \brief Collapse short edges, the shortest first, and those that become short thereby. */
  void
  collapseQueued ()
  {
    constexpr int PASSES = 4;
    for (int pass = 0; pass < PASSES && !queue_.empty (); ++pass)
    {
      std::vector<std::pair<double, int>> queue;
      queue.swap (queue_);
      std::sort (queue.begin (), queue.end ());
      for (const auto &[length, h] : queue)
        if (edges_.isAlive (h) && judge_.squaredLength (h) < short_)
          collapseBetterWay (h);
    }
    queue_.clear ();
  }

  /** \brief Collapse or flip a side of a triangle if it is narrow. */
  bool
  mend (int h)
  {
    const double sine = judge_.shapeOf (h).sine;
    if (sine >= NARROW)
      return false;
    std::array<std::pair<double, int>, 3> sides;
    for (int i = 0; i < 3; ++i)
      sides[static_cast<std::size_t> (i)] = {judge_.squaredLength (h + i), h + i};
    std::sort (sides.begin (), sides.end ());
    if (sides[0].first < short_ && collapseBetterWay (sides[0].second))
      return true;
    if (flipBestSide (h))
      return true;
    for (const auto &[length, side] : sides)
      if (sine < SLIVER && length < longest_collapsed_ && collapseBetterWay (side))
        return true;
    return false;
  }

  /** \brief Collapse an edge onto the vertex that leaves the wider angles. */
  bool
  collapseBetterWay (int h)
  {
    const int back = edges_.twin (h);
    if (back < 0)
      return false;
    const double forth_sine = judge_.sineAfterCollapse (h), back_sine = judge_.sineAfterCollapse (back);
    if (std::max (forth_sine, back_sine) < 0.0)
      return false;
    const int chosen = forth_sine >= back_sine ? h : back, kept = edges_.end (chosen);
    edges_.collapse (chosen);
    edges_.around (kept,
                   [this] (int side)
                   {
                     queueIfShort (side);
                     queueIfShort (HalfEdges::previous (side));
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
    if (best >= 0)
      edges_.flip (best);
    return best >= 0;
  }

  double short_, longest_collapsed_; // squared lengths
  std::vector<Triangle> &triangles_;
  HalfEdges edges_;
  EdgeJudge judge_;
  std::vector<std::pair<double, int>> queue_; // short edges by their squared length
};

} // namespace

void
removeSlivers (double voxel, std::vector<VertexPair> &creases, std::vector<Triangle> &triangles,
               const SurfaceVertices &vertices)
{
  SliverRemover remover (voxel, creases, triangles, vertices);
  remover.run ();
  creases = remover.finish ();
}

} // namespace erkpa
