// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "face_tree.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief The nodes around an evaluation point say how the faces there combine to one surface. */
class FaceVote
{
public:
  /** \brief A node that has a say. */
  struct Voter
  {
    int slot;          ///< among the gathered value points
    Eigen::Vector3d u; ///< (x_i - x) / ε
    double weight;
  };

  /** \brief Beyond its border a face goes on for a while, and might meet another one there: whether x is so far out.
   * \param[in] nearest distance of the nearest node
   * \param[in] radius ε
   * \param[in] aside LocalField::aside ()
   */
  static bool
  isBeyondBorder (double nearest, double radius, double aside)
  {
    constexpr double FAR_ASIDE = 0.65; // support radii
    return mayBeBeyondBorder (nearest, radius) && aside > FAR_ASIDE;
  }

  /** \brief The same, where nothing is known of the other nodes. */
  static bool
  mayBeBeyondBorder (double nearest, double radius)
  {
    constexpr double APART = 0.5; // support radii
    return nearest > APART * radius;
  }

  /** \brief Whether nothing is to be voted on where the nodes around x are of one face: the fit to all of them is that
   * of the face. Not beyond borders, and not where walls may be thickened: there other faces count, too.
   * \param[in] nearest distance of the nearest node
   * \param[in] radius ε
   * \param[in] least_wall see thickening ()
   */
  static bool
  isOneFaceEnough (double nearest, double radius, double least_wall)
  {
    return !mayBeBeyondBorder (nearest, radius) && 2.0 * least_wall <= radius;
  }

  /** \brief Forget voters and faces.
   * \param[in] radius ε, the unit of the voters' coordinates
   */
  void
  start (double radius);

  void
  addVoter (const Voter &voter)
  {
    voters_.push_back (voter);
  }

  const std::vector<Voter> &
  voters () const
  {
    return voters_;
  }

  double
  radius () const
  {
    return radius_;
  }

  /** \brief What the fit of a face says: at x, of its slope there, and at each voter; where the tree is elected
   * elsewhere, there are none.
   * \param[in] distance from x to the nearest node of the face
   */
  void
  addFace (int group, double value, const Eigen::Vector3d &slope, double distance, const std::vector<double> &heights);

  /** \brief Forget the faces that end far from x, unless all do: what their fits say out there is not to be relied on,
   * and would close gaps and make flaps where the data ends. */
  void
  dropFarFaces ();

  /** \brief Number of faces. */
  std::size_t
  size () const
  {
    return groups_.size ();
  }

  int
  groupOf (std::size_t face) const
  {
    return groups_[face];
  }

  double
  valueOf (std::size_t face) const
  {
    return values_[face];
  }

  /** \brief Of all ways to combine the faces the one that is nearest to zero at the voters. */
  const FaceTree &
  electTree () const;

  /** \brief The face whose value is that of the tree at x. */
  std::size_t
  winnerOf (const FaceTree &tree) const
  {
    return static_cast<std::size_t> (tree.winner (values_.data ()));
  }

  /** \brief What is to be taken from f at x, so that a thin wall (a thin gap: less than nothing) looks thick enough.
   *
   * Between parallel faces the sum of their values is the thickness. Where they meet in an acute edge, it goes through
   * zero there; beyond, the thickening shall end soon.
   * \param[in] least_wall the thickness that walls and gaps shall have at least, a length; 0 = leave them
   */
  double
  thickening (const FaceTree &tree, double least_wall) const;

  /** \brief Whether x is in a wall thinner than \a most, or in the air beyond the edge in which its faces meet. */
  bool
  isInThinWall (const FaceTree &tree, double most) const;

private:
  /** \brief How thick the wall or gap between two opposite faces is at x, negative beyond the edge in which they meet.
   * \return false where they are not opposite
   */
  bool
  thicknessBetween (const FaceTree &tree, std::size_t face, std::size_t other, double &thickness) const;

  double radius_ = 0.0;
  std::vector<Voter> voters_;
  std::vector<int> groups_;             // of the faces
  std::vector<double> values_;          // at x
  std::vector<Eigen::Vector3d> slopes_; // at x
  std::vector<double> distances_;       // of their nearest nodes from x
  std::vector<double> heights_;         // at the voters, face after face
};

} // namespace erkpa
