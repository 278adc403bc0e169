// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "face_map.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace erkpa
{

/** \brief The faces around an evaluation point that sharp surfaces keep apart there, as groups of gathered nodes.
 *
 * Faces that go on into each other make one group.
 */
class FaceGroups
{
public:
  /** \param[in] faces null where the field has none */
  explicit FaceGroups (const FaceMap *faces)
      : faces_ (faces), place_of_face_ (faces != nullptr ? faces->count () : 0, -1)
  {
  }

  /** \brief Prepare for points within \a extent of \a center; false where no faces are apart near them. */
  bool
  gather (const Eigen::Vector3d &center, double extent);

  /** \brief Take up the value points that were gathered.
   * \param[in] count of them
   * \param[in] node_of the node of each, by slot
   */
  template <typename NodeOfT>
  void
  assign (std::size_t count, NodeOfT node_of)
  {
    face_of_slot_.resize (faces_ != nullptr ? count : 0);
    for (std::size_t slot = 0; slot < face_of_slot_.size (); ++slot)
      face_of_slot_[slot] = faces_->faceOf (node_of (slot));
    listPresent ();
  }

  /** \brief Whether faces are kept apart in reach of \a x, which is in the ball that was gathered for. */
  bool
  hasSeparationAt (const Eigen::Vector3d &x) const;

  /** \brief Whether faces meet somewhere near the ball. */
  bool
  hasMeetings () const
  {
    return !near_.empty ();
  }

  /** \brief Which of the faces present a gathered value point is on; -1 for none. */
  int
  placeOfSlot (int slot) const
  {
    return place_of_slot_[static_cast<std::size_t> (slot)];
  }

  /** \brief Group the nodes as seen from \a x; false where there are no two groups around it.
   * \param[in] near placeOfSlot () of the value points within REACH of x
   */
  bool
  select (const Eigen::Vector3d &x, const std::vector<int> &near);

  /** \brief How far from x the nodes of groups count, in support radii: thin samples of narrow faces shall not be
   * missed. */
  static constexpr double REACH = 1.5;

  /** \brief Support radii: where all nodes within are of one face, no other face counts. The rim, on which the k-th
   * node lies, is well inside. */
  static constexpr double CLOSE = 1.01;

  /** \brief Whether some gathered value points, at least one, are all of the same face. */
  bool
  areOfOneFace (const std::vector<int> &slots) const;

  /** \brief Number of faces among the gathered value points. */
  std::size_t
  present () const
  {
    return present_.size ();
  }

  /** \brief Groups with nodes in reach, the largest number of nodes first; 2 or more. */
  int
  count () const
  {
    return static_cast<int> (groups_.size ());
  }

  /** \brief Per gathered value point its group; -1 for none. */
  const std::vector<int> &
  groupsOfSlots ();

  /** \brief The faces of a group as a number that says which of those present they are, 64 at most. */
  std::uint64_t
  facesOf (int group) const;

  /** \brief For every sharp surface in reach of \a x the place where it keeps faces apart that is nearest. */
  std::vector<const Meeting *>
  separationsAt (const Eigen::Vector3d &x) const;

  /** \brief Whether two faces are kept apart at \a x, and no faces are joined there. */
  bool
  keepsApart (int face, int other, const Eigen::Vector3d &x) const;

  /** \brief The group that a face is of; -1 where it is of none. */
  int
  groupOf (int face) const;

  /** \brief The group of a face that is present; -1 for none. */
  int
  groupOfPlace (std::size_t place) const
  {
    return group_of_place_[place];
  }

  /** \brief The group of a gathered value point; -1 for none. */
  int
  groupOfSlot (int slot) const
  {
    const int place = placeOfSlot (slot);
    return place < 0 ? -1 : groupOfPlace (static_cast<std::size_t> (place));
  }

  /** \brief Face of a gathered value point; -1 for none. */
  int
  faceOfSlot (int slot) const
  {
    return face_of_slot_[static_cast<std::size_t> (slot)];
  }

private:
  struct Pair
  {
    int face, other;
    float separate, joined; // squared distances from x
  };

  struct Group
  {
    int representative;
    int nodes; // around x
  };

  void
  listMeetings ();

  void
  measureMeetings (const Eigen::Vector3d &x, std::size_t count) const;

  void
  listPresent ();

  bool
  findPairs (const Eigen::Vector3d &x);

  void
  uniteJoined ();

  void
  countNodes (const std::vector<int> &near);

  /** \brief In present_, -1 where it is not there. */
  int
  placeOf (int face) const
  {
    return face < 0 ? -1 : place_of_face_[static_cast<std::size_t> (face)];
  }

  const FaceMap *faces_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  std::vector<int> near_;                    // meetings, those first that keep faces apart: ...
  std::size_t separations_ = 0;              // ... so many
  std::array<std::vector<float>, 3> places_; // of the meetings, from the center
  std::vector<float> squared_reaches_;
  mutable std::vector<float> squared_; // their squared distances from the point at hand
  std::vector<std::uint32_t> pair_of_meeting_;
  std::vector<int> face_of_slot_;
  std::vector<int> present_;         // faces of the gathered value points, sorted
  std::vector<int> place_of_face_;   // in present_, -1 for none; of all faces
  std::vector<int> place_of_slot_;   // the same
  std::vector<int> representatives_; // of present_
  std::vector<int> group_of_place_;  // of present_
  std::vector<int> nodes_of_place_;  // around x: of none, and then of present_
  std::vector<Pair> pairs_;          // of faces that meet near the ball
  std::vector<Group> groups_;
  std::vector<int> group_of_slot_;
};

} // namespace erkpa
