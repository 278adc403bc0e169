// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "face_groups.h"
#include "lanes/lanes.h"
#include "node_table.h"

#include <erkpa/implicit_field.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief The field at many points of one ball at once, where no sharp surface is in reach: LocalField's quick double.
 *
 * Gathers the nodes around a ball from the NodeTable into arrays with the ball's middle as origin and the typical
 * radius as unit, and hands them with the points to the vectors of the processor (lanes.h). One object per thread.
 */
class BlockField
{
public:
  explicit BlockField (const ImplicitField &field, const lanes::Engine &engine = lanes::bestEngine ());

  /** \brief Whether fields with such settings are evaluated here at all. */
  static bool
  canEvaluate (const ImplicitField &field);

  /** \brief Decide what in-reach means: see lanes::Settings. */
  void
  setReach (double share, double offset, double near_enough);

  /** \brief Prepare for points within \a extent of \a center (local frame).
   * \return false where the field is none of canEvaluate (), or no nodes are in reach
   */
  bool
  gather (const Eigen::Vector3d &center, double extent);

  /** \brief Whether a point of the ball that was gathered for can be evaluated here: no sharp surface is in its reach.
   */
  bool
  isPlainAt (const Eigen::Vector3d &x) const;

  /** \brief Forget the points, then take up others. */
  void
  clearPoints ();

  void
  addPoint (const Eigen::Vector3d &x);

  std::size_t
  size () const
  {
    return count_;
  }

  /** \brief Evaluate f at the points, and ∇f, border offsets and attributes where \a gradients are wanted. */
  void
  evaluate (bool gradients);

  /** \brief f; NaN where undefined. */
  double
  value (std::size_t point) const
  {
    return unit_ * static_cast<double> (values_[point]);
  }

  bool
  isInReach (std::size_t point) const
  {
    return in_reach_[point] != 0;
  }

  /** \brief Whether value and gradient are as LocalField's; false also where f is undefined. */
  bool
  isSettled (std::size_t point) const
  {
    return states_[point] == lanes::State::DEFINED;
  }

  bool
  isUnsettled (std::size_t point) const
  {
    return states_[point] == lanes::State::UNSETTLED;
  }

  Eigen::Vector3d
  gradient (std::size_t point) const
  {
    return {static_cast<double> (gradients_[0][point]), static_cast<double> (gradients_[1][point]),
            static_cast<double> (gradients_[2][point])};
  }

  /** \brief ε. */
  double
  radius (std::size_t point) const
  {
    return unit_ * static_cast<double> (radii_[point]);
  }

  double
  borderOffset (std::size_t point) const
  {
    return static_cast<double> (border_offsets_[point]);
  }

  float
  attribute (std::size_t point, std::size_t channel) const
  {
    return attributes_[channel * attributesStride () + point];
  }

  /** \brief Face of the nearest node; -1 where the field has no faces. */
  int
  face (std::size_t point) const;

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
  gatherSharpSurfaces ();

  bool
  findReach (const Eigen::Vector3d &center, double extent);

  void
  gatherNodes (const Eigen::Vector3d &center, double reach);

  void
  copyNodes ();

  void
  copyAttributes ();

  void
  resizePoints (std::size_t size);

  void
  setRadii ();

  void
  refuseUncovered ();

  lanes::Nodes
  nodes () const;

  /** \brief Index of a gathered node among the field's points. */
  int
  nodeAt (std::size_t i) const
  {
    return static_cast<int> (table_->grid->index ()[places_[i]]);
  }

  /** \brief 0 at a node, 1 and -1 at its off-surface points. */
  int
  sideOf (std::size_t value_point) const
  {
    return value_point < found_ ? 0 : value_point < 2 * found_ ? 1 : -1;
  }

  std::size_t
  padded () const
  {
    return (count_ + lanes::MAX_WIDTH - 1) / lanes::MAX_WIDTH * lanes::MAX_WIDTH;
  }

  std::size_t
  attributesStride () const
  {
    return points_[0].size ();
  }

  const ImplicitField &field_;
  const NodeTable *table_; // null: nothing is evaluated here
  const lanes::Engine &engine_;
  lanes::Settings settings_{};
  FaceGroups groups_;
  bool has_separations_ = false;
  std::vector<std::pair<const SharpSurface *, bool>> near_surfaces_; // and whether it is a plane
  double unit_, inverse_unit_;                                       // of the lanes' lengths
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  double center_radius_ = 0.0; // ε there
  double reach_ = 0.0;         // how far around it the nodes are gathered

  // The gathered nodes. Arrays keep their memory from ball to ball.
  std::size_t found_ = 0, node_count_ = 0; // nodes, value points
  std::vector<std::uint32_t> places_;      // in the table
  std::array<std::vector<float>, 3> positions_, normals_;
  std::vector<float> squared_, lambdas_, confidences_, node_attributes_;

  // The points and what is found there.
  std::size_t count_ = 0;
  std::array<std::vector<float>, 3> points_, growths_, gradients_;
  std::vector<float> bounds_, guesses_, values_, radii_, border_offsets_, attributes_;
  std::vector<std::uint8_t> in_reach_;
  std::vector<lanes::State> states_;
  std::vector<std::uint32_t> nearest_, supports_;

  std::vector<std::uint32_t> list_;
  std::vector<float> rows_;
  std::size_t evaluations_ = 0, support_nodes_ = 0;
};

} // namespace erkpa
