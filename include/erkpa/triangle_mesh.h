// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/large_pages.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief A line of mesh edges along which a surface is sharp, from a corner or its end to the next. */
struct Crease
{
  int surface = -1;          ///< the sharp surface that cuts it: its place in the field's sharp surfaces
  std::vector<int> vertices; ///< in order; the first is the last again where the line is closed
};

/** \brief Triangles over shared vertices, counter-clockwise seen from outside. */
struct TriangleMesh
{
  LargeVector<Eigen::Vector3f> vertices;     ///< positions
  LargeVector<Eigen::Vector3f> normals;      ///< unit normals ∇f/|∇f|, one per vertex
  LargeVector<std::array<int, 3>> triangles; ///< indices of vertices
  int channels = 0;                          ///< attributes per vertex
  LargeVector<float> attributes;             ///< channels values per vertex, blended from the nodes
  std::vector<Crease> creases;               ///< the mesh edges that run along creases, as lines

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

/** \brief Counts edges, borders and pieces of a mesh.
 * \param[in] threads 0 = all processors
 */
MeshTopology
measureTopology (const TriangleMesh &mesh, int threads = 0);

/** \brief The vertices in which more than two creases meet, sorted. */
std::vector<int>
findCorners (const std::vector<Crease> &creases);

/** \brief Gives each smooth side of a crease vertex a vertex of its own, with the normal of that side.
 *
 * For those who shade by the vertices' normals. The mesh is then cut open along its creases; the lines of the creases
 * run along one of their sides.
 */
void
splitNormals (TriangleMesh &mesh);

/** \brief Removes the vertices no triangle uses; the others keep their order. */
void
removeUnusedVertices (TriangleMesh &mesh);

} // namespace erkpa
