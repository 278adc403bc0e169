// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/basis.h>
#include <erkpa/kernel.h>
#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>
#include <erkpa/point_layout.h>
#include <erkpa/sharp_surface.h>
#include <erkpa/space_warp.h>

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace erkpa
{

class FaceMap;
struct NodeTable;
struct Pencil;
class SupportSize;

/** \brief How the nodes constrain the field. */
enum class Constraint
{
  HERMITE,    ///< f = 0 and ∇f = n at every node, in the least-squares sense
  FUNCTIONAL, ///< the value of a node is that of its tangent plane: λ_i(x) = (x - x_i)·n_i (eq. 2)
  OFFSURFACE  ///< f = 0 at x_i and f = ±κ at x_i ± κ n_i (section 2)
};

/** \brief What a sharp surface adds to the reproduction vector. */
enum class EnrichmentType
{
  KINK, ///< θH(θ): the gradient of f may jump (eq. 22)
  JUMP  ///< H(θ): f itself may jump; for functional constraints, whose values jump across an edge
};

/** \brief Whether f = 0 holds at the nodes exactly (section 3.4). */
enum class Interpolation
{
  NONE,       ///< the nodes are approximated
  SINGULAR,   ///< interpolated by a kernel that is infinite at the node
  COLLOCATION ///< interpolated by node values that make it so, from a linear system (eq. 26-27)
};

/** \brief The support radius at a point of the input's frame, in the input's unit of length.
 *
 * Positive, finite and continuous everywhere, for it is asked beyond the cloud, too; called from several threads. */
using RadiusFunction = std::function<double (const Eigen::Vector3d &)>;

/** \brief A support radius that changes linearly along an axis, over the extent of the nodes (paper, fig. 6c). */
struct RadiusRamp
{
  int axis = -1;     ///< 0, 1, 2 = x, y, z; -1 = none
  double from = 0.0; ///< radius at the nodes' lowest coordinate
  double to = 0.0;   ///< radius at their highest
};

/** \brief Settings of the field. Of k, radius, radius_ramp and radius_function at most one may be given; radii of the
 * nodes' own (OrientedPoints::radii) exclude them all. */
struct FieldOptions
{
  Order order = Order::AUTOMATIC;              ///< what the field reproduces exactly
  Constraint constraint = Constraint::HERMITE; ///< what the nodes ask of the field
  double offset = 0.2; ///< κ of OFFSURFACE, as a share of the support radius at the node; in (0, 1)
  EnrichmentType enrichment = EnrichmentType::KINK;  ///< what sharp surfaces add
  Interpolation interpolation = Interpolation::NONE; ///< whether the field passes through the nodes
  KernelType kernel = KernelType::AUTOMATIC;         ///< how nodes are weighed
  Kernel::ConstPtr user_kernel;                      ///< instead of \a kernel, where not null
  double flatten = 1.0;   ///< a node's support reaches this share of the radius along its normal; in (0, 1], 1 = a ball
  int k = 0;              ///< support radius = distance to the k-th nearest node, at least 5; 0 = chosen from the noise
  double radius = 0.0;    ///< constant support radius in the cloud's unit; 0 = use k
  RadiusRamp radius_ramp; ///< support radius along an axis
  RadiusFunction radius_function;                     ///< support radius as a function of position; continuous
  std::vector<SharpSurface::ConstPtr> sharp_surfaces; ///< where the gradient of the field may jump
  SpaceWarp::ConstPtr warp; ///< deforms the field: f (warp^-1 (x)); null = none. Nodes, sharp surfaces, radii and the
                            ///< values of f are those before it
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

/** \brief The share of one node in the field: f(x) = Σ φ_i λ_i + ψ_i·n_i (eq. 18, with the normals' terms). */
struct ShapeFunction
{
  int node = 0;                                   ///< index into the field's points
  int side = 0;                                   ///< 1 or -1 at the off-surface points x_i ± κ n_i, else 0
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
   * \param[in] options settings that checkOptions accepts; k = 0 is settled here. Collocation is not done here but by
   * interpolateNodes (), see collocation.h
   * \param[in] threads for what is prepared here; 0 = all processors
   * \param[in] layout of the nodes, where it is known
   */
  ImplicitField (std::shared_ptr<const OrientedPoints> points, NeighborSearch::ConstPtr search,
                 const FieldOptions &options, int threads = 0, PointLayout::ConstPtr layout = nullptr);
  ~ImplicitField ();

  /** \brief The field of the same nodes with other settings; their values are those of the constraint again.
   * \param[in] options as for the constructor
   * \param[in] threads for what is prepared; 0 = all processors
   */
  ConstPtr
  remade (const FieldOptions &options, int threads = 0) const;

  /** \brief Tells whether the settings make sense, and which does not. */
  static Outcome
  checkOptions (const FieldOptions &options);

  /** \brief f(x), x in the input's frame; NaN where too few nodes are in reach. */
  double
  value (const Eigen::Vector3d &x) const;

  /** \brief f(x) and its analytic gradient, x in the input's frame. */
  FieldSample
  sample (const Eigen::Vector3d &x) const;

  /** \brief Many points at once; the same results as sample() one by one, in a warped field up to rounding.
   * \param[in] points positions in the input's frame
   * \param[out] samples one per position
   * \param[in] threads 0 = all processors
   */
  void
  evaluate (const std::vector<Eigen::Vector3d> &points, std::vector<FieldSample> &samples, int threads = 0) const;

  /** \brief The shape functions at x of all nodes in reach; empty where the field is undefined. */
  std::vector<ShapeFunction>
  shapeFunctions (const Eigen::Vector3d &x) const;

  /** \brief The nodes. Those of a cloud some of whose normals were estimated lie in another order than there. */
  const OrientedPoints &
  points () const
  {
    return *points_;
  }

  /** \brief The settings in force (k and order settled). */
  const FieldOptions &
  options () const
  {
    return options_;
  }

  /** \brief How the nodes lie in space. */
  const PointLayout &
  layout () const
  {
    return *layout_;
  }

  const NeighborSearch &
  search () const
  {
    return *search_;
  }

  const Kernel &
  kernel () const
  {
    return *kernel_;
  }

  /** \brief What settles the support radius. */
  const SupportSize &
  supportSize () const
  {
    return *support_size_;
  }

  /** \brief Points per node that carry a value: 1, or 3 with off-surface points. */
  int
  valuesPerNode () const
  {
    return options_.constraint == Constraint::OFFSURFACE ? 3 : 1;
  }

  /** \brief Where the value of a node (side 0) or of its off-surface points (side 1 and -1) stands among all values. */
  std::size_t
  valueIndex (int node, int side) const
  {
    const auto per_node = static_cast<std::size_t> (valuesPerNode ());
    return per_node * static_cast<std::size_t> (node) + (side < 0 ? 2u : static_cast<unsigned> (side));
  }

  /** \brief λ of a node (side 0) or its off-surface points (side 1 and -1), a length: 0 and ±κ, or as set. */
  double
  nodeValue (int node, int side = 0) const;

  /** \brief κ of a node: how far its off-surface points are from it. */
  double
  offsetOf (int node) const
  {
    return static_cast<double> (offsets_[static_cast<std::size_t> (node)]);
  }

  /** \brief The largest of them; 0 without off-surface points. */
  double
  largestOffset () const
  {
    return largest_offset_;
  }

  /** \brief Give the nodes other values, in the order of valueIndex (). Throws std::invalid_argument where there is not
   * one for each. */
  void
  setNodeValues (std::vector<double> values);

  /** \brief The nodes where the surface is: warped where the field is. Local frame. */
  const std::vector<Eigen::Vector3f> &
  surfacePositions () const
  {
    return options_.warp ? warped_positions_ : points_->positions;
  }

  /** \brief Finds the nodes by surfacePositions (). */
  const NeighborSearch &
  surfaceSearch () const
  {
    return options_.warp ? *warped_search_ : *search_;
  }

  /** \brief Typical distance between neighbouring nodes on the surface: the side of the square a node has to itself. */
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

  /** \brief The sharp surfaces that enrich the reproduction vector: all but those between faces of points. */
  const std::vector<SharpSurface::ConstPtr> &
  enrichingSurfaces () const
  {
    return enriching_;
  }

  /** \brief Where one of them stands among options ().sharp_surfaces. */
  int
  placeOfEnriching (int surface) const
  {
    return enriching_places_[static_cast<std::size_t> (surface)];
  }

  /** \brief Whether the nodes have values beside those of the constraint: setNodeValues (). */
  bool
  hasNodeValues () const
  {
    return !values_.empty ();
  }

  /** \brief Finds the same nodes as search (), without a tree: for the many queries of a grid. */
  const NeighborSearch &
  gridSearch () const
  {
    return *grid_search_;
  }

  /** \brief The nodes sorted in space, for evaluations of whole blocks. */
  const NodeTable &
  nodeTable () const
  {
    return *node_table_;
  }

  /** \brief The faces that found sharp surfaces keep apart; null where there are none. */
  const FaceMap *
  faces () const
  {
    return faces_.get ();
  }

  /** \brief Size of the smallest feature the nodes can show: the spacing, or more where noise hides finer ones. */
  double
  featureSize () const
  {
    return feature_size_;
  }

  /** \brief The support radius at a typical node, as long as it is on the surface (warped where the field is). */
  double
  typicalRadius () const
  {
    return typical_radius_;
  }

private:
  void
  warpPositions ();

  std::shared_ptr<const OrientedPoints> points_;
  NeighborSearch::ConstPtr search_;
  PointLayout::ConstPtr layout_;
  FieldOptions options_;
  Kernel::ConstPtr kernel_;
  std::shared_ptr<const SupportSize> support_size_;
  std::vector<float> offsets_; // κ of the nodes
  double largest_offset_ = 0.0;
  std::vector<double> values_; // empty: the constraint's own
  std::vector<Eigen::Vector3f> warped_positions_;
  NeighborSearch::ConstPtr warped_search_;
  std::shared_ptr<const std::vector<Pencil>> pencils_;
  std::vector<SharpSurface::ConstPtr> enriching_;
  std::vector<int> enriching_places_;
  std::shared_ptr<const FaceMap> faces_;
  std::shared_ptr<const NodeTable> node_table_;
  NeighborSearch::ConstPtr grid_search_;
  double typical_radius_ = 0.0;
  double spacing_ = 0.0;
  double feature_size_ = 0.0;
};

} // namespace erkpa
