// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "block_field.h"
#include "local_field.h"
#include "sparse_grid.h"

#include <erkpa/large_pages.h>
#include <erkpa/marching_cubes.h>

#include <cstdint>
#include <vector>

namespace erkpa
{

/** \brief The vertices of a surface in the making, in the local frame. */
struct SurfaceVertices
{
  LargeVector<Eigen::Vector3d> positions;
  LargeVector<Eigen::Vector3d> normals; ///< unit, ∇f/|∇f|
  LargeVector<double> border_offsets;   ///< see LocalSample::border_offset
  bool has_sides = false;               ///< whether there are sharp surfaces, and the next two are used
  LargeVector<int> faces;               ///< face whose piece of f the vertex is on; -1 where there are none
  LargeVector<std::uint64_t> side_keys; ///< see LocalField::sideKey ()
  LargeVector<float> attributes;        ///< channels values per vertex
  LargeVector<Eigen::Vector3d> found;   ///< of those on edges of the grid, where; thin walls move them from there

  /** \brief Values of attributes per vertex. */
  std::size_t
  channels () const
  {
    return positions.empty () ? 0 : attributes.size () / positions.size ();
  }

  void
  resize (std::size_t size, int channels)
  {
    positions.resize (size);
    normals.resize (size);
    border_offsets.resize (size, 0.0);
    faces.resize (has_sides ? size : 0, -1);
    side_keys.resize (has_sides ? size : 0, 0);
    attributes.resize (size * static_cast<std::size_t> (channels), 0.0f);
  }

  /** \brief Make room for \a size vertices, so that appending does not move the others. */
  void
  reserve (std::size_t size, int channels)
  {
    positions.reserve (size);
    normals.reserve (size);
    border_offsets.reserve (size);
    faces.reserve (has_sides ? size : 0);
    side_keys.reserve (has_sides ? size : 0);
    attributes.reserve (size * static_cast<std::size_t> (channels));
  }

  /** \brief Append a copy of a vertex. */
  void
  append (std::size_t vertex)
  {
    const std::size_t channels = this->channels ();
    for (std::size_t c = 0; c < channels; ++c)
      attributes.push_back (attributes[vertex * channels + c]);
    const Eigen::Vector3d position = positions[vertex], normal = normals[vertex];
    positions.push_back (position);
    normals.push_back (normal);
    border_offsets.push_back (border_offsets[vertex]);
    if (!has_sides)
      return;
    faces.push_back (faces[vertex]);
    side_keys.push_back (side_keys[vertex]);
  }
};

/** \brief The side of all creases that a vertex is on. */
inline Side
sideOf (const SurfaceVertices &vertices, std::size_t vertex)
{
  return {vertices.faces[vertex], vertices.positions[vertex]};
}

/** \brief Put a vertex on every cut edge of the grid, on f = iso.
 *
 * The root on each edge is found by safeguarded Newton steps from the linear guess.
 * \param[in] lattice see BlockField
 * \param[in,out] grid cut edges marked; vertices get numbered
 */
void
placeVertices (const ImplicitField &field, const PolygonizerOptions &options, const MomentLattice *lattice,
               SparseGrid &grid, SurfaceVertices &vertices, PolygonizerReport &report,
               const ProgressCallback &progress);

/** \brief Keep a vertex's place, and what the field says there: normal, border offset, sides and attributes. */
void
storeVertex (const LocalField &local, const LocalSample &sample, const Eigen::Vector3d &position, std::size_t vertex,
             SurfaceVertices &vertices);

/** \param[in] point of the block, with gradients */
void
storeVertex (const BlockField &field, std::size_t point, const Eigen::Vector3d &position, std::size_t vertex,
             SurfaceVertices &vertices);

} // namespace erkpa
