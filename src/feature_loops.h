// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cell_mesher.h"
#include "local_field.h"

#include <erkpa/marching_cubes.h>

#include <utility>
#include <vector>

namespace erkpa
{

/** \brief An edge of the mesh by its vertices, the smaller first. */
using VertexPair = std::pair<int, int>;

inline VertexPair
orderedPair (int a, int b)
{
  return a < b ? VertexPair (a, b) : VertexPair (b, a);
}

/** \brief The crease or corner inside a loop. */
struct MeshedLoop
{
  std::vector<VertexPair> crossings; ///< neighbouring vertices of the loop between which a crease runs
  bool has_center = false;           ///< whether there is a vertex on the crease: then the rest holds
  Eigen::Vector3d position = Eigen::Vector3d::Zero (), normal = Eigen::Vector3d::Zero ();
  double border_offset = 0.0;
  int face = -1;
  std::vector<float> attributes;
};

/** \brief Look for creases in the loops that hold vertices of several faces, and put a vertex on each.
 *
 * Where two neighbouring vertices of a loop lie on faces whose pieces of f turn against each other, a crease runs
 * between them. The vertex inside solves f_a = 0, f_b = 0, ... for the pieces of f on all those faces: it is on the
 * crease, or on the corner where there are more than two. (Kobbelt et al. 2001 guess it from normals: here it starts
 * from that guess.)
 * \param[in] voxel side of a grid cell
 * \param[in] has_border whether the surface has one: only then border offsets are found
 */
std::vector<MeshedLoop>
meshLoops (const ImplicitField &field, const PolygonizerOptions &options, const LargeVector<CellLoop> &loops,
           double voxel, bool has_border, const SurfaceVertices &vertices, PolygonizerReport &report);

} // namespace erkpa
