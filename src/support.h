// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "support_size.h"

#include <erkpa/implicit_field.h>

#include <cmath>
#include <vector>

namespace erkpa
{

/** \brief A point that carries a value of the field: a node, or one of a node's off-surface points. */
struct ValuePoint
{
  int node;      ///< index into the field's points
  int side;      ///< 0 at the node, 1 and -1 at x_i ± κ n_i
  double lambda; ///< λ_i, a length
};

/** \brief One value point in the support of an evaluation point. */
struct SupportNode
{
  int slot;          ///< index into the gathered value points
  Eigen::Vector3d u; ///< (x_i - x) / ε
  double t;          ///< distance in units of the node's support
  double weight;     ///< w(t) Δx_i
  double ratio;      ///< (ε / ε_i)²; 1 where the radius is one of the evaluation point
};

/** \brief The nodes that an evaluation point reaches, and how far it reaches: ε(x) and ∇ε(x).
 *
 * Candidates are gathered once for a ball and serve all points in it. They stay in one order, so that sums over
 * them do not depend on the ball they were gathered for. Where nodes have radii of their own, ε(x) is their weighted
 * mean and only a scale of the coordinates.
 */
class Support
{
public:
  /** \param[in] search finds the nodes: the field's own, or its quick one, which finds the same */
  Support (const ImplicitField &field, const NeighborSearch &search);

  /** \brief Gather all nodes that points within \a extent of \a center (local frame) can reach.
   * \param[in] for_parts gather farther, so that parts of the nodes make supports, too
   */
  void
  gather (const Eigen::Vector3d &center, double extent, bool for_parts = false);

  /** \brief Whether what was gathered is all that \a x reaches; only a radius that is a function can outgrow it. */
  bool
  covers (const Eigen::Vector3d &x) const;

  /** \brief Select the nodes in the support of \a x, which must be covered.
   * \return false where too few nodes are in reach to define the field
   */
  bool
  select (const Eigen::Vector3d &x);

  /** \brief Narrow the support selected at \a x to a part of the gathered value points.
   *
   * Where k nearest nodes make the radius, it becomes that of the k nearest of the part, up to a limit.
   * \param[in] parts of the value points, by slot
   * \param[in] part the one that counts
   * \return false where too few nodes are in reach to define the field
   */
  bool
  selectPart (const Eigen::Vector3d &x, const std::vector<int> &parts, int part);

  /** \brief The value points gathered, by node. */
  const std::vector<ValuePoint> &
  points () const
  {
    return points_;
  }

  /** \brief The middle of the ball that was gathered for. */
  const Eigen::Vector3d &
  center () const
  {
    return center_;
  }

  /** \brief All that was gathered lies within this distance of it. */
  double
  reach () const
  {
    return size_.kind () == SupportSize::Kind::PER_NODE ? HUGE_VAL : reach_ + field_.largestOffset ();
  }

  const ValuePoint &
  pointOf (const SupportNode &node) const
  {
    return points_[static_cast<std::size_t> (node.slot)];
  }

  Eigen::Vector3d
  position (std::size_t slot) const
  {
    return {px_[slot], py_[slot], pz_[slot]};
  }

  const std::vector<SupportNode> &
  nodes () const
  {
    return nodes_;
  }

  double
  radius () const
  {
    return radius_;
  }

  /** \brief See SupportSize. */
  double
  farthest (double voxel_size) const
  {
    return size_.farthest (voxel_size);
  }

  /** \brief Squared distance of a gathered value point from the point last selected for. */
  double
  squaredDistance (std::size_t slot) const
  {
    return squared_[slot];
  }

  /** \brief ∇ε(x). */
  const Eigen::Vector3d &
  radiusGradient () const
  {
    return radius_gradient_;
  }

  /** \brief ε ∇ log ε_i², by which gradient terms gain weight over values: 2 ∇ε, or 0 for radii of the nodes' own. */
  const Eigen::Vector3d &
  growth () const
  {
    return growth_;
  }

  /** \brief ε ∇(w Δx_i) of a node with respect to x. */
  Eigen::Vector3d
  weightGradient (const SupportNode &node) const;

  /** \brief The distance within which a quarter of the support's nodes lie: small on the surface that the nodes
   * show, near ε away from it, and near ε too at a few stray nodes. */
  double
  quartileDistance () const;

