// SPDX-License-Identifier: BSD-3-Clause
#include "crease_lines.h"

#include "parallel_collect.h"
#include "threads.h"

#include <algorithm>
#include <map>

namespace erkpa
{

namespace
{

/** \brief Those of the edges that the triangles have, sorted. */
std::vector<VertexPair>
keepEdges (const std::vector<VertexPair> &edges, const LargeVector<std::array<int, 3>> &triangles,
           std::size_t vertex_count, int threads)
{
  std::vector<char> on_crease (vertex_count, 0);
  for (const VertexPair &edge : edges)
    on_crease[static_cast<std::size_t> (edge.first)] = on_crease[static_cast<std::size_t> (edge.second)] = 1;
  std::vector<VertexPair> kept = parallelCollect<std::vector<VertexPair>> (
      triangles.size (), threads,
      [&] (std::size_t first, std::size_t last, std::vector<VertexPair> &part)
      {
        for (std::size_t t = first; t < last; ++t)
          for (std::size_t i = 0; i < 3; ++i)
          {
            const int a = triangles[t][i], b = triangles[t][(i + 1) % 3];
            if (on_crease[static_cast<std::size_t> (a)] && on_crease[static_cast<std::size_t> (b)] &&
                std::binary_search (edges.begin (), edges.end (), orderedPair (a, b)))
              part.push_back (orderedPair (a, b));
          }
      });
  std::sort (kept.begin (), kept.end ());
  kept.erase (std::unique (kept.begin (), kept.end ()), kept.end ());
  return kept;
}

/** \brief Follows edges of one sharp surface from vertex to vertex. */
class LineTracer
{
public:
  LineTracer (const std::vector<VertexPair> &edges, const std::vector<int> &surfaces)
      : edges_ (edges), surfaces_ (surfaces), used_ (edges.size (), 0)
  {
    for (std::size_t e = 0; e < edges.size (); ++e)
    {
      at_[edges[e].first].push_back (e);
      at_[edges[e].second].push_back (e);
    }
  }

  std::vector<Crease>
  trace ()
  {
    for (const auto &[vertex, edges] : at_)
      if (isEnd (vertex))
        for (const std::size_t edge : edges)
          follow (vertex, edge);
    for (std::size_t e = 0; e < edges_.size (); ++e) // what is left are closed lines
      follow (edges_[e].first, e);
    return std::move (lines_);
  }

private:
  /** \brief Whether lines end at a vertex: anywhere but between two edges of the same surface. */
  bool
  isEnd (int vertex) const
  {
    const std::vector<std::size_t> &edges = at_.at (vertex);
    return edges.size () != 2 || surfaces_[edges[0]] != surfaces_[edges[1]];
  }

  void
  follow (int vertex, std::size_t edge)
  {
    if (used_[edge])
      return;
    Crease line;
    line.surface = surfaces_[edge];
    line.vertices.push_back (vertex);
    for (;;)
    {
      used_[edge] = 1;
      vertex = edges_[edge].first == vertex ? edges_[edge].second : edges_[edge].first;
      line.vertices.push_back (vertex);
      const std::vector<std::size_t> &next = at_.at (vertex);
      if (isEnd (vertex))
        break;
      edge = next[0] == edge ? next[1] : next[0];
      if (used_[edge])
        break;
    }
    lines_.push_back (std::move (line));
  }

  const std::vector<VertexPair> &edges_;
  const std::vector<int> &surfaces_;
  std::vector<char> used_;
  std::map<int, std::vector<std::size_t>> at_; // edges at each vertex
  std::vector<Crease> lines_;
};

/** \brief Tells which sharp surface creases the surface at a place. */
class SurfaceNamer
{
public:
  explicit SurfaceNamer (const ImplicitField &field)
      : local_ (field), groups_ (field.faces ()),
        has_faces_only_ (!field.options ().warp && field.enrichingSurfaces ().empty ())
  {
  }

  int
  surfaceAt (const Eigen::Vector3d &x)
  {
    if (has_faces_only_ && groups_.gather (x, 0.0))
    {
      const std::vector<const Meeting *> near = groups_.separationsAt (x);
      if (near.size () == 1) // no other can
        return near.front ()->surface;
    }
    return local_.sharpSurfaceAt (x);
  }

private:
  LocalField local_;
  FaceGroups groups_;
  bool has_faces_only_;
};

} // namespace

std::vector<Crease>
traceCreases (const ImplicitField &field, const PolygonizerOptions &options, const std::vector<VertexPair> &edges,
              const LargeVector<std::array<int, 3>> &triangles, const SurfaceVertices &vertices)
{
  if (edges.empty ())
    return {};
  const std::vector<VertexPair> kept = keepEdges (edges, triangles, vertices.positions.size (), options.threads);
  std::vector<int> surfaces (kept.size (), -1);
  parallelFor (
      kept.size (), options.threads, [&] { return SurfaceNamer (field); },
      [&] (SurfaceNamer &namer, std::size_t e)
      {
        const auto at = [&] (int v) { return vertices.positions[static_cast<std::size_t> (v)]; };
        surfaces[e] = namer.surfaceAt (0.5 * (at (kept[e].first) + at (kept[e].second)));
      });
  return LineTracer (kept, surfaces).trace ();
}

} // namespace erkpa
