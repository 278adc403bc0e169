// SPDX-License-Identifier: BSD-3-Clause
#include "half_edges.h"

#include "parallel_collect.h"
#include "side_chains.h"
#include "threads.h"

#include <algorithm>
#include <utility>

namespace erkpa
{

using Triangle = std::array<int, 3>;

HalfEdges::HalfEdges (LargeVector<Triangle> &&triangles, std::size_t vertex_count, int threads)
    : triangles_ (std::move (triangles)), corners_ (triangles_.empty () ? nullptr : triangles_.front ().data ()),
      twins_ (3 * triangles_.size ()), outgoing_ (vertex_count), places_ (vertex_count, Place::INSIDE)
{
  findTwins (threads);
  findOutgoing (threads);
}

void
HalfEdges::findTwins (int threads)
{
  // The chains lie in the arrays whose own contents follow.
  const SideChains chains (triangles_, threads, outgoing_, twins_);
  parallelRanges (outgoing_.size (), threads,
                  [&] (std::size_t first, std::size_t end)
                  {
                    std::vector<int> sides;
                    for (std::size_t v = first; v < end; ++v)
                    {
                      chains.list (v, sides);
                      outgoing_[v] = -1;
                      pairSides (static_cast<int> (v), sides);
                    }
                  });
}

/** \brief Pair the sides of one vertex that run both ways. */
void
HalfEdges::pairSides (int v, const std::vector<int> &sides)
{
  for (const int side : sides)
    twins_[static_cast<std::size_t> (side)] = -1;
  for (const int side : sides)
  {
    if (start (side) != v)
      continue;
    const auto is_twin = [&, other = end (side)] (int h) { return start (h) == other && twin (h) < 0; };
    const auto found = std::find_if (sides.begin (), sides.end (), is_twin);
    if (found != sides.end ())
      pair (side, *found, false);
  }
}

void
HalfEdges::findOutgoing (int threads)
{
  const LargeVector<int> open =
      parallelCollect<LargeVector<int>> (twins_.size (), threads,
                                         [this] (std::size_t first, std::size_t last, LargeVector<int> &found)
                                         {
                                           for (std::size_t h = first; h < last; ++h)
                                             if (twins_[h] < 0)
                                               found.push_back (static_cast<int> (h));
                                         });
  for (int h = static_cast<int> (twins_.size ()) - 1; h >= 0; --h)
    setOutgoing (start (h), h);
  for (const int h : open)
  {
    Place &place = places_[static_cast<std::size_t> (start (h))];
    place = place == Place::INSIDE ? Place::BORDER : Place::TANGLED;
    setOutgoing (start (h), h);
  }
}

void
HalfEdges::pair (int h, int other, bool crease)
{
  for (const int one : {h, other})
    if (one >= 0)
    {
      twins_[static_cast<std::size_t> (one)] = one == h ? other : h;
      if (!creases_.empty ())
        creases_[static_cast<std::size_t> (one)] = crease ? 1 : 0;
    }
}

void
HalfEdges::setCrease (int h, bool crease)
{
  creases_.resize (twins_.size (), 0);
  pair (h, twin (h), crease);
}

int
HalfEdges::between (int a, int b) const
{
  int found = -1;
  around (a,
          [&] (int h)
          {
            if (end (h) == b)
              found = h;
            else if (start (previous (h)) == b)
              found = previous (h);
          });
  return found;
}

bool
HalfEdges::canCollapse (int h) const
{
  const int from = start (h), to = end (h);
  if (place (from) != Place::INSIDE || place (to) == Place::TANGLED)
    return false;
  constexpr std::size_t MOST = 64; // neighbours; more are left alone
  std::array<int, MOST> neighbors;
  std::size_t count = 0;
  visitNeighbors (to, [&] (int v) { neighbors[count < MOST ? count++ : 0] = v; });
  if (count == MOST)
    return false;
  const std::size_t around_to = count - (place (to) == Place::INSIDE ? 1 : 2); // triangles
  int around_from = 0, common = 0;
  const auto last = neighbors.begin () + static_cast<std::ptrdiff_t> (count);
  around (from,
          [&] (int side)
          {
            ++around_from;
            common += std::find (neighbors.begin () + 1, last, end (side)) != last ? 1 : 0;
          });
  return common == 2 && (around_to > 3 || around_from > 3); // the two across the edge; not a tetrahedron
}

void
HalfEdges::collapse (int h)
{
  const int from = start (h), to = end (h), back = twin (h);
  int replacement = -1; // for the half-edge that starts at the vertex which stays
  around (from, [&] (int side) { setStart (side, to); });
  for (const int gone : {h, back})
  {
    const bool forth = gone == h;
    const int of_to = forth ? next (gone) : previous (gone), of_from = forth ? previous (gone) : next (gone);
    const int outer = twin (of_to), inner = twin (of_from); // the sides that come together
    const int apex = start (previous (gone));
    if (forth)
      replacement = inner;
    if (outgoing (apex) == previous (gone))
      setOutgoing (apex, forth ? outer : inner);
    if (outgoing (to) == gone || outgoing (to) == next (gone))
      setOutgoing (to, -1);
    pair (inner, outer, onCrease (of_to) || onCrease (of_from));
  }
  if (outgoing (to) < 0)
    setOutgoing (to, replacement);
  setOutgoing (from, -1);
  for (const int gone : {h, back})
    for (const int side : {gone, next (gone), previous (gone)})
      setStart (side, -1);
}

void
HalfEdges::flip (int h)
{
  const int g = twin (h), a = start (h), b = end (h), c = start (previous (h)), d = start (previous (g));
  const std::array<int, 4> old_sides{next (h), previous (h), next (g), previous (g)};
  const std::array<int, 4> new_sides{previous (h), next (g), previous (g), next (h)};
  const std::array<int, 4> starts{b, c, a, d};
  std::array<int, 4> across{};
  std::array<bool, 4> creases{};
  for (std::size_t i = 0; i < 4; ++i)
  {
    across[i] = twin (old_sides[i]);
    creases[i] = onCrease (old_sides[i]);
  }
  setStart (h, c);
  setStart (g, d);
  for (std::size_t i = 0; i < 4; ++i)
  {
    setStart (new_sides[i], starts[i]);
    pair (new_sides[i], across[i], creases[i]);
  }
  for (std::size_t i = 0; i < 4; ++i)
  {
    const int first = outgoing (starts[i]);
    if (first == h || first == g || std::find (old_sides.begin (), old_sides.end (), first) != old_sides.end ())
      setOutgoing (starts[i], new_sides[i]);
  }
}

LargeVector<Triangle>
HalfEdges::release ()
{
  triangles_.erase (
      std::remove_if (triangles_.begin (), triangles_.end (), [] (const Triangle &t) { return t[0] < 0; }),
      triangles_.end ());
  return std::move (triangles_);
}

} // namespace erkpa
