// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/implicit_field.h>
#include <erkpa/progress.h>
#include <erkpa/triangle_mesh.h>

#include <cstddef>

namespace erkpa
{

/** \brief Settings of the polygonizer. */
struct PolygonizerOptions
{
  double voxel_size = 0.0;        ///< side of a grid cell in the cloud's unit; 0 = from resolution or spacing
  int resolution = 0;             ///< cells along the longest side of the cloud; 0 = from the spacing of the points
  double iso_level = 0.0;         ///< the surface is f = iso_level, in the cloud's unit; positive is outside
  double voxel_per_feature = 0.7; ///< the default voxel, in ImplicitField::featureSize ()
  double reach = 0.9;            ///< no surface where fewer than a quarter of the support's nodes lie within this share
                                 ///< of its radius
  double border_offset = 0.45;   ///< an open surface ends where the nodes' centroid lies this share of the support
                                 ///< radius aside (about 0.27 on the border of evenly spread points)
  int min_component_points = 10; ///< a piece of surface that passes fewer points than this is dropped
  double moment_tolerance = 0.01; ///< where supports of a constant radius hold hundreds of nodes, moments are summed up
                                  ///< at points of a lattice and interpolated: weights of nodes are off by at most this
                                  ///< share of the largest, and vertices from the field that is
                                  ///< evaluated elsewhere by some thousandths of a voxel; in [0, 1), 0 = every sum is
                                  ///< over the nodes
  bool split_normals = false;     ///< crease vertices are doubled, with the normal of each side: see splitNormals ()
  int threads = 0;                ///< 0 = all processors
};

/** \brief What the polygonizer did. */
struct PolygonizerReport
{
  double voxel_size = 0.0;            ///< side of a grid cell in use
  std::size_t evaluations = 0;        ///< evaluations of the field
  std::size_t moment_sums = 0;        ///< sums over nodes that evaluations were interpolated from
  std::size_t support_nodes = 0;      ///< nodes in the supports of all evaluations together
  std::size_t dropped_components = 0; ///< pieces no data supported
  double seconds_grid = 0.0;          ///< following the surface through the grid
  double seconds_vertices = 0.0;      ///< placing vertices on it
  double seconds_triangles = 0.0;     ///< joining them within each cell; borders and pieces without support cut off
  double seconds_creases = 0.0;       ///< vertices and edges on creases, and the lines along them
  double seconds_slivers = 0.0;       ///< removing narrow triangles
};

/** \brief The side of the grid cells these options give for a field. */
double
chooseVoxelSize (const ImplicitField &field, const PolygonizerOptions &options);

/** \brief Marching cubes along the surface f = iso_level of a field.
 *
 * Starts at the cells of the nodes and follows the surface, so that cost goes with the area and no component
 * appears that no node supports. Closed where the nodes close it; elsewhere the border follows the nodes'.
 * The mesh is the same for any number of threads.
 * \param[in] field the field
 * \param[in] options settings; a value that makes no sense gives Status::INVALID_SETTING
 * \param[out] mesh vertices in the input's frame; empty on error
 * \param[out] report what was done
 * \param[in] progress may be empty
 */
Outcome
polygonize (const ImplicitField &field, const PolygonizerOptions &options, TriangleMesh &mesh,
            PolygonizerReport &report, const ProgressCallback &progress = {});

} // namespace erkpa
