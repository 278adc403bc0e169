// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/basis.h>
#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>
#include <erkpa/sharp_surface.h>

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

namespace erkpa
{

struct Pencil;

/** \brief How the surface constrains the field at its nodes. */
enum class Constraint
{
  HERMITE ///< f = 0 and ∇f = n at every node, in the least-squares sense
};

/** \brief Settings of the field. */
struct FieldOptions
{
  Order order = Order::SPHERICAL;              ///< what the field reproduces exactly
  Constraint constraint = Constraint::HERMITE; ///< what the nodes ask of the field
  int k = 0;           ///< support radius = distance to the k-th nearest node, at least 5; 0 = chosen from the noise
  double radius = 0.0; ///< constant support radius in the cloud's unit; 0 = use k
  std::vector<SharpSurface::ConstPtr> sharp_surfaces; ///< where the gradient of the field may jump
};

/** \brief The field and its gradient at one point. */
struct FieldSample
{
  double value = std::numeric_limits<double>::quiet_NaN (); ///< about the signed distance, positive outside
  Eigen::Vector3d gradient = Eigen::Vector3d::Constant (std::numeric_limits<double>::quiet_NaN ());

  /** \brief False where too few nodes are in reach to define the field. */
  bool
  isDefined () const
  {
    return value == value;
  }
};

/** \brief The share of one node in the field: f(x) = Σ φ_i λ_i + ψ_i·n_i (eq. 18, with the gradient terms). */
struct ShapeFunction
{
  int node = 0;                                   ///< index into the field's points
  double phi = 0.0;                               ///< φ_i(x), weight of the node's value (eq. 19)
  Eigen::Vector3d psi = Eigen::Vector3d::Zero (); ///< ψ_i(x), weight of the node's normal, a length
};

/** \brief The ERKPA field of oriented points: an implicit surface f = 0 with sharp edges where the user put them.
 *
 * Around x the nodes in the support of radius ε(x) are fitted, in values and gradients, by a combination of the
 * reproduction vector R (eq. 15): polynomials, and for each sharp surface the enrichment θH(θ) (eq. 22). See
 * moment_system.h for the system (eq. 16-17). All member functions are const and may run in several threads.
 */
class ImplicitField
{
public:
  using ConstPtr = std::shared_ptr<const ImplicitField>;

  /** \param[in] points the nodes, with unit normals
   * \param[in] search finds the nodes; must know the same positions under the same indices
   * \param[in] options settings that checkOptions accepts; k = 0 is settled here
   */
  ImplicitField (std::shared_ptr<const OrientedPoints> points, NeighborSearch::ConstPtr search,
                 const FieldOptions &options);
  ~ImplicitField ();

  /** \brief Tells whether the settings make sense, and which does not. */
  static Outcome
  checkOptions (const FieldOptions &options);

  /** \brief f(x), x in the input's frame; NaN where too few nodes are in reach. */
  double
  value (const Eigen::Vector3d &x) const;

  /** \brief f(x) and its analytic gradient, x in the input's frame. */
  FieldSample
  sample (const Eigen::Vector3d &x) const;

  /** \brief Many points at once; the same results as sample() one by one.
   * \param[in] points positions in the input's frame
   * \param[out] samples one per position
   * \param[in] threads 0 = all processors
   */
  void
  evaluate (const std::vector<Eigen::Vector3d> &points, std::vector<FieldSample> &samples, int threads = 0) const;

  /** \brief The shape functions at x of all nodes in reach; empty where the field is undefined. */
  std::vector<ShapeFunction>
  shapeFunctions (const Eigen::Vector3d &x) const;

  const OrientedPoints &
  points () const
  {
    return *points_;
  }

  /** \brief The settings in force (k settled). */
  const FieldOptions &
  options () const
  {
    return options_;
  }

  const NeighborSearch &
  search () const
  {
    return *search_;
  }

  /** \brief Typical distance between neighbouring nodes: the side of the square a node has to itself. */
  double
  spacing () const
  {
    return spacing_;
  }

  /** \brief The triples of sharp planes that share a line, where corners can be. */
  const std::vector<Pencil> &
  pencils () const
  {
    return *pencils_;
  }

  /** \brief Size of the smallest feature the nodes can show: the spacing, or more where noise hides finer ones. */
  double
  featureSize () const
  {
    return feature_size_;
  }

  /** \brief The support radius at a typical node. */
  double
  typicalRadius () const;

private:
  std::shared_ptr<const OrientedPoints> points_;
  NeighborSearch::ConstPtr search_;
  FieldOptions options_;
  std::shared_ptr<const std::vector<Pencil>> pencils_;
  double spacing_ = 0.0;
  double feature_size_ = 0.0;
};

} // namespace erkpa
