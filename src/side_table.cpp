// SPDX-License-Identifier: BSD-3-Clause
#include "side_table.h"

#include "threads.h"

#include <algorithm>

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
        visit (static_cast<std::size_t> (lows[i]), static_cast<int> (3 * t + i));
  }
}

} // namespace

SideTable::SideTable (const LargeVector<Triangle> &triangles, std::size_t vertex_count, int threads)
    : firsts_ (vertex_count + 1, 0), sides_ (3 * triangles.size ())
{
  // Each thread looks at all triangles for the sides of its own vertices.
  const std::size_t parts = std::min<std::size_t> (static_cast<std::size_t> (threadCount (threads)), 64);
  const auto in_parts = [&] (auto visit)
  {
    parallelFor (
        parts, threads, [] { return 0; },
        [&] (int, std::size_t part)
        {
          visitSides (triangles, static_cast<int> (part * vertex_count / parts),
                      static_cast<int> ((part + 1) * vertex_count / parts), visit);
        });
  };
  in_parts ([this] (std::size_t low, int) { ++firsts_[low]; });
  int sum = 0;
  for (int &first : firsts_)
    first = sum += first;
  in_parts ([this] (std::size_t low, int side) { sides_[static_cast<std::size_t> (--firsts_[low])] = side; });
}

} // namespace erkpa
