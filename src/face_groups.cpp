// SPDX-License-Identifier: BSD-3-Clause
#include "face_groups.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace erkpa
{

bool
FaceGroups::gather (const Eigen::Vector3d &center, double extent)
{
  near_.clear ();
  face_of_slot_.clear ();
  listPresent (); // none before assign ()
  if (faces_ == nullptr)
    return false;
  faces_->meetingsNear (center, extent, near_);
  center_ = center;
  listMeetings ();
  return separations_ > 0;
}

/** \brief Lay what every point of the ball asks of the meetings side by side. */
void
FaceGroups::listMeetings ()
{
  for (std::vector<float> &along : places_)
    along.resize (near_.size ());
  squared_reaches_.resize (near_.size ());
  squared_.resize (near_.size ());
  pair_of_meeting_.resize (near_.size ());
  pairs_.clear ();
  separations_ = 0;
  auto pair = pairs_.begin (); // meetings of the same faces mostly follow each other
  for (std::size_t i = 0; i < near_.size (); ++i)
  {
    const Meeting &meeting = faces_->meetings ()[static_cast<std::size_t> (near_[i])];
    for (std::size_t a = 0; a < 3; ++a)
    {
      const auto axis = static_cast<Eigen::Index> (a);
      places_[a][i] = static_cast<float> (static_cast<double> (meeting.position[axis]) - center_[axis]);
    }
    squared_reaches_[i] = static_cast<float> (meeting.reach * meeting.reach);
    separations_ += meeting.surface >= 0 ? 1 : 0;
    const auto is_of_pair = [&] (const Pair &p) { return p.face == meeting.face && p.other == meeting.other; };
    if (pair == pairs_.end () || !is_of_pair (*pair))
      pair = std::find_if (pairs_.begin (), pairs_.end (), is_of_pair);
    if (pair == pairs_.end ())
      pair = pairs_.insert (pairs_.end (), {meeting.face, meeting.other, HUGE_VALF, HUGE_VALF});
    pair_of_meeting_[i] = static_cast<std::uint32_t> (pair - pairs_.begin ());
  }
}

/** \brief How far x is from the first \a count meetings, squared. */
void
FaceGroups::measureMeetings (const Eigen::Vector3d &x, std::size_t count) const
{
  const Eigen::Vector3f from = (x - center_).cast<float> ();
  const float *const px = places_[0].data (), *const py = places_[1].data (), *const pz = places_[2].data ();
  float *const squared = squared_.data ();
  for (std::size_t i = 0; i < count; ++i)
  {
    const float dx = px[i] - from[0], dy = py[i] - from[1], dz = pz[i] - from[2];
    squared[i] = dx * dx + dy * dy + dz * dz;
  }
}

bool
FaceGroups::hasSeparationAt (const Eigen::Vector3d &x) const
{
  measureMeetings (x, separations_);
  int in_reach = 0; // no way out before the end, so that several are looked at at once
  for (std::size_t i = 0; i < separations_; ++i)
    in_reach |= static_cast<int> (squared_[i] <= squared_reaches_[i]);
  return in_reach != 0;
}

void
FaceGroups::listPresent ()
{
  for (const int face : present_)
    place_of_face_[static_cast<std::size_t> (face)] = -1;
  present_.clear ();
  for (const int face : face_of_slot_)
    if (face >= 0 && std::exchange (place_of_face_[static_cast<std::size_t> (face)], 0) < 0)
      present_.push_back (face);
  std::sort (present_.begin (), present_.end ());
  for (std::size_t place = 0; place < present_.size (); ++place)
    place_of_face_[static_cast<std::size_t> (present_[place])] = static_cast<int> (place);
  place_of_slot_.resize (face_of_slot_.size ());
  for (std::size_t slot = 0; slot < face_of_slot_.size (); ++slot)
    place_of_slot_[slot] = placeOf (face_of_slot_[slot]);
}

/** \brief How near the pairs of faces meet, in reach of x; true where some are apart. */
bool
FaceGroups::findPairs (const Eigen::Vector3d &x)
{
  measureMeetings (x, near_.size ());
  for (Pair &pair : pairs_)
    pair.separate = pair.joined = HUGE_VALF;
  bool any = false;
  for (std::size_t i = 0; i < near_.size (); ++i)
  {
    if (!(squared_[i] <= squared_reaches_[i]))
      continue;
    Pair &pair = pairs_[pair_of_meeting_[i]];
    float &nearest = i < separations_ ? pair.separate : pair.joined;
    nearest = std::min (nearest, squared_[i]);
    any = any || i < separations_;
  }
  return any;
}

void
FaceGroups::uniteJoined ()
{
  representatives_ = present_;
  for (const Pair &pair : pairs_)
  {
    const int a = placeOf (pair.face), b = placeOf (pair.other);
    if (!(pair.joined < pair.separate) || a < 0 || b < 0)
      continue;
    const int from = representatives_[static_cast<std::size_t> (b)],
              to = representatives_[static_cast<std::size_t> (a)];
    std::replace (representatives_.begin (), representatives_.end (), std::max (from, to), std::min (from, to));
  }
}

int
FaceGroups::groupOf (int face) const
{
  const int place = placeOf (face);
  return place < 0 ? -1 : group_of_place_[static_cast<std::size_t> (place)];
}

std::vector<const Meeting *>
FaceGroups::separationsAt (const Eigen::Vector3d &x) const
{
  std::vector<const Meeting *> nearest;
  const auto distance = [&x] (const Meeting &meeting) { return (meeting.position.cast<double> () - x).norm (); };
  for (const int m : near_)
  {
    const Meeting &meeting = faces_->meetings ()[static_cast<std::size_t> (m)];
    if (meeting.surface < 0 || distance (meeting) > meeting.reach)
      continue;
    const auto known = std::find_if (nearest.begin (), nearest.end (),
                                     [&] (const Meeting *other) { return other->surface == meeting.surface; });
    if (known == nearest.end ())
      nearest.push_back (&meeting);
    else if (distance (meeting) < distance (**known))
      *known = &meeting;
  }
  return nearest;
}

bool
FaceGroups::keepsApart (int face, int other, const Eigen::Vector3d &x) const
{
  bool any = false;
  for (const int m : near_)
  {
    const Meeting &meeting = faces_->meetings ()[static_cast<std::size_t> (m)];
    if ((meeting.position.cast<double> () - x).squaredNorm () > meeting.reach * meeting.reach)
      continue;
    if (meeting.surface < 0)
      return false;
    any = any || (meeting.face == std::min (face, other) && meeting.other == std::max (face, other));
  }
  return any;
}

bool
FaceGroups::areOfOneFace (const std::vector<int> &slots) const
{
  return !slots.empty () && faceOfSlot (slots.front ()) >= 0 &&
         std::all_of (slots.begin (), slots.end (),
                      [&] (int slot) { return faceOfSlot (slot) == faceOfSlot (slots.front ()); });
}

/** \brief Make the groups that have nodes in reach. */
void
FaceGroups::countNodes (const std::vector<int> &near)
{
  nodes_of_place_.assign (present_.size () + 1, 0);
  for (const int place : near)
    ++nodes_of_place_[static_cast<std::size_t> (place) + 1]; // -1 wraps around to 0
  groups_.clear ();
  for (std::size_t place = 0; place < present_.size (); ++place)
  {
    if (nodes_of_place_[place + 1] == 0)
      continue;
    const int representative = representatives_[place];
    auto group = std::find_if (groups_.begin (), groups_.end (),
                               [&] (const Group &g) { return g.representative == representative; });
    if (group == groups_.end ())
      group = groups_.insert (groups_.end (), {representative, 0});
    group->nodes += nodes_of_place_[place + 1];
  }
}

bool
FaceGroups::select (const Eigen::Vector3d &x, const std::vector<int> &near)
{
  if (near_.empty () || !findPairs (x))
    return false;
  uniteJoined ();
  countNodes (near);
  if (groups_.size () < 2)
    return false;
  std::sort (groups_.begin (), groups_.end (),
             [] (const Group &a, const Group &b)
             { return a.nodes != b.nodes ? a.nodes > b.nodes : a.representative < b.representative; });
  group_of_place_.assign (present_.size (), -1);
  for (std::size_t place = 0; place < present_.size (); ++place)
    for (std::size_t g = 0; g < groups_.size (); ++g)
      if (groups_[g].representative == representatives_[place])
        group_of_place_[place] = static_cast<int> (g);
  return true;
}

const std::vector<int> &
FaceGroups::groupsOfSlots ()
{
  group_of_slot_.resize (face_of_slot_.size ());
  for (std::size_t slot = 0; slot < face_of_slot_.size (); ++slot)
    group_of_slot_[slot] = groupOfSlot (static_cast<int> (slot));
  return group_of_slot_;
}

std::uint64_t
FaceGroups::facesOf (int group) const
{
  std::uint64_t faces = 0;
  for (std::size_t place = 0; place < group_of_place_.size (); ++place)
    if (group_of_place_[place] == group)
      faces |= std::uint64_t (1) << place;
  return faces;
}

} // namespace erkpa
