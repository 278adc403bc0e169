// SPDX-License-Identifier: BSD-3-Clause
#include "face_map.h"

#include <erkpa/face_of_points.h>

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

bool
separatesFaces (const SharpSurface &surface)
{
  SharpSurface::ConstPtr face, other;
  Extent::ConstPtr extent;
  return facesBehind (surface, face, other, extent) && pointsBehind (*face) != nullptr &&
         pointsBehind (*other) != nullptr && extent && extent->parts ().kind == ExtentParts::Kind::POINTS;
}

std::shared_ptr<const FaceMap>
FaceMap::make (const OrientedPoints &points, const NeighborSearch &search,
               const std::vector<SharpSurface::ConstPtr> &surfaces, double spacing)
{
  const std::shared_ptr<FaceMap> map (new FaceMap);
  map->addSurfaces (points, surfaces);
  if (map->meetings_.empty ())
    return nullptr;
  map->assignNodes (points, spacing);
  map->search_ = searchOf (map->meetings_);
  map->findJoints (points, search, spacing);
  map->search_ = searchOf (map->meetings_);
  return map;
}

void
FaceMap::addSurfaces (const OrientedPoints &points, const std::vector<SharpSurface::ConstPtr> &surfaces)
{
  const auto number = [this] (const SharpSurface::ConstPtr &face)
  {
    const auto known = std::find (known_faces_.begin (), known_faces_.end (), face);
    const auto place = static_cast<int> (known - known_faces_.begin ());
    if (known == known_faces_.end ())
      known_faces_.push_back (face);
    return place;
  };
  for (std::size_t s = 0; s < surfaces.size (); ++s)
  {
    SharpSurface::ConstPtr face, other;
    Extent::ConstPtr extent;
    if (!separatesFaces (*surfaces[s]) || !facesBehind (*surfaces[s], face, other, extent))
      continue;
    const int a = number (face), b = number (other);
    const ExtentParts parts = extent->parts ();
    for (const Eigen::Vector3d &place : parts.points)
      meetings_.push_back ({(place - points.origin).cast<float> (), std::min (a, b), std::max (a, b),
                            static_cast<int> (s), parts.length});
    largest_reach_ = std::max (largest_reach_, parts.length);
  }
}

/** \brief A node is of the face of the nearest point that looks its way. */
void
FaceMap::assignNodes (const OrientedPoints &points, double spacing)
{
  constexpr int CANDIDATES = 6;
  constexpr double NEAR = 2.0;         // spacings
  constexpr float LEAST_COSINE = 0.7f; // 45 degrees
  std::vector<Eigen::Vector3f> positions, normals;
  std::vector<int> owners;
  for (std::size_t f = 0; f < known_faces_.size (); ++f)
  {
    const FacePoints &face = *pointsBehind (*known_faces_[f]);
    const Eigen::Vector3d shift = face.origin - points.origin;
    for (const Eigen::Vector3f &p : face.positions)
      positions.emplace_back ((p.cast<double> () + shift).cast<float> ());
    normals.insert (normals.end (), face.normals.begin (), face.normals.end ());
    owners.resize (positions.size (), static_cast<int> (f));
  }
  const NeighborSearch::ConstPtr search = makeKdTreeSearch (positions);
  std::vector<int> found;
  std::vector<float> squared;
  faces_.assign (points.size (), -1);
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    search->nearestK (points.positions[i], CANDIDATES, found, squared);
    double nearest = NEAR * spacing;
    for (std::size_t c = 0; c < found.size (); ++c)
    {
      const auto candidate = static_cast<std::size_t> (found[c]);
      const double distance = std::sqrt (static_cast<double> (squared[c]));
      if (distance < nearest && points.normals[i].dot (normals[candidate]) > LEAST_COSINE)
      {
        nearest = distance;
        faces_[i] = owners[candidate];
      }
    }
  }
}

/** \brief Neighbours on two faces that nothing keeps apart where they are join the faces. */
void
FaceMap::findJoints (const OrientedPoints &points, const NeighborSearch &search, double spacing)
{
  constexpr double NEIGHBORS = 4.0;     // spacings
  constexpr float BEND = 0.1f;          // of the distance: a larger step is that between two sheets
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
      const Eigen::Vector3f way = points.positions[static_cast<std::size_t> (j)] - points.positions[i];
      const float step = 0.5f * std::abs (way.dot (points.normals[i] + points.normals[static_cast<std::size_t> (j)]));
      if (turn < LEAST_COSINE || step > BEND * way.norm ())
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
