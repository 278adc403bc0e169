// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/triangle_mesh.h>

#include "concurrent_sets.h"
#include "mesh_graph.h"
#include "side_chains.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief Counts the edges of some vertices, each at its smaller vertex, and joins the pieces they connect. */
class EdgeCounter
{
public:
  EdgeCounter (const LargeVector<std::array<int, 3>> &triangles, const SideChains &sides, ConcurrentSets &pieces)
      : triangles_ (triangles), sides_ (sides), pieces_ (pieces)
  {
  }

  void
  count (std::size_t v)
  {
    sides_.list (v, others_);
    for (int &side : others_)
      side = otherEnd (static_cast<std::size_t> (side), static_cast<int> (v));
    std::sort (others_.begin (), others_.end ());
    for (std::size_t i = 0, end = 0; i < others_.size (); i = end)
    {
      while (end < others_.size () && others_[end] == others_[i])
        ++end;
      ++edges;
      boundary_edges += end - i == 1 ? 1 : 0;
      non_manifold_edges += end - i > 2 ? 1 : 0;
      pieces_.unite (static_cast<int> (v), others_[i]);
    }
  }

  std::size_t edges = 0, boundary_edges = 0, non_manifold_edges = 0;

private:
  int
  otherEnd (std::size_t side, int v) const
  {
    const std::array<int, 3> &triangle = triangles_[side / 3];
    const int start = triangle[side % 3];
    return start != v ? start : triangle[(side + 1) % 3];
  }

  const LargeVector<std::array<int, 3>> &triangles_;
  const SideChains &sides_;
  ConcurrentSets &pieces_;
  std::vector<int> others_; // other ends of the edges of the vertex at hand
};

} // namespace

MeshTopology
measureTopology (const TriangleMesh &mesh, int threads)
{
  const std::size_t vertices = mesh.vertices.size ();
  LargeVector<int> heads (vertices), nexts (3 * mesh.triangles.size ());
  const SideChains sides (mesh.triangles, threads, heads, nexts);
  ConcurrentSets pieces (vertices, threads);
  MeshTopology topology;
  std::size_t edges = 0;
  constexpr std::size_t STRETCH = 4096;
  parallelFor ((vertices + STRETCH - 1) / STRETCH, threads, [&] { return EdgeCounter (mesh.triangles, sides, pieces); },
               [&] (EdgeCounter &counter, std::size_t i)
               {
                 for (std::size_t v = i * STRETCH; v < std::min (vertices, (i + 1) * STRETCH); ++v)
                   counter.count (v);
               },
               [&] (const EdgeCounter &counter)
               {
                 edges += counter.edges;
                 topology.boundary_edges += counter.boundary_edges;
                 topology.non_manifold_edges += counter.non_manifold_edges;
               });
  for (int v = 0; v < static_cast<int> (vertices); ++v)
    topology.components += pieces.find (v) == v ? 1 : 0;
  topology.euler =
      static_cast<long> (vertices) - static_cast<long> (edges) + static_cast<long> (mesh.triangles.size ());
  return topology;
}

void
removeUnusedVertices (TriangleMesh &mesh)
{
  std::vector<int> renumbered (mesh.vertices.size (), -1);
  for (const auto &triangle : mesh.triangles)
    for (const int v : triangle)
      renumbered[static_cast<std::size_t> (v)] = 0;
  std::size_t kept = 0;
  const auto channels = static_cast<std::size_t> (mesh.channels);
  for (std::size_t v = 0; v < renumbered.size (); ++v)
  {
    if (renumbered[v] < 0)
      continue;
    renumbered[v] = static_cast<int> (kept);
    mesh.vertices[kept] = mesh.vertices[v];
    mesh.normals[kept] = mesh.normals[v];
    for (std::size_t c = 0; c < channels; ++c)
      mesh.attributes[kept * channels + c] = mesh.attributes[v * channels + c];
    ++kept;
  }
  mesh.vertices.resize (kept);
  mesh.normals.resize (kept);
  mesh.attributes.resize (kept * channels);
  for (auto &triangle : mesh.triangles)
    for (int &v : triangle)
      v = renumbered[static_cast<std::size_t> (v)];
  for (Crease &crease : mesh.creases)
    for (int &v : crease.vertices)
      v = renumbered[static_cast<std::size_t> (v)];
}

