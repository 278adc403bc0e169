// SPDX-License-Identifier: BSD-3-Clause
#include "side_chains.h"

#include "threads.h"

#include <algorithm>
#include <utility>

namespace erkpa
{

namespace
{

using Triangle = std::array<int, 3>;

/** \brief Calls visit (smaller vertex, side) for the sides of some vertices, the last first. */
template <typename VisitT>
void
visitSides (const LargeVector<Triangle> &triangles, int first_vertex, int end_vertex, VisitT visit)
{
  const auto count = static_cast<unsigned> (end_vertex - first_vertex);
  for (std::size_t t = triangles.size (); t-- > 0;)
  {
    const Triangle &triangle = triangles[t];
    const std::array<int, 3> lows{std::min (triangle[0], triangle[1]), std::min (triangle[1], triangle[2]),
                                  std::min (triangle[2], triangle[0])};
    for (std::size_t i = 3; i-- > 0;)
      if (static_cast<unsigned> (lows[i] - first_vertex) < count)
        visit (static_cast<std::size_t> (lows[i]), 3 * t + i);
  }
}

} // namespace

SideChains::SideChains (const LargeVector<Triangle> &triangles, int threads, LargeVector<int> &heads,
                        LargeVector<int> &nexts)
    : heads_ (heads), nexts_ (nexts)
{
  // Each thread looks at all triangles for the sides of its own vertices.
  const std::size_t parts = std::min<std::size_t> (static_cast<std::size_t> (threadCount (threads)), 64);
  const auto first_of = [&] (std::size_t part) { return part * heads.size () / parts; };
  parallelFor (
      parts, threads, [] { return 0; },
      [&] (int, std::size_t part)
      {
        const std::size_t first = first_of (part), end = first_of (part + 1);
        std::fill_n (heads.begin () + static_cast<std::ptrdiff_t> (first), end - first, -1);
        visitSides (triangles, static_cast<int> (first), static_cast<int> (end),
                    [&] (std::size_t low, std::size_t side)
                    { nexts[side] = std::exchange (heads[low], static_cast<int> (side)); });
      });
}

} // namespace erkpa
