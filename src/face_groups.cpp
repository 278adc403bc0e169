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
  if (faces_ == nullptr)
    return false;
  faces_->meetingsNear (center, extent, near_);
  return std::any_of (near_.begin (), near_.end (),
                      [this] (int m) { return faces_->meetings ()[static_cast<std::size_t> (m)].surface >= 0; });
}

bool
FaceGroups::hasSeparationAt (const Eigen::Vector3d &x) const
{
  return std::any_of (near_.begin (), near_.end (),
                      [&] (int m)
                      {
                        const Meeting &meeting = faces_->meetings ()[static_cast<std::size_t> (m)];
                        const double reach = meeting.reach;
                        return meeting.surface >= 0 &&
                               (meeting.position.cast<double> () - x).squaredNorm () <= reach * reach;
                      });
}

void
FaceGroups::assign (const Support &support)
{
  face_of_slot_.clear ();
  if (faces_ == nullptr)
    return;
  for (const ValuePoint &point : support.points ())
    face_of_slot_.push_back (faces_->faceOf (point.node));
  present_ = face_of_slot_;
  std::sort (present_.begin (), present_.end ());
  present_.erase (std::unique (present_.begin (), present_.end ()), present_.end ());
  if (!present_.empty () && present_.front () < 0)
    present_.erase (present_.begin ());
  place_of_slot_.clear ();
  for (const int face : face_of_slot_)
    place_of_slot_.push_back (placeOf (face));
}

/** \brief The pairs of faces that meet in reach of x; true where some are apart. */
bool
FaceGroups::findPairs (const Eigen::Vector3d &x)
{
  pairs_.clear ();
  bool any = false;
  for (const int m : near_)
  {
    const Meeting &meeting = faces_->meetings ()[static_cast<std::size_t> (m)];
    const double distance = (meeting.position.cast<double> () - x).norm ();
    if (distance > meeting.reach)
      continue;
    auto pair = std::find_if (pairs_.begin (), pairs_.end (),
                              [&] (const Pair &p) { return p.face == meeting.face && p.other == meeting.other; });
    if (pair == pairs_.end ())
      pair = pairs_.insert (pairs_.end (), {meeting.face, meeting.other, HUGE_VAL, HUGE_VAL});
    double &nearest = meeting.surface >= 0 ? pair->separate : pair->joined;
    nearest = std::min (nearest, distance);
    any = any || meeting.surface >= 0;
  }
  return any;
}

int
FaceGroups::placeOf (int face) const
{
  const auto place = std::lower_bound (present_.begin (), present_.end (), face);
  return place != present_.end () && *place == face ? static_cast<int> (place - present_.begin ()) : -1;
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

/** \brief Make the groups that have nodes in reach. */
void
FaceGroups::countNodes (const Support &support)
{
  const double reach = REACH * support.radius ();
  for (std::size_t slot = 0; slot < face_of_slot_.size (); ++slot)
  {
    const int place = place_of_slot_[slot];
    if (place < 0 || support.squaredDistance (slot) > reach * reach)
      continue;
    const int representative = representatives_[static_cast<std::size_t> (place)];
    auto group = std::find_if (groups_.begin (), groups_.end (),
                               [&] (const Group &g) { return g.representative == representative; });
    if (group == groups_.end ())
    {
      if (spare_.empty ())
        spare_.emplace_back ();
      groups_.push_back (std::move (spare_.back ()));
      spare_.pop_back ();
      group = groups_.end () - 1;
      group->representative = representative;
      group->nodes = 0;
    }
    ++group->nodes;
  }
}

bool
FaceGroups::select (const Support &support, const Eigen::Vector3d &x)
{
  for (Group &group : groups_)
    spare_.push_back (std::move (group));
  groups_.clear ();
  if (near_.empty () || !findPairs (x))
    return false;
  uniteJoined ();
  countNodes (support);
  if (groups_.size () < 2)
    return false;
  std::stable_sort (groups_.begin (), groups_.end (),
                    [] (const Group &a, const Group &b) { return a.nodes > b.nodes; });
  group_of_place_.assign (present_.size (), -1);
  for (std::size_t place = 0; place < present_.size (); ++place)
    for (std::size_t g = 0; g < groups_.size (); ++g)
      if (groups_[g].representative == representatives_[place])
        group_of_place_[place] = static_cast<int> (g);
  for (Group &group : groups_)
    group.members.assign (face_of_slot_.size (), 0);
  for (std::size_t slot = 0; slot < face_of_slot_.size (); ++slot)
  {
    const int group = groupOfSlot (static_cast<int> (slot));
    if (group >= 0)
      groups_[static_cast<std::size_t> (group)].members[slot] = 1;
  }
  return true;
}

} // namespace erkpa
