// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/triangle_mesh.h>

#include "mesh_graph.h"

#include <algorithm>
#include <cstdint>

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
}

} // namespace erkpa
