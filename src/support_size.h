// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/implicit_field.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace erkpa
{

/** \brief How far supports reach: where the support radius ε comes from.
 *
 * Either a radius at the evaluation point, ε(x): constant, a function, or the distance to the k-th nearest node; or one
 * at each node, ε_i. The k-th node is looked for by Support, which has the nodes at hand.
 */
class SupportSize
{
public:
  enum class Kind
  {
    NEAREST,  ///< ε(x) = distance to the k-th nearest node
    CONSTANT, ///< ε
    FUNCTION, ///< ε(x) given
    PER_NODE  ///< ε_i given
  };

  /** \param[in] options with k settled */
  SupportSize (const OrientedPoints &points, const FieldOptions &options, double spacing);

  /** \brief Which of them some settings ask for. */
  static Kind
  kindOf (const OrientedPoints &points, const FieldOptions &options);

  Kind
  kind () const
  {
    return kind_;
  }

  int
  k () const
  {
    return k_;
  }

  /** \brief ε(x) of a CONSTANT or FUNCTION, x in the local frame; not positive where the function makes no sense. */
  double
  radiusAt (const Eigen::Vector3d &x) const;

  /** \brief ∇ε(x) of the same, by central differences. */
  Eigen::Vector3d
  radiusGradientAt (const Eigen::Vector3d &x) const;

  /** \brief The radius at a typical node. */
  double
  typical () const
  {
    return typical_;
  }

  /** \brief Where radii are larger there is no surface in a grid of these voxels, though f is defined: infinite but for
   * NEAREST.
   *
   * Nodes that are so sparse beside most of them, and beside the voxels, are strays for this grid: their supports hold
   * each other and reach through all of space, which would be followed voxel by voxel.
   */
  double
  farthest (double voxel_size) const
  {
    constexpr double SPARSE = 16.0, VOXELS = 64.0;
    return kind_ == Kind::NEAREST ? std::max (SPARSE * typical_, VOXELS * voxel_size) : HUGE_VAL;
  }

  /** \brief The radius at every node. */
  std::vector<float>
  radiiOfNodes (const NeighborSearch &search, int threads) const;

  /** \brief PER_NODE: the nodes whose supports points within \a extent of \a center may lie in. */
  void
  nodesReaching (const Eigen::Vector3d &center, double extent, std::vector<int> &nodes) const;

private:
  /** \brief Nodes whose radii differ by no more than a factor of two, so that none is looked for in vain far off. */
  struct Octave
  {
    double largest = 0.0;
    std::vector<int> nodes;
    NeighborSearch::ConstPtr search; // over nodes
  };

  void
  sortIntoOctaves ();

  const OrientedPoints &points_;
  Kind kind_;
  int k_;
  double radius_;
  RadiusFunction function_; // local frame
  double typical_ = 0.0;
  std::vector<Octave> octaves_;
};

} // namespace erkpa
