// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "block_nodes.h"
#include "block_points.h"
#include "face_groups.h"
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
 * The fits to a group of faces are made together for all points that see it, in lanes; then the nodes around each point
 * vote on how the groups combine. Works in the lanes' unit.
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
  gather (const Eigen::Vector3d &center, double extent);

  /** \brief Whether faces are kept apart in reach of \a x (local frame), which is in the ball. */
  bool
  hasSeparationAt (const Eigen::Vector3d &x) const
  {
    return groups_.hasSeparationAt (x);
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
    return evaluations_;
  }

  std::size_t
  supportNodes () const
  {
    return support_nodes_;
  }

private:
  static constexpr std::size_t MAX_TERMS = 10, MAX_PRESENT = 64;

  /** \brief A point and its share of the lists; in reach of few groups. */
  struct Combined
  {
    std::size_t first_voter = 0, last_voter = 0, first_part = 0;
    int groups = 0; // fewer than two: the fit to all nodes stands
    int face = -1;
    double thickening = 0.0;
  };

  /** \brief The fit to one group at one point. */
  struct Part
  {
    std::uint32_t point;
    std::uint64_t faces; // of the group, as bits: places among those present
    lanes::State state;
    int face;
    float value, radius, nearest, aside, border_offset;
    Eigen::Vector3f gradient;
    std::array<float, MAX_TERMS> coefficients;
  };

  void
  gatherNodes (const std::vector<std::uint32_t> &which, const BlockPoints &points);

  bool
  isClearOfSurface (const lanes::Nodes &nodes, const BlockPoints &points, std::uint32_t point) const;

  void
  listNear (const Eigen::Vector3f &x, float radius);

  bool
  holdsOneFace (float radius);

  void
  weighVoters (float radius, Combined &combined);

  void
  askForParts (const BlockPoints &points, std::uint32_t point, Combined &combined);

  void
  fitParts (const BlockPoints &points);

  void
  fitPart (const BlockPoints &points, std::uint64_t faces);

  void
  takeUp (std::size_t i, Part &part) const;

  void
  vote (BlockPoints &points, std::uint32_t point, Combined &combined);

  const FaceTree &
  electTree (const Combined &combined, float radius) const;

  void
  settleReach (BlockPoints &points, std::uint32_t point, double aside) const;

  const ImplicitField &field_;
  const lanes::Engine &engine_;
  lanes::Settings settings_;
  double unit_, least_wall_ = 0.0;
  float level_ = NAN; // none
  FaceGroups groups_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  double reach_of_parts_ = 0.0, reach_of_voters_ = 0.0; // that nodes were gathered for
  BlockNodes all_, near_points_, of_part_;              // in reach of parts, of voters; of a part
  std::vector<int> slots_;                              // among all_ of the nodes in reach of voters
  BlockPoints at_part_;
  std::vector<Combined> combined_;
  std::array<std::vector<float>, 3> voters_; // of all points: (x_i - x) / ε, ...
  std::vector<float> weights_;               // ... and their weights
  std::size_t listed_ = 0;                   // of both
  std::vector<Part> parts_;
  std::vector<std::uint32_t> parts_to_fit_; // those of one group
  std::vector<int> near_;                   // nodes around a point, among all_
  std::vector<int> slots_close_;            // those within FaceGroups::CLOSE
  std::vector<std::uint32_t> places_;       // the same, among near_points_
  FaceVote vote_;
  std::size_t evaluations_ = 0, support_nodes_ = 0;
};

} // namespace erkpa
