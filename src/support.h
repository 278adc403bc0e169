// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/implicit_field.h>

#include <vector>

namespace erkpa
{

/** \brief One node in the support of an evaluation point. */
struct SupportNode
{
  int slot;                 ///< index into the gathered candidates
  Eigen::Vector3d u;        ///< (x_i - x) / ε
  double t;                 ///< |u|
  double weight;            ///< w(t)
};

/** \brief The nodes that an evaluation point reaches, and how far it reaches: ε(x) and ∇ε(x).
  *
  * Candidates are gathered once for a ball and serve all points in it. They stay sorted by index, so that sums over
  * them do not depend on the ball they were gathered for.
  */
class Support
{
public:
  explicit Support (const ImplicitField &field);

  /** \brief Gather all nodes that points within \a extent of \a center (local frame) can reach. */
  void
  gather (const Eigen::Vector3d &center, double extent);

  /** \brief Select the nodes in the support of \a x, which must lie in the ball gathered for.
    * \return false where too few nodes are in reach to define the field
    */
  bool
  select (const Eigen::Vector3d &x);

  /** \brief Indices of the candidates in the field's points, ascending. */
  const std::vector<int> &
  candidates () const
  {
    return candidates_;
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

  const Eigen::Vector3d &
  radiusGradient () const
  {
    return radius_gradient_;
  }

  /** \brief Distance from x to the nearest node. */
  double
  nearestDistance () const
  {
    return nearest_;
  }

  /** \brief Fewest nodes that define a field. */
  static constexpr std::size_t MIN_NODES = 4;

private:
  void
  measureDistances (const Eigen::Vector3d &x);

  void
  measureRadius (const Eigen::Vector3d &x);

  const ImplicitField &field_;
  std::vector<int> candidates_;
  std::vector<double> px_, py_, pz_;  // positions of the candidates
  std::vector<double> squared_;       // squared distances from x
  std::vector<double> scratch_;
  std::vector<float> found_;
  std::vector<SupportNode> nodes_;
  double radius_ = 0.0, nearest_ = 0.0;
  Eigen::Vector3d radius_gradient_ = Eigen::Vector3d::Zero ();
};

} // namespace erkpa
