// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief Triangles over shared vertices, counter-clockwise seen from outside. */
struct TriangleMesh
{
  std::vector<Eigen::Vector3f> vertices;     ///< positions
  std::vector<Eigen::Vector3f> normals;      ///< unit normals ∇f/|∇f|, one per vertex
  std::vector<std::array<int, 3>> triangles; ///< indices of vertices
  int channels = 0;                          ///< attributes per vertex
  std::vector<float> attributes;             ///< channels values per vertex, blended from the nodes

  void
  clear ()
  {
    *this = TriangleMesh ();
  }
};

/** \brief What the edges of a mesh say about its shape. */
struct MeshTopology
{
  std::size_t boundary_edges = 0;     ///< edges of one triangle only; 0 for a closed mesh
  std::size_t non_manifold_edges = 0; ///< edges of more than two triangles
  std::size_t components = 0;         ///< connected pieces
  long euler = 0;                     ///< vertices - edges + triangles
};

/** \brief Counts edges, borders and pieces of a mesh. */
MeshTopology
measureTopology (const TriangleMesh &mesh);

/** \brief Removes the vertices no triangle uses; the others keep their order. */
void
removeUnusedVertices (TriangleMesh &mesh);

} // namespace erkpa
