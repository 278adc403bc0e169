// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/implicit_field.h>

#include <vector>

namespace erkpa
{

/** \brief One node in the support of an evaluation point. */
struct SupportNode
{
  int slot;          ///< index into the gathered candidates
  Eigen::Vector3d u; ///< (x_i - x) / ε
  double t;          ///< |u|
  double weight;     ///< w(t)
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

  /** \brief The distance within which a quarter of the support's nodes lie: small on the surface that the nodes
   * show, near ε away from it, and near ε too at a few stray nodes. */
  double
  quartileDistance () const;

  /** \brief Distance from x to the nearest node. */
  double
  nearestDistance () const;

  /** \brief Fewest nodes that define a field. */
  static constexpr std::size_t MIN_NODES = 4;

private:
  void
  search (const Eigen::Vector3d &center, double reach);

  void
  searchNearest (const Eigen::Vector3d &center, double extent);

  void
  measureDistances (const Eigen::Vector3d &x);

  void
  measureRadius (const Eigen::Vector3d &x);

  const ImplicitField &field_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero (); // of the ball gathered for
  double center_radius_ = 0.0;                        // ε there
  std::vector<int> candidates_;
  std::vector<double> px_, py_, pz_; // positions of the candidates
  std::vector<double> squared_;      // squared distances from x
  mutable std::vector<double> scratch_;
  std::vector<float> found_;
  std::vector<SupportNode> nodes_;
  double radius_ = 0.0;
  Eigen::Vector3d radius_gradient_ = Eigen::Vector3d::Zero ();
};

} // namespace erkpa
