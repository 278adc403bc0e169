// SPDX-License-Identifier: BSD-3-Clause
#include "border.h"

#include "mesh_graph.h"
#include "parallel_collect.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

namespace erkpa
{

namespace
{

using Triangle = std::array<int, 3>;

/** \brief The places of the triangles that have a marked vertex. */
LargeVector<std::size_t>
findTouching (const std::vector<char> &marks, int threads, const LargeVector<Triangle> &triangles)
{
  const auto is_marked = [&marks] (int v) { return marks[static_cast<std::size_t> (v)] != 0; };
  return parallelCollect<LargeVector<std::size_t>> (
      triangles.size (), threads,
      [&] (std::size_t first, std::size_t last, LargeVector<std::size_t> &found)
      {
        for (std::size_t i = first; i < last; ++i)
          if (std::any_of (triangles[i].begin (), triangles[i].end (), is_marked))
            found.push_back (i);
      });
}

/** \brief The vertices to cut away: beyond the limit, and connected to the border through such vertices. */
std::vector<char>
findBeyondBorder (double limit, int threads, const LargeVector<int> &border, const LargeVector<Triangle> &triangles,
                  const LargeVector<double> &offsets)
{
  std::vector<char> beyond (offsets.size (), 0);
  parallelRanges (offsets.size (), threads,
                  [&] (std::size_t first, std::size_t last)
                  {
                    for (std::size_t v = first; v < last; ++v)
                      beyond[v] = offsets[v] <= limit ? 0 : 1;
                  });
  const auto is_beyond = [&beyond] (int v) { return beyond[static_cast<std::size_t> (v)] != 0; };
  if (std::none_of (border.begin (), border.end (), is_beyond))
    return {};
  DisjointSets regions (offsets.size ());
  for (const std::size_t index : findTouching (beyond, threads, triangles))
    for (std::size_t i = 0; i < 3; ++i)
    {
      const int a = triangles[index][i], b = triangles[index][(i + 1) % 3];
      if (is_beyond (a) && is_beyond (b))
        regions.unite (a, b);
    }
  std::vector<char> is_open (offsets.size (), 0);
  for (const int v : border)
    if (is_beyond (v))
      is_open[static_cast<std::size_t> (regions.find (v))] = 1;
  for (std::size_t v = 0; v < offsets.size (); ++v)
    beyond[v] = beyond[v] && is_open[static_cast<std::size_t> (regions.find (static_cast<int> (v)))];
  return beyond;
}

/** \brief Clips triangles along the line where the border offset has the limit. */
class Clipper
{
public:
  Clipper (double limit, const std::vector<char> &beyond, SurfaceVertices &vertices)
      : limit_ (limit), beyond_ (beyond), vertices_ (vertices)
  {
  }

  void
  clip (const Triangle &triangle, LargeVector<Triangle> &kept)
  {
    std::array<int, 4> polygon{};
    std::size_t size = 0;
    for (std::size_t i = 0; i < 3; ++i)
    {
      const int here = triangle[i], next = triangle[(i + 1) % 3];
      if (!isBeyond (here))
        polygon[size++] = here;
      if (isBeyond (here) != isBeyond (next))
        polygon[size++] = isBeyond (here) ? vertexBetween (next, here) : vertexBetween (here, next);
    }
    if (size == 3)
      kept.push_back ({polygon[0], polygon[1], polygon[2]});
    if (size != 4)
      return;
    if (length (polygon[0], polygon[2]) <= length (polygon[1], polygon[3]))
      kept.insert (kept.end (), {{polygon[0], polygon[1], polygon[2]}, {polygon[0], polygon[2], polygon[3]}});
    else
      kept.insert (kept.end (), {{polygon[1], polygon[2], polygon[3]}, {polygon[1], polygon[3], polygon[0]}});
  }

private:
  bool
  isBeyond (int v) const
  {
    return static_cast<std::size_t> (v) < beyond_.size () && beyond_[static_cast<std::size_t> (v)] != 0;
  }

  const Eigen::Vector3d &
  position (int v) const
  {
    return vertices_.positions[static_cast<std::size_t> (v)];
  }

  double
  length (int a, int b) const
  {
    return (position (a) - position (b)).squaredNorm ();
  }

