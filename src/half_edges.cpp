// SPDX-License-Identifier: BSD-3-Clause
#include "half_edges.h"

#include <algorithm>

namespace erkpa
{

using Triangle = std::array<int, 3>;

HalfEdges::HalfEdges (const std::vector<Triangle> &triangles, std::size_t vertex_count)
    : twins_ (3 * triangles.size (), -1), creases_ (3 * triangles.size (), 0), outgoing_ (vertex_count, -1),
      places_ (vertex_count, Place::INSIDE), marks_ (vertex_count, 0)
{
  starts_.reserve (3 * triangles.size ());
  for (const Triangle &t : triangles)
    starts_.insert (starts_.end (), t.begin (), t.end ());
  findTwins ();
  for (int h = 0; h < static_cast<int> (twins_.size ()); ++h)
  {
    const int v = start (h);
    Place &place = places_[static_cast<std::size_t> (v)];
    if (twin (h) < 0)
    {
      place = place == Place::INSIDE ? Place::BORDER : Place::TANGLED;
      outgoing (v) = h;
    }
    else if (outgoing (v) < 0)
      outgoing (v) = h;
  }
}

void
HalfEdges::findTwins ()
{
  struct Side
  {
    int end, h;
  };
  std::vector<int> firsts (outgoing_.size () + 1, 0);
  std::vector<Side> sides (starts_.size ()); // by where they start
  for (const int v : starts_)
    ++firsts[static_cast<std::size_t> (v)];
  int sum = 0;
  for (int &first : firsts)
    first = sum += first;
  for (int h = static_cast<int> (starts_.size ()) - 1; h >= 0; --h)
    sides[static_cast<std::size_t> (--firsts[static_cast<std::size_t> (start (h))])] = {end (h), h};
  for (std::size_t v = 0; v < outgoing_.size (); ++v)
    for (int i = firsts[v]; i < firsts[v + 1]; ++i)
    {
      const Side &side = sides[static_cast<std::size_t> (i)];
      if (side.end < static_cast<int> (v))
        continue; // found from there
      const auto other = sides.begin () + firsts[static_cast<std::size_t> (side.end)],
                 last = sides.begin () + firsts[static_cast<std::size_t> (side.end) + 1];
      const auto found = std::find_if (other, last, [v] (const Side &one) { return one.end == static_cast<int> (v); });
      if (found == last)
        continue;
      pair (side.h, found->h, false);
      found->end = -1; // taken
    }
}

void
HalfEdges::pair (int h, int other, bool crease)
{
  for (const int one : {h, other})
    if (one >= 0)
    {
      twins_[static_cast<std::size_t> (one)] = one == h ? other : h;
      creases_[static_cast<std::size_t> (one)] = crease ? 1 : 0;
    }
}

void
HalfEdges::setCrease (int h, bool crease)
{
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
HalfEdges::canCollapse (int h)
{
  const int from = start (h), to = end (h);
  if (place (from) != Place::INSIDE || place (to) == Place::TANGLED)
    return false;
  ++mark_;
  int around_to = 0, around_from = 0, common = 0;
  around (to,
          [&] (int side)
          {
            ++around_to;
            marks_[static_cast<std::size_t> (end (side))] = mark_;
            marks_[static_cast<std::size_t> (start (previous (side)))] = mark_;
          });
  around (from,
          [&] (int side)
          {
            ++around_from;
            common += marks_[static_cast<std::size_t> (end (side))] == mark_ ? 1 : 0;
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
      outgoing (apex) = forth ? outer : inner;
    if (outgoing (to) == gone || outgoing (to) == next (gone))
      outgoing (to) = -1;
    pair (inner, outer, onCrease (of_to) || onCrease (of_from));
  }
  if (outgoing (to) < 0)
    outgoing (to) = replacement;
  outgoing (from) = -1;
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
    int &first = outgoing (starts[i]);
    if (first == h || first == g || std::find (old_sides.begin (), old_sides.end (), first) != old_sides.end ())
      first = new_sides[i];
  }
}

void
HalfEdges::collect (std::vector<Triangle> &triangles) const
{
  triangles.clear ();
  for (int h = 0; h < static_cast<int> (starts_.size ()); h += 3)
    if (isAlive (h))
      triangles.push_back ({start (h), start (h + 1), start (h + 2)});
}

} // namespace erkpa
