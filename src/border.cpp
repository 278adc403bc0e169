// SPDX-License-Identifier: BSD-3-Clause
#include "border.h"

#include "mesh_graph.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

namespace erkpa
{

namespace
{

using Triangle = std::array<int, 3>;

/** \brief The vertices to cut away: beyond the limit, and connected to an open edge through such vertices. */
std::vector<char>
findBeyondBorder (double limit, const std::vector<Triangle> &triangles, const std::vector<double> &offsets)
{
  std::vector<char> beyond (offsets.size ());
  bool any = false;
  for (std::size_t v = 0; v < offsets.size (); ++v)
  {
    beyond[v] = offsets[v] <= limit ? 0 : 1;
    any = any || beyond[v];
  }
  if (!any)
    return {};
  DisjointSets regions (offsets.size ());
  const auto is_beyond = [&beyond] (int v) { return beyond[static_cast<std::size_t> (v)] != 0; };
  for (const Triangle &t : triangles)
    for (int i = 0; i < 3; ++i)
      if (is_beyond (t[static_cast<std::size_t> (i)]) && is_beyond (t[static_cast<std::size_t> ((i + 1) % 3)]))
        regions.unite (t[static_cast<std::size_t> (i)], t[static_cast<std::size_t> ((i + 1) % 3)]);
  std::vector<char> is_open (offsets.size (), 0);
  for (const MeshEdge &edge : boundaryEdges (triangles))
    for (const int v : {edge.low, edge.high})
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
  clip (const Triangle &triangle, std::vector<Triangle> &kept)
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
trimBorder (double limit, std::vector<Triangle> &triangles, SurfaceVertices &vertices)
{
  const std::vector<char> beyond = findBeyondBorder (limit, triangles, vertices.border_offsets);
  if (beyond.empty ())
    return;
  Clipper clipper (limit, beyond, vertices);
  std::vector<Triangle> kept;
  kept.reserve (triangles.size ());
  for (const Triangle &triangle : triangles)
    clipper.clip (triangle, kept);
  triangles.swap (kept);
}

void
splitFans (std::vector<Triangle> &triangles, SurfaceVertices &vertices)
{
  std::vector<char> on_border (vertices.positions.size (), 0);
  for (const MeshEdge &edge : boundaryEdges (triangles))
    on_border[static_cast<std::size_t> (edge.low)] = on_border[static_cast<std::size_t> (edge.high)] = 1;
  const auto is_on_border = [&on_border] (int v) { return on_border[static_cast<std::size_t> (v)] != 0; };
  std::vector<Triangle *> touching;
  for (Triangle &t : triangles)
    if (std::any_of (t.begin (), t.end (), is_on_border))
      touching.push_back (&t);

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
