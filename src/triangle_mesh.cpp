// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/triangle_mesh.h>

#include "mesh_graph.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace erkpa
{

std::vector<MeshEdge>
collectEdges (const std::vector<std::array<int, 3>> &triangles)
{
  std::vector<std::uint64_t> keys;
  keys.reserve (3 * triangles.size ());
  for (const auto &t : triangles)
    for (std::size_t i = 0; i < 3; ++i)
    {
      const auto [low, high] = std::minmax (t[i], t[(i + 1) % 3]);
      keys.push_back (static_cast<std::uint64_t> (low) << 32 | static_cast<std::uint32_t> (high));
    }
  std::sort (keys.begin (), keys.end ());
  std::vector<MeshEdge> edges;
  for (std::size_t i = 0; i < keys.size ();)
  {
    std::size_t end = i + 1;
    while (end < keys.size () && keys[end] == keys[i])
      ++end;
    edges.push_back (
        {static_cast<int> (keys[i] >> 32), static_cast<int> (keys[i] & 0xffffffffu), static_cast<int> (end - i)});
    i = end;
  }
  return edges;
}

std::vector<MeshEdge>
boundaryEdges (const std::vector<std::array<int, 3>> &triangles)
{
  std::vector<MeshEdge> edges = collectEdges (triangles);
  edges.erase (std::remove_if (edges.begin (), edges.end (), [] (const MeshEdge &e) { return e.triangles != 1; }),
               edges.end ());
  return edges;
}

MeshTopology
measureTopology (const TriangleMesh &mesh)
{
  MeshTopology topology;
  DisjointSets pieces (mesh.vertices.size ());
  const std::vector<MeshEdge> edges = collectEdges (mesh.triangles);
  for (const MeshEdge &edge : edges)
  {
    topology.boundary_edges += edge.triangles == 1 ? 1 : 0;
    topology.non_manifold_edges += edge.triangles > 2 ? 1 : 0;
    pieces.unite (edge.low, edge.high);
  }
  for (int v = 0; v < static_cast<int> (mesh.vertices.size ()); ++v)
    topology.components += pieces.find (v) == v ? 1 : 0;
  topology.euler = static_cast<long> (mesh.vertices.size ()) - static_cast<long> (edges.size ()) +
                   static_cast<long> (mesh.triangles.size ());
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
