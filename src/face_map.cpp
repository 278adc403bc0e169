// SPDX-License-Identifier: BSD-3-Clause
#include "face_map.h"

#include <erkpa/face_of_points.h>

#include "found_nodes.h"
#include "node_table.h"
#include "parallel_collect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

namespace erkpa
{

namespace
{

NeighborSearch::ConstPtr
searchOf (const std::vector<Meeting> &meetings, int threads)
{
  if (meetings.empty ())
    return nullptr;
  std::vector<Eigen::Vector3f> positions;
  positions.reserve (meetings.size ());
  for (const Meeting &meeting : meetings)
    positions.push_back (meeting.position);
  return makeGridSearch (positions, threads);
}

/** \brief The places where faces are apart, in the local frame: of those that lie much closer together than each of
 * them reaches, one. In thin walls every pair of nodes makes one, and they are looked through point by point. */
std::vector<Eigen::Vector3f>
thinOut (const ExtentParts &extent, const Eigen::Vector3d &origin)
{
  constexpr double CELL = 0.1; // of the reach
  std::set<std::array<double, 3>> cells;
  std::vector<Eigen::Vector3f> kept;
  for (const Eigen::Vector3d &place : extent.points)
  {
    const Eigen::Vector3d local = place - origin, cell = (local / (CELL * extent.length)).array ().floor ();
    if (cells.insert ({cell[0], cell[1], cell[2]}).second)
      kept.push_back (local.cast<float> ());
  }
  return kept;
}

Eigen::Vector3f
middleOf (const OrientedPoints &points, int node, int other)
{
  return 0.5f *
         (points.positions[static_cast<std::size_t> (node)] + points.positions[static_cast<std::size_t> (other)]);
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
FaceMap::make (const OrientedPoints &points, const PointGrid &grid, const std::vector<SharpSurface::ConstPtr> &surfaces,
               double spacing, int threads)
{
  const std::shared_ptr<FaceMap> map (new FaceMap);
  map->addSurfaces (points, surfaces);
  if (map->meetings_.empty ())
    return nullptr;
  map->assignNodes (points, spacing, threads);
  map->search_ = searchOf (map->meetings_, threads);
  map->findJoints (points, grid, spacing, threads);
  map->search_ = searchOf (map->meetings_, threads);
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
    for (const Eigen::Vector3f &place : thinOut (parts, points.origin))
      meetings_.push_back ({place, std::min (a, b), std::max (a, b), static_cast<int> (s), parts.length});
    largest_reach_ = std::max (largest_reach_, parts.length);
  }
}

/** \brief A node is of the face of the nearest point that looks its way. */
void
FaceMap::assignNodes (const OrientedPoints &points, double spacing, int threads)
{
  constexpr double SAME = 0.01, NEAR = 2.0; // spacings: faces mostly are made of the very nodes
  constexpr float LEAST_COSINE = 0.7f;      // 45 degrees
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
  const NeighborSearch::ConstPtr search = makeGridSearch (positions, threads);
  faces_.assign (points.size (), -1);
  const auto face_within = [&] (double reach, FoundNodes &found, std::size_t i)
  {
    search->withinRadius (points.positions[i], reach, found.nodes, found.squared);
    std::pair<float, int> nearest{HUGE_VALF, -1};
    for (std::size_t c = 0; c < found.nodes.size (); ++c)
    {
      const auto candidate = static_cast<std::size_t> (found.nodes[c]);
      if (points.normals[i].dot (normals[candidate]) > LEAST_COSINE)
        nearest = std::min (nearest, {found.squared[c], owners[candidate]});
    }
    return nearest.second;
  };
  parallelFor (
      points.size (), threads, [] { return FoundNodes (); },
      [&] (FoundNodes &found, std::size_t i)
      {
        const int face = face_within (SAME * spacing, found, i);
        faces_[i] = face >= 0 ? face : face_within (NEAR * spacing, found, i);
      });
}

/** \brief Neighbours on two faces that nothing keeps apart where they are join the faces. */
void
FaceMap::findJoints (const OrientedPoints &points, const PointGrid &grid, double spacing, int threads)
{
  constexpr std::size_t STRETCH = 1024; // places
  auto joints = parallelCollect<std::vector<Joint>> (
      points.size (), threads,
      [&] (std::size_t first, std::size_t last, std::vector<Joint> &found)
      {
        NearbyNodes near (points, grid);
        near.visitRuns (first, last,
                        [&] (std::size_t from, std::size_t to) { addJoints (points, spacing, from, to, near, found); });
      },
      STRETCH);
  std::sort (joints.begin (), joints.end (),
             [] (const Joint &a, const Joint &b) { return std::tie (a.node, a.other) < std::tie (b.node, b.other); });
  // A joint holds as far as the separations do: around the end of a crease the nearer of them decides.
  for (const Joint &joint : joints)
    meetings_.push_back ({joint.middle, std::min (faceOf (joint.node), faceOf (joint.other)),
                          std::max (faceOf (joint.node), faceOf (joint.other)), -1, largest_reach_});
}

/** \brief Those of the nodes of a run. */
void
FaceMap::addJoints (const OrientedPoints &points, double spacing, std::size_t first, std::size_t last,
                    NearbyNodes &near, std::vector<Joint> &joints) const
{
  constexpr double NEIGHBORS = 4.0; // spacings
  near.gather (first, last, NEIGHBORS * spacing);
  std::vector<std::pair<int, int>> nodes; // with their faces
  for (std::size_t n = 0; n < near.size (); ++n)
    if (const int face = faceOf (near.node (n)); face >= 0)
      nodes.emplace_back (near.node (n), face);
  const auto is_first = [&nodes] (const auto &node) { return node.second == nodes.front ().second; };
  if (std::all_of (nodes.begin (), nodes.end (), is_first)) // inside a face, as most are
    return;
  std::vector<int> meetings;
  for (std::size_t place = first; place < last; ++place)
  {
    const int node = near.nodeAt (place), face = faceOf (node);
    for (const auto &[other, of_other] : nodes)
      if (face >= 0 && of_other != face && other > node &&
          areJoined (points, node, other, NEIGHBORS * spacing, meetings))
        joints.push_back ({node, other, middleOf (points, node, other)});
  }
}

/** \brief Whether nodes of two faces are neighbours on one surface where nothing keeps the faces apart. */
bool
FaceMap::areJoined (const OrientedPoints &points, int i, int j, double reach, std::vector<int> &meetings) const
{
  constexpr float BEND = 0.1f;          // of the distance: a larger step is that between two sheets
  constexpr float LEAST_COSINE = 0.87f; // 30 degrees
  const auto one = static_cast<std::size_t> (i), two = static_cast<std::size_t> (j);
  const Eigen::Vector3f way = points.positions[two] - points.positions[one];
  const Eigen::Vector3f &normal = points.normals[one], &other = points.normals[two];
  if (way.squaredNorm () > static_cast<float> (reach * reach) || normal.dot (other) < LEAST_COSINE ||
      0.5f * std::abs (way.dot (normal + other)) > BEND * way.norm ())
    return false;
  const Eigen::Vector3f middle = middleOf (points, i, j);
  meetingsNear (middle.cast<double> (), 0.0, meetings);
  return std::none_of (meetings.begin (), meetings.end (),
                       [&] (int m)
                       {
                         const Meeting &meeting = meetings_[static_cast<std::size_t> (m)];
                         return meeting.face == std::min (faceOf (i), faceOf (j)) &&
                                meeting.other == std::max (faceOf (i), faceOf (j)) &&
                                (meeting.position - middle).norm () < reach;
                       });
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
