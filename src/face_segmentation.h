// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/oriented_points.h>
#include <erkpa/point_layout.h>

#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief Two nodes close to each other whose faces do not go on into each other. */
struct Separation
{
  Eigen::Vector3f position; ///< between them: on the crease where their tangent planes meet there, local frame
  int face, other;          ///< the faces, face < other
  bool is_crease;           ///< whether the faces meet; false for the two sides of a thin wall or gap
};

/** \brief The nodes sorted into faces: patches of surface that are smooth wherever one looks closely. */
struct FaceSegmentation
{
  std::vector<int> faces; ///< face of each node; -1 for a node that fits to none of its neighbours
  int count = 0;          ///< number of faces
  std::vector<Separation> separations;
};

/** \brief What makes two neighbours belong together. */
struct SegmentationOptions
{
  double spacing = 0.0;        ///< distance between neighbouring nodes
  double angle = 0.44;         ///< largest angle between the normals of neighbours on one face, radians
  double chord = 0.0;          ///< how far noise may move two neighbours off a common smooth curve, a length
  double link_reach = 2.5;     ///< how far neighbours may be apart, in spacings
  double bridge_reach = 5.0;   ///< the same for those that agree much better, in spacings
  double separation_reach = 0; ///< how far nodes see each other across a crease or a wall, a length
  int ball = 64;               ///< nodes in which the faces around a node are told apart
  int smallest = 2;            ///< a face of fewer nodes within a ball is none
  int fewest = 2;              ///< a face of fewer nodes in all is none: noise makes such out of nothing
};

/** \brief Sort the nodes into faces.
 *
 * Neighbours are linked where their normals and positions fit to one smooth surface. In the ball around a node the
 * linked nodes make groups; two nodes of different groups are apart, and no face may hold both. Faces then grow along
 * the links, the smoothest first. Where a crease fades out, the surface around its end is thus cut into two faces
 * somewhere: there they are not apart, and count as one.
 */
FaceSegmentation
segmentFaces (const OrientedPoints &points, const PointLayout &layout, const SegmentationOptions &options, int threads);

} // namespace erkpa
