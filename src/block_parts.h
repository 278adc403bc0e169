// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "block_nodes.h"
#include "block_points.h"
#include "face_groups.h"

#include <erkpa/implicit_field.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace erkpa
{

/** \brief Fits to the nodes of some faces alone, at many points at once: Support::selectPart () in lanes.
 *
 * The fits to a group of faces are made together for all points that ask for it. Works in the lanes' unit.
 */
class BlockParts
{
public:
  static constexpr std::size_t MAX_TERMS = 10, MAX_PRESENT = 64;

  /** \brief The fit to one group at one point. */
  struct Part
  {
    std::uint32_t point;
    std::uint64_t faces; ///< of the group, as bits: places among those present
    lanes::State state;
    int face; ///< that of the nearest node
    float value, radius, nearest, aside, border_offset;
    Eigen::Vector3f gradient;
    std::array<float, MAX_TERMS> coefficients;
  };

  BlockParts (const ImplicitField &field, const lanes::Engine &engine, const lanes::Settings &settings, double unit);

  /** \brief Prepare for points within \a extent of \a center, the origin of the lanes.
   * \return false where no faces are apart near them
   */
  bool
  gather (const Eigen::Vector3d &center, double extent);

  /** \brief The faces around the ball, and after select () around a point. */
  const FaceGroups &
  groups () const
  {
    return groups_;
  }

  /** \brief Have the nodes in reach of some points, and forget what was asked for.
   * \param[in] settings as for fits to all nodes
   * \return false where there are more faces than can be told apart
   */
  bool
  start (const lanes::Settings &settings, const std::vector<std::uint32_t> &which, const BlockPoints &points);

  /** \brief List the nodes that have a say at x (see FaceGroups::REACH).
   * \param[out] copies (x_i - x) / ε, squared distances; room for nearNodes () and MAX_WIDTH more
   */
  void
  listNear (const Eigen::Vector3f &x, float radius, lanes::Copies copies);

  /** \brief FaceGroups::placeOfSlot () of the nodes last listed. */
  const std::vector<int> &
  near () const
  {
    return near_;
  }

  /** \brief How many nodes can be in any list, at most. */
  std::size_t
  nearNodes () const
  {
    return near_faces_.size ();
  }

  /** \brief Group the nodes last listed as seen from x; see FaceGroups::select (). */
  bool
  select (const Eigen::Vector3f &x);

  /** \brief Ask for the fit to a group, as it was selected, at a point. */
  void
  ask (std::uint32_t point, int group);

  /** \brief Make the fits that were asked for. */
  void
  fit (const BlockPoints &points);

  /** \brief Number of fits that were asked for. */
  std::size_t
  size () const
  {
    return parts_.size ();
  }

  /** \param[in] i in the order of asking */
  const Part &
  part (std::size_t i) const
  {
    return parts_[i];
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
  void
  gatherNodes (const std::vector<std::uint32_t> &which, const BlockPoints &points);

  void
  sortByFace ();

  void
  findNearPoints (float reach);

  const BlockNodes &
  nodesOf (std::uint64_t faces);

  void
  fitGroup (const BlockPoints &points, std::uint64_t faces);

  void
  takeUp (std::size_t i, const BlockNodes &nodes, Part &part) const;

  const ImplicitField &field_;
  const lanes::Engine &engine_;
  lanes::Settings settings_;
  double unit_;
  FaceGroups groups_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  double reach_of_parts_ = 0.0, reach_of_near_ = 0.0; // that nodes were gathered for
  BlockNodes all_;                                    // in reach of parts
  std::vector<std::uint32_t> by_face_;                // the same, in the order of the faces present: ...
  std::vector<std::size_t> ends_of_faces_;            // ... up to here; those of no face come first
  std::deque<BlockNodes> of_groups_;                  // of them: those of groups, ...
  std::vector<std::uint64_t> known_groups_;           // ... these
  std::array<std::vector<float>, 3> near_points_;     // positions of the nodes in reach of lists, ...
  std::vector<int> near_faces_;                       // ... and FaceGroups::placeOfSlot () of them
  std::vector<std::uint32_t> places_;                 // among some nodes
  std::vector<int> near_;                             // those of near_faces_ last listed
  BlockPoints at_part_;
  double part_reach_; // radius of a part's support, at most, in radii of the whole
  std::vector<Part> parts_;
  std::vector<std::uint32_t> parts_to_fit_; // those of one group
  std::size_t evaluations_ = 0, support_nodes_ = 0;
};

} // namespace erkpa
