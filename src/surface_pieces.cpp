// SPDX-License-Identifier: BSD-3-Clause
#include "surface_pieces.h"

#include "cell_loops.h"
#include "concurrent_sets.h"
#include "parallel_collect.h"

#include <algorithm>
#include <atomic>

namespace erkpa
{

namespace
{

using Triangle = std::array<int, 3>;

/** \brief The first vertex of each piece that has triangles, sorted. */
LargeVector<int>
findPieces (const LargeVector<Triangle> &triangles, int threads, ConcurrentSets &sets)
{
  LargeVector<int> pieces =
      parallelCollect<LargeVector<int>> (triangles.size (), threads,
                                         [&] (std::size_t first, std::size_t last, LargeVector<int> &found)
                                         {
                                           for (std::size_t t = first; t < last; ++t)
                                           {
                                             const int piece = sets.find (triangles[t][0]);
                                             if (found.empty () || found.back () != piece)
                                               found.push_back (piece);
                                           }
                                           std::sort (found.begin (), found.end ());
                                           found.erase (std::unique (found.begin (), found.end ()), found.end ());
                                         });
  std::sort (pieces.begin (), pieces.end ());
  pieces.erase (std::unique (pieces.begin (), pieces.end ()), pieces.end ());
  return pieces;
}

/** \brief Counts the nodes that support each piece, as far as needed. */
class SupportCounter
{
public:
  SupportCounter (const SparseGrid &grid, const SurfaceTracker &tracker, int min_points, const LargeVector<int> &pieces,
                  ConcurrentSets &sets)
      : grid_ (grid), tracker_ (tracker), min_points_ (min_points), pieces_ (pieces), sets_ (sets),
        counts_ (pieces.size ())
  {
  }

  void
  count (int threads)
  {
    // Most surfaces are of few pieces, and a few nodes tell of each that it stays.
    const std::size_t nodes = tracker_.nodeCount ();
    for (std::size_t first = 0, size = 256; first < nodes && !allStay (); first += size, size *= 4)
      parallelRanges (std::min (size, nodes - first), threads,
                      [&] (std::size_t begin, std::size_t end)
                      {
                        GridWindow window (grid_);
                        for (std::size_t i = begin; i < end; ++i)
                          countAt (first + i, window);
                      });
  }

  bool
  stays (int piece) const
  {
    const auto place = std::lower_bound (pieces_.begin (), pieces_.end (), piece) - pieces_.begin ();
    return counts_[static_cast<std::size_t> (place)].load (std::memory_order_relaxed) >= min_points_;
  }

  bool
  allStay () const
  {
    return std::all_of (pieces_.begin (), pieces_.end (), [this] (int piece) { return stays (piece); });
  }

private:
  void
  countAt (std::size_t node, GridWindow &window)
  {
    GridPoint cell{};
    if (!tracker_.findCellOfNode (window, node, cell))
      return;
    const CellEdge edge = cellEdge (traceLoops (grid_.cornerValues (cell)).edges[0][0]);
    const int piece = sets_.find (grid_.vertexOnEdge (cell + cornerOffset (edge.corner), edge.axis));
    const auto found = std::lower_bound (pieces_.begin (), pieces_.end (), piece);
    if (found != pieces_.end () && *found == piece) // else of a vertex that was cut away
      counts_[static_cast<std::size_t> (found - pieces_.begin ())].fetch_add (1, std::memory_order_relaxed);
  }

  const SparseGrid &grid_;
  const SurfaceTracker &tracker_;
  int min_points_;
  const LargeVector<int> &pieces_;
  ConcurrentSets &sets_;
  std::vector<std::atomic<int>> counts_; // nodes per piece
};

} // namespace

std::size_t
dropUnsupported (const SparseGrid &grid, const SurfaceTracker &tracker, int min_points, int threads,
                 std::size_t vertex_count, LargeVector<Triangle> &triangles)
{
  ConcurrentSets sets (vertex_count, threads);
  parallelRanges (triangles.size (), threads,
                  [&] (std::size_t first, std::size_t last)
                  {
                    for (std::size_t t = first; t < last; ++t)
                    {
                      sets.unite (triangles[t][0], triangles[t][1]);
                      sets.unite (triangles[t][1], triangles[t][2]);
                    }
                  });
  const LargeVector<int> pieces = findPieces (triangles, threads, sets);
  SupportCounter counter (grid, tracker, min_points, pieces, sets);
  counter.count (threads);
  if (counter.allStay ())
    return 0;
  triangles.erase (std::remove_if (triangles.begin (), triangles.end (),
                                   [&] (const Triangle &t) { return !counter.stays (sets.find (t[0])); }),
                   triangles.end ());
  return static_cast<std::size_t> (
      std::count_if (pieces.begin (), pieces.end (), [&] (int piece) { return !counter.stays (piece); }));
}

} // namespace erkpa