  int
  vertexBetween (int inner, int outer)
  {
    const auto key = static_cast<std::uint64_t> (inner) << 32 | static_cast<std::uint32_t> (outer);
    const auto [entry, is_new] = made_.try_emplace (key, static_cast<int> (vertices_.positions.size ()));
    if (is_new)
    {
      const double room = limit_ - vertices_.border_offsets[static_cast<std::size_t> (inner)];
      const double span = vertices_.border_offsets[static_cast<std::size_t> (outer)] -
                          vertices_.border_offsets[static_cast<std::size_t> (inner)];
      const double t = std::clamp (span > 0.0 ? room / span : 0.5, 0.05, 0.95); // no slivers
      const Eigen::Vector3d p = (1.0 - t) * position (inner) + t * position (outer);
      vertices_.positions.push_back (p);
    }
    return entry->second;
  }

  double limit_;
  const std::vector<char> &beyond_;
  SurfaceVertices &vertices_;
  std::unordered_map<std::uint64_t, int> made_;
};

} // namespace

void
trimBorder (double limit, int threads, LargeVector<int> &border, LargeVector<Triangle> &triangles,
            SurfaceVertices &vertices)
{
  if (border.empty ())
    return;
  const std::vector<char> beyond = findBeyondBorder (limit, threads, border, triangles, vertices.border_offsets);
  if (beyond.empty ())
    return;
  const std::size_t first_new = vertices.positions.size ();
  const LargeVector<std::size_t> touching = findTouching (beyond, threads, triangles);
  Clipper clipper (limit, beyond, vertices);
  LargeVector<Triangle> clipped;
  for (const std::size_t index : touching)
    clipper.clip (triangles[index], clipped);
  std::size_t kept = touching.front ();
  for (std::size_t t = 0; t < touching.size (); ++t)
  {
    const std::size_t end = t + 1 < touching.size () ? touching[t + 1] : triangles.size ();
    for (std::size_t i = touching[t] + 1; i < end; ++i)
      triangles[kept++] = triangles[i];
  }
  triangles.resize (kept);
  triangles.insert (triangles.end (), clipped.begin (), clipped.end ());
  border.erase (std::remove_if (border.begin (), border.end (),
                                [&beyond] (int v) { return beyond[static_cast<std::size_t> (v)] != 0; }),
                border.end ());
  for (std::size_t v = first_new; v < vertices.positions.size (); ++v)
    border.push_back (static_cast<int> (v));
}

void
splitFans (const LargeVector<int> &border, int threads, LargeVector<Triangle> &triangles, SurfaceVertices &vertices)
{
  if (border.empty ())
    return;
  std::vector<char> on_border (vertices.positions.size (), 0);
  for (const int v : border)
    on_border[static_cast<std::size_t> (v)] = 1;
  const auto is_on_border = [&on_border] (int v) { return on_border[static_cast<std::size_t> (v)] != 0; };
  std::vector<Triangle *> touching;
  for (const std::size_t index : findTouching (on_border, threads, triangles))
    touching.push_back (&triangles[index]);

  // Corners of triangles that share an edge belong to one fan at either end of it.
  DisjointSets fans (3 * touching.size ());
  std::unordered_map<std::uint64_t, int> corner_of_edge; // by the edge's direction, the corner at its start
  const auto key = [] (int start, int end)
  { return static_cast<std::uint64_t> (start) << 32 | static_cast<std::uint32_t> (end); };
  for (std::size_t corner = 0; corner < 3 * touching.size (); ++corner)
  {
    const Triangle &t = *touching[corner / 3];
    const int start = t[corner % 3], end = t[(corner + 1) % 3], here = static_cast<int> (corner);
    const auto following = [] (int c) { return c % 3 == 2 ? c - 2 : c + 1; };
    corner_of_edge.emplace (key (start, end), here);
    const auto twin = corner_of_edge.find (key (end, start));
    if (twin == corner_of_edge.end ())
      continue;
    fans.unite (following (here), twin->second);
    fans.unite (here, following (twin->second));
  }
  std::unordered_map<int, int> first_fans, copies; // vertex -> the fan that keeps it, other fan -> its own vertex
  for (std::size_t corner = 0; corner < 3 * touching.size (); ++corner)
  {
    int &vertex = (*touching[corner / 3])[corner % 3];
    const int fan = fans.find (static_cast<int> (corner));
    if (!is_on_border (vertex) || first_fans.try_emplace (vertex, fan).first->second == fan)
      continue;
    const auto [copy, is_new] = copies.try_emplace (fan, static_cast<int> (vertices.positions.size ()));
    if (is_new)
    {
      vertices.append (static_cast<std::size_t> (vertex));
      on_border.push_back (0); // done
    }
    vertex = copy->second;
  }
}

} // namespace erkpa
