// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "block_parts.h"
#include "face_vote.h"

#include <erkpa/implicit_field.h>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace erkpa
{

/** \brief The field where faces meet, at many points at once: LocalField::evaluateFaces ()'s quick double.
 *
 * Fits each group of faces alone, then the nodes around each point vote on how the groups combine. Works in the lanes'
 * unit.
 */
class BlockFaces
{
public:
  BlockFaces (const ImplicitField &field, const lanes::Engine &engine, const lanes::Settings &settings, double unit);

  /** \brief Whether fields with such settings are evaluated here. */
  static bool
  canEvaluate (const ImplicitField &field);

  /** \brief Prepare for points within \a extent of \a center, the origin of the lanes.
   * \return false where no faces are apart near them
   */
  bool
  gather (const Eigen::Vector3d &center, double extent)
  {
    return parts_.gather (center, extent);
  }

  /** \brief The faces around the ball. */
  const FaceGroups &
  groups () const
  {
    return parts_.groups ();
  }

  /** \brief See LocalField::thicken (). */
  void
  thicken (double least_wall)
  {
    least_wall_ = least_wall / unit_;
  }

  /** \brief See BlockField::setLevel (). */
  void
  setLevel (double level)
  {
    level_ = static_cast<float> (level / unit_);
  }

  /** \brief Put what the faces make in place of what was found for all nodes alike.
   * \param[in] settings,nodes what that was found with
   * \param[in] which of the points are in reach of where faces are kept apart
   * \param[in,out] points those that cannot be told are left unsettled
   */
  void
  combine (const lanes::Settings &settings, const lanes::Nodes &nodes, const std::vector<std::uint32_t> &which,
           BlockPoints &points);

  /** \brief A point, and a face whose piece of f is wanted there. */
  struct Question
  {
    std::uint32_t point;
    int face;
  };

  /** \brief The pieces of f on the sides of faces: LocalField::sampleOnSides ()'s quick double.
   * \param[in] settings,which,points as for combine ()
   * \param[in] questions those about a point follow each other
   * \param[out] answers to each; those of no faces are the fits to all nodes, which \a points has
   * \return false where that cannot be told
   */
  bool
  sampleSides (const lanes::Settings &settings, const std::vector<std::uint32_t> &which, const BlockPoints &points,
               const std::vector<Question> &questions, std::vector<BlockParts::Part> &answers);

  /** \brief For the points last combined, by their place in \a which: the face that holds there, -1 for that of the
   * nearest node. */
  int
  face (std::size_t place) const
  {
    return combined_[place].face;
  }

  /** \brief See LocalField::thickening (). */
  double
  thickening (std::size_t place) const
  {
    return unit_ * combined_[place].thickening;
  }

  std::size_t
  evaluations () const
  {
    return parts_.evaluations ();
  }

  std::size_t
  supportNodes () const
  {
    return parts_.supportNodes ();
  }

private:
  /** \brief A point and its share of the lists; in reach of few groups. */
  struct Combined
  {
    std::size_t first_voter = 0, last_voter = 0, first_part = 0;
    int groups = 0; // fewer than two: the fit to all nodes stands
    int face = -1;
    double thickening = 0.0;
  };

  bool
  isClearOfSurface (const lanes::Nodes &nodes, const BlockPoints &points, std::uint32_t point) const;

  void
  listNear (const Eigen::Vector3f &x, float radius);

  bool
  holdsOneFace (float radius) const;

  void
  weighVoters (float radius, Combined &combined);

  void
  askForParts (const BlockPoints &points, std::uint32_t point, Combined &combined);

  const BlockParts::Part &
  partOf (const Combined &combined, int group) const
  {
    return parts_.part (combined.first_part + static_cast<std::size_t> (group));
  }

  void
  vote (BlockPoints &points, std::uint32_t point, Combined &combined);

  const FaceTree &
  electTree (const Combined &combined, float radius) const;

  void
  settleReach (BlockPoints &points, std::uint32_t point, double aside) const;

  const lanes::Engine &engine_;
  lanes::Settings settings_;
  double unit_, least_wall_ = 0.0;
  float level_ = NAN; // none
  BlockParts parts_;
  std::vector<Combined> combined_;
  std::array<std::vector<float>, 3> voters_; // of all points: (x_i - x) / ε, ...
  std::vector<float> weights_;               // ... and their weights
  std::size_t listed_ = 0;                   // of both
  std::vector<float> shares_;                // of the faces present: whether they have a say
  FaceVote vote_;
};

} // namespace erkpa