std::vector<int>
findCorners (const std::vector<Crease> &creases)
{
  std::map<int, int> ends;
  for (const Crease &crease : creases)
    for (const int v : {crease.vertices.front (), crease.vertices.back ()})
      ++ends[v];
  std::vector<int> corners;
  for (const auto &[vertex, count] : ends)
    if (count > 2)
      corners.push_back (vertex);
  return corners;
}

namespace
{

using Edge = std::pair<int, int>;

/** \brief Corners of triangles that go on into each other around a vertex without crossing a crease. */
DisjointSets
findSides (const TriangleMesh &mesh)
{
  std::set<Edge> creases;
  for (const Crease &crease : mesh.creases)
    for (std::size_t i = 0; i + 1 < crease.vertices.size (); ++i)
      creases.emplace (std::minmax (crease.vertices[i], crease.vertices[i + 1]));
  DisjointSets sides (3 * mesh.triangles.size ());
  std::map<Edge, int> starts; // the triangle corner at the start of a directed edge, of edges at crease vertices
  std::vector<char> on_crease (mesh.vertices.size (), 0);
  for (const Edge &edge : creases)
    on_crease[static_cast<std::size_t> (edge.first)] = on_crease[static_cast<std::size_t> (edge.second)] = 1;
  const auto corner_after = [] (int corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; };
  for (int corner = 0; corner < 3 * static_cast<int> (mesh.triangles.size ()); ++corner)
  {
    const auto &triangle = mesh.triangles[static_cast<std::size_t> (corner / 3)];
    const int a = triangle[static_cast<std::size_t> (corner % 3)];
    const int b = triangle[static_cast<std::size_t> ((corner + 1) % 3)];
    if ((!on_crease[static_cast<std::size_t> (a)] && !on_crease[static_cast<std::size_t> (b)]) ||
        creases.count (std::minmax (a, b)) > 0)
      continue;
    starts[{a, b}] = corner;
    const auto twin = starts.find ({b, a});
    if (twin == starts.end ())
      continue;
    sides.unite (corner_after (corner), twin->second);
    sides.unite (corner, corner_after (twin->second));
  }
  return sides;
}

} // namespace

void
splitNormals (TriangleMesh &mesh)
{
  if (mesh.creases.empty ())
    return;
  DisjointSets sides = findSides (mesh);
  std::vector<char> on_crease (mesh.vertices.size (), 0);
  for (const Crease &crease : mesh.creases)
    for (const int v : crease.vertices)
      on_crease[static_cast<std::size_t> (v)] = 1;
  const auto channels = static_cast<std::size_t> (mesh.channels);
  std::map<std::pair<int, int>, int> vertex_of_side; // by vertex and side
  std::vector<char> is_taken (mesh.vertices.size (), 0);
  std::map<int, Eigen::Vector3f> areas;
  for (std::size_t corner = 0; corner < 3 * mesh.triangles.size (); ++corner)
  {
    auto &triangle = mesh.triangles[corner / 3];
    const std::array<int, 3> old = triangle;
    int &vertex = triangle[corner % 3];
    if (static_cast<std::size_t> (vertex) >= on_crease.size () || !on_crease[static_cast<std::size_t> (vertex)])
      continue;
    const auto v = static_cast<std::size_t> (vertex);
    const auto [entry, is_new] = vertex_of_side.try_emplace ({vertex, sides.find (static_cast<int> (corner))}, vertex);
    if (is_new && is_taken[v])
    {
      entry->second = static_cast<int> (mesh.vertices.size ());
      mesh.vertices.push_back (Eigen::Vector3f (mesh.vertices[v]));
      mesh.normals.push_back (Eigen::Vector3f (mesh.normals[v]));
      for (std::size_t c = 0; c < channels; ++c)
        mesh.attributes.push_back (float (mesh.attributes[v * channels + c]));
    }
    is_taken[v] = 1;
    vertex = entry->second;
    const auto at = [&] (std::size_t i) { return mesh.vertices[static_cast<std::size_t> (old[i])]; };
    auto &area = areas.try_emplace (vertex, Eigen::Vector3f::Zero ()).first->second;
    area += (at (1) - at (0)).cross (at (2) - at (0));
  }
  for (const auto &[vertex, area] : areas)
    if (area.norm () > 0.0f)
      mesh.normals[static_cast<std::size_t> (vertex)] = area.normalized ();
}

} // namespace erkpa
