// SPDX-License-Identifier: BSD-3-Clause
#include "face_normals.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace erkpa::tool
{

FaceNormals::FaceNormals (const std::vector<Eigen::Vector3d> &positions) : positions_ (positions) {}

void
FaceNormals::add (const std::vector<std::size_t> &polygon)
{
  sums_.resize (positions_.size (), Eigen::Vector3d::Zero ());
  std::vector<std::size_t> ring;
  for (const std::size_t vertex : polygon)
    if (vertex < positions_.size () && positions_[vertex].allFinite ())
      ring.push_back (vertex);
  Eigen::Vector3d area = Eigen::Vector3d::Zero ();
  for (std::size_t i = 2; i < ring.size (); ++i)
    area += (positions_[ring[i - 1]] - positions_[ring[0]]).cross (positions_[ring[i]] - positions_[ring[0]]);
  for (std::size_t i = 0; i < ring.size (); ++i)
  {
    sums_[ring[i]] += area;
    edges_.emplace_back (ring[i], ring[(i + 1) % ring.size ()]);
  }
}

std::vector<Eigen::Vector3d>
FaceNormals::normals () const
{
  auto edges = edges_;
  std::sort (edges.begin (), edges.end ());
  std::size_t disagreeing = 0;
  for (std::size_t i = 1; i < edges.size (); ++i)
    disagreeing += edges[i] == edges[i - 1] ? 1 : 0;
  constexpr std::size_t TOLERATED = 50; // one edge in so many
  if (disagreeing * TOLERATED > edges.size ())
    return {};
  std::vector<Eigen::Vector3d> normals = sums_;
  for (Eigen::Vector3d &normal : normals)
    normal = normal.norm () > 0.0 ? Eigen::Vector3d (normal.normalized ()) : Eigen::Vector3d::Zero ();
  return normals;
}

} // namespace erkpa::tool
