// SPDX-License-Identifier: BSD-3-Clause
#include "face_map.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace erkpa
{

namespace
{

NeighborSearch::ConstPtr
searchOf (const std::vector<Meeting> &meetings)
{
  if (meetings.empty ())
    return nullptr;
  std::vector<Eigen::Vector3f> positions;
  positions.reserve (meetings.size ());
  for (const Meeting &meeting : meetings)
    positions.push_back (meeting.position);
  return makeKdTreeSearch (positions);
}

} // namespace

FaceMap::FaceMap (const OrientedPoints &points, const NeighborSearch &search, std::vector<int> faces,
                  std::vector<Meeting> separations, double spacing)
    : faces_ (std::move (faces)), meetings_ (std::move (separations)), search_ (searchOf (meetings_))
{
  for (const Meeting &meeting : meetings_)
    largest_reach_ = std::max (largest_reach_, meeting.reach);
  findJoints (points, search, spacing);
  search_ = searchOf (meetings_);
}

/** \brief Neighbours on two faces that nothing keeps apart where they are join the faces. */
void
FaceMap::findJoints (const OrientedPoints &points, const NeighborSearch &search, double spacing)
{
  constexpr double NEIGHBORS = 1.6;     // spacings
  constexpr float LEAST_COSINE = 0.87f; // 30 degrees
  std::vector<int> found, near;
  std::vector<float> squared;
  std::vector<Meeting> joints;
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    if (faces_[i] < 0)
      continue;
    search.withinRadius (points.positions[i], NEIGHBORS * spacing, found, squared);
    std::sort (found.begin (), found.end ());
    for (const int j : found)
    {
      const int face = faces_[i], other = faces_[static_cast<std::size_t> (j)];
      const float turn = points.normals[i].dot (points.normals[static_cast<std::size_t> (j)]);
      if (j <= static_cast<int> (i) || other < 0 || face == other)
        continue;
      if (turn < LEAST_COSINE)
        continue;
      const Eigen::Vector3f middle = 0.5f * (points.positions[i] + points.positions[static_cast<std::size_t> (j)]);
      meetingsNear (middle.cast<double> (), 0.0, near);
      const auto keeps_apart = [&] (int m)
      {
        const Meeting &meeting = meetings_[static_cast<std::size_t> (m)];
        return meeting.face == std::min (face, other) && meeting.other == std::max (face, other) &&
               (meeting.position - middle).norm () < NEIGHBORS * spacing;
      };
      if (std::none_of (near.begin (), near.end (), keeps_apart))
        joints.push_back ({middle, std::min (face, other), std::max (face, other), -1, 0.0});
    }
  }
  // A joint holds as far as the separations do: around the end of a crease the nearer of them decides.
  for (Meeting &joint : joints)
    joint.reach = largest_reach_;
  meetings_.insert (meetings_.end (), joints.begin (), joints.end ());
}

void
FaceMap::meetingsNear (const Eigen::Vector3d &center, double extent, std::vector<int> &near) const
{
  near.clear ();
  if (!search_)
    return;
  std::vector<float> squared;
  search_->withinRadius (center.cast<float> (), extent + largest_reach_, near, squared);
  std::sort (near.begin (), near.end ());
}

} // namespace erkpa