  /** \brief Distance from x to the nearest node. */
  double
  nearestDistance () const;

  /** \brief The value points within \a reach of the point last selected for, by slot. */
  void
  listWithin (double reach, std::vector<int> &slots) const;

  /** \brief How many nearest nodes make the radius of a part, where \a k make that of the whole. */
  static int
  neighborsOfPart (int k);

  /** \brief Radius of a part's support, at most, in radii of the whole. */
  static constexpr double PART_REACH = 2.2;

  /** \brief Fewest nodes that define a field. */
  static constexpr std::size_t MIN_NODES = 4;

private:
  void
  search (const Eigen::Vector3d &center, double reach);

  void
  searchNearest (const Eigen::Vector3d &center, double extent);

  void
  makeValuePoints ();

  /** \brief The slots that a predicate chooses. */
  template <typename ChooseT>
  void
  listSlots (ChooseT choose, std::vector<int> &slots) const;

  /** \brief Into scratch_ go the squared distances of those nodes whose slots a predicate chooses. */
  template <typename ChooseT>
  void
  listDistances (ChooseT choose);

  /** \brief Both, without a branch. */
  static bool
  both (bool a, bool b)
  {
    return (static_cast<int> (a) & static_cast<int> (b)) != 0;
  }

  void
  measureDistances (const Eigen::Vector3d &x);

  void
  measureRadius (const Eigen::Vector3d &x);

  void
  measureNearestRadius (const Eigen::Vector3d &x);

  void
  measurePartRadius (const Eigen::Vector3d &x);

  bool
  weighNodes (const Eigen::Vector3d &x);

  bool
  isMember (std::size_t slot) const
  {
    return parts_ == nullptr || (*parts_)[slot] == part_;
  }

  void
  weighByOwnRadii (const Eigen::Vector3d &x);

  /** \brief S^T S d of a node's support shape S: what its distance grows by. */
  Eigen::Vector3d
  stretched (int node, const Eigen::Vector3d &d) const;

  double
  weightOf (std::size_t slot, double t) const;

  bool
  isOnSurface (std::size_t slot) const
  {
    return points_[slot].side == 0;
  }

  const ImplicitField &field_;
  const NeighborSearch &search_;
  const SupportSize &size_;
  bool has_shapes_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero (); // of the ball gathered for
  double center_radius_ = 0.0;                        // ε there
  double reach_ = 0.0;                                // how far around it all nodes are known
  std::vector<int> candidates_;
  std::vector<ValuePoint> points_;
  std::vector<double> px_, py_, pz_; // positions of the value points
  std::vector<double> squared_;      // squared distances from x
  mutable std::vector<double> scratch_;
  mutable std::vector<int> listed_; // does not shrink: what grows again is cleared
  std::vector<float> found_;
  std::vector<int> slots_; // of those that were listed last
  std::vector<SupportNode> nodes_;
  const std::vector<int> *parts_ = nullptr; // null: all
  int part_ = 0;
  double radius_ = 0.0;
  Eigen::Vector3d radius_gradient_ = Eigen::Vector3d::Zero ();
  double whole_radius_ = 0.0; // of all nodes, where the support is that of a part
  Eigen::Vector3d whole_radius_gradient_ = Eigen::Vector3d::Zero ();
  Eigen::Vector3d growth_ = Eigen::Vector3d::Zero ();
};

template <typename ChooseT>
void
Support::listSlots (ChooseT choose, std::vector<int> &slots) const
{
  if (listed_.size () < squared_.size ())
    listed_.resize (squared_.size ());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < squared_.size (); ++i)
  {
    listed_[kept] = static_cast<int> (i);
    kept += choose (i) ? 1 : 0; // no branch, which none could foretell
  }
  slots.assign (listed_.begin (), listed_.begin () + static_cast<std::ptrdiff_t> (kept));
}

template <typename ChooseT>
void
Support::listDistances (ChooseT choose)
{
  listSlots ([&] (std::size_t i) { return both (choose (i), isOnSurface (i)); }, slots_);
  scratch_.clear ();
  for (const int slot : slots_)
    scratch_.push_back (squared_[static_cast<std::size_t> (slot)]);
}

} // namespace erkpa
