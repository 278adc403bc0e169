// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/status.h>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief The nodes of the field: distinct points of a surface with unit outward normals.
 *
 * Positions are relative to \a origin (the middle of the cloud), so that clouds far from the origin of their
 * frame (UTM coordinates) keep their precision in float.
 */
struct OrientedPoints
{
  Eigen::Vector3d origin = Eigen::Vector3d::Zero (); ///< position of the local frame in the input's frame
  std::vector<Eigen::Vector3f> positions;            ///< in the local frame, input's unit of length
  std::vector<Eigen::Vector3f> normals;              ///< unit length, pointing out of the solid; zero where unknown
  int channels = 0;              ///< number of attributes of a point (3 for colour, 1 for intensity)
  std::vector<float> attributes; ///< channels values per point, point after point

  // What a node may have of its own (Δx_i, size and shape of its support); empty where all are alike.
  std::vector<float> confidences;      ///< weight of the node beside the kernel, the paper's Δx_i (eq. 13), positive
  std::vector<float> radii;            ///< support radius of the node, input's unit of length, positive
  std::vector<Eigen::Matrix3f> shapes; ///< S: the support is |S (x - x_i)| < radius; no singular value below 1

  std::size_t
  size () const
  {
    return positions.size ();
  }
};

/** \brief A cloud as its owner stores it: strided floats, nothing copied. */
struct PointView
{
  std::size_t size = 0;                      ///< number of points
  std::size_t stride = 0;                    ///< bytes from one point to the next
  const float *position = nullptr;           ///< x of the first point; y and z follow
  const float *normal = nullptr;             ///< normal_x of the first point, or null where the cloud has none
  int channels = 0;                          ///< attributes per point
  std::vector<float> attributes;             ///< channels values per point, point after point
  std::vector<float> confidences;            ///< a value per point, or empty: OrientedPoints::confidences
  std::vector<float> radii;                  ///< a value per point, or empty: OrientedPoints::radii
  std::vector<Eigen::Matrix3f> shapes;       ///< a matrix per point, or empty: OrientedPoints::shapes
  const std::vector<int> *indices = nullptr; ///< points to use, or null for all
};

/** \brief What became of the points of a cloud. */
struct PointCounts
{
  std::size_t read = 0;           ///< points looked at (the indices' number where indices are given)
  std::size_t used = 0;           ///< nodes of the field
  std::size_t not_finite = 0;     ///< dropped: a coordinate is NaN or infinite
  std::size_t duplicate = 0;      ///< dropped: an earlier point has the same coordinates
  std::size_t no_confidence = 0;  ///< dropped: a confidence is given, and it is zero or less or not finite
  std::size_t without_normal = 0; ///< used, but their normal was missing, zero or NaN
};

/** \brief Gather the finite, distinct points of a cloud in a frame of their own.
 *
 * Normals are scaled to unit length; a missing one is left zero and counted. Of points with the same
 * coordinates the first stays.
 * \param[in] view the cloud; its indices must be within it (else Status::BAD_INDICES), what is given per point must be
 * given for each, radii must be positive, and shapes must keep their rule (else Status::INVALID_SETTING)
 * \param[out] points the nodes, in the order of the cloud
 * \param[out] counts what was kept and what was dropped
 * \param[in] threads 0 = all processors; the nodes do not depend on it
 */
Outcome
collectPoints (const PointView &view, OrientedPoints &points, PointCounts &counts, int threads = 0);

} // namespace erkpa
