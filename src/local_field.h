// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "enrichment.h"
#include "face_groups.h"
#include "face_vote.h"
#include "support.h"

#include <erkpa/implicit_field.h>

#include <Eigen/LU>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace erkpa
{

/** \brief A sample of the field with what the polygonizer wants to know beside it. */
struct LocalSample : FieldSample
{
  double radius = 0.0;        ///< support radius ε(x)
  double border_offset = 0.0; ///< |centroid of the weighted nodes - x| along the surface, in ε
};

/** \brief A side of every crease: a face, and of the other sharp surfaces the side on which a place lies. */
struct Side
{
  int face = -1;
  Eigen::Vector3d place = Eigen::Vector3d::Zero (); ///< local frame
};

/** \brief The field seen from one ball: gathers the nodes once, then evaluates f at any of the ball's points.
 *
 * Works in the local frame of OrientedPoints; a warped field is evaluated where the warp comes from. One object per
 * thread; its memory is reused from ball to ball.
 */
class LocalField
{
public:
  /** \param[in] unwarped look at the field as it is before its warp */
  explicit LocalField (const ImplicitField &field, bool unwarped = false)
      : LocalField (field, field.gridSearch (), unwarped)
  {
  }

  /** \param[in] search over the field's nodes */
  LocalField (const ImplicitField &field, const NeighborSearch &search, bool unwarped = false)
      : field_ (field), warp_ (unwarped ? nullptr : field.options ().warp.get ()), support_ (field, search),
        enrichment_ (field), groups_ (field.faces ())
  {
  }

  /** \brief Prepare for points within \a extent of \a center. */
  void
  gather (const Eigen::Vector3d &center, double extent);

  /** \brief f(x); NaN where undefined. */
  double
  value (const Eigen::Vector3d &x);

  /** \brief f(x), ∇f(x) and the rest. */
  LocalSample
  sample (const Eigen::Vector3d &x);

  /** \brief What is wanted as the gradient. */
  enum class Slope
  {
    EXACT,     ///< ∇f
    OF_THE_FIT ///< its coefficients held, as if the weights did not change with x: quicker, and tells edges as well
  };

  /** \brief The smooth pieces of f that hold on sides of all creases, continued to x; undefined where the face is out
   * of reach. Sides with the same face share a fit. */
  void
  sampleOnSides (const Eigen::Vector3d &x, const std::vector<Side> &sides, std::vector<LocalSample> &samples,
                 Slope slope = Slope::EXACT);

  /** \brief Whether two faces are kept apart at x, and no faces are joined there; false where that takes a fit to know.
   * \param[in] x in the ball that was gathered for
   */
  bool
  keepsApart (int face, int other, const Eigen::Vector3d &x) const
  {
    return warp_ == nullptr && (x - ball_center_).norm () <= ball_extent_ && groups_.keepsApart (face, other, x);
  }

  /** \brief The sharp surface that cuts the crease at x: its place in the field's options; -1 where there is none. */
  int
  sharpSurfaceAt (const Eigen::Vector3d &x);

  /** \brief The shape functions of the nodes in reach of x (eq. 19). */
  std::vector<ShapeFunction>
  shapeFunctions (const Eigen::Vector3d &x);

  /** \brief From now on give f as if walls and gaps between faces were at least so thick (a length before the warp).
   *
   * A grid then sees both sides of the thinnest wall. Vertices found so belong on the piece of f of their face.
   * \return what was in force before
   */
  double
  thicken (double least_wall)
  {
    return std::exchange (least_wall_, least_wall);
  }

  /** \brief How much a wall was thickened on either side at the point last evaluated. */
  double
  thickening () const
  {
    return thickening_;
  }

  /** \brief How far the nodes that the value at the point last evaluated is fitted to lie aside of it: their weighted
   * centroid, in their support radius. About 0.27 on the border of a face, more beyond. Zero where the faces of a thin
   * wall run out into an edge, which may lie far from nodes.
   */
  double
  aside () const
  {
    return runs_out_ ? 0.0 : centroid ().norm ();
  }

  /** \brief A number that differs between the two sides of a crease. */
  std::uint64_t
  sideKey () const
  {
    return side_key_;
  }

  /** \brief The face whose piece of f held at the point last evaluated; -1 where the field has no faces. */
  int
  face () const
  {
    return face_;
  }

  /** \brief Support radius and distance to the data of the last evaluation. */
  const Support &
  support () const
  {
    return support_;
  }

  /** \brief How long something of \a length near the point last evaluated was before the warp. */
  double
  unwarpedLength (double length) const
  {
    return warp_ != nullptr ? length * std::cbrt (std::abs (unwarping_.determinant ())) : length;
  }

  /** \brief Attributes at the point last evaluated: the nodes' own, by kernel weight. */
  void
  blendAttributes (float *attributes) const;

  /** \brief Evaluations so far, and the nodes they summed over. */
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
  enum class Task
  {
    VALUE,
    HEIGHTS, ///< the value, and what the fit says at the voters
    GRADIENT,
    SIDES, ///< value and gradient, seen from each of several places
    SLOPES_OF_SIDES,
    SHAPE_FUNCTIONS
  };

  /** \brief Select the support and the enrichment at x, then fit; false where f is undefined. */
  bool
  evaluate (const Eigen::Vector3d &x, Task task);

  /** \brief The same in the space the nodes are given in. */
  bool
  evaluateUnwarped (const Eigen::Vector3d &x, Task task);

  /** \brief Fit each face alone, then combine them as the nodes around x say. */
  bool
  evaluateFaces (const Eigen::Vector3d &x, Task task);

  void
  startVote (const Eigen::Vector3d &x, int groups);

  bool
  holdsOneFace ();

  bool
  selectGroups (const Eigen::Vector3d &x);

  bool
  fitSelected (const Eigen::Vector3d &x, Task task);

  int
  nearestFace () const;

  /** \brief Distance of the nearest value point in the support selected. */
  double
  nearestInSupport () const;

  void
  gatherUnwarped (const Eigen::Vector3d &center, double extent);

  void
  startGuess (const Eigen::Vector3d &center);

  /** \brief The point that the warp takes to \a x; local frames. */
  bool
  unwarp (const Eigen::Vector3d &x, Eigen::Vector3d &unwarped);

  /** \brief What sides that share a face say.
   * \param[in] group of the nodes around x; < 0: all of them
   * \param[in] of places in \a samples
   */
  void
  sampleTogether (const Eigen::Vector3d &x, int group, const std::vector<std::size_t> &of, Task task,
                  std::vector<LocalSample> &samples);

  template <typename BasisT>
  void
  fit (Task task);

  template <typename BasisT, int Size, int MaxSize>
  void
  fitWith (Task task);

  /** \brief Of the nodes of the support selected, from the point, in ε. */
  Eigen::Vector3d
  supportCentroid () const;

  /** \brief The same for the nodes of the face that holds at the point last evaluated. */
  Eigen::Vector3d
  centroid () const
  {
    return has_face_centroid_ ? face_centroid_ : supportCentroid ();
  }

  double
  borderOffset () const;

  const ImplicitField &field_;
  const SpaceWarp *warp_; // null: none
  Support support_;
  Enrichment enrichment_;
  Eigen::Vector3d ball_center_ = Eigen::Vector3d::Zero (); // gathered for, unwarped
  double ball_extent_ = 0.0;
  Eigen::Vector3d warped_center_ = Eigen::Vector3d::Zero (); // where the warp takes guess_
  Eigen::Vector3d guess_ = Eigen::Vector3d::Zero ();         // unwarped
  Eigen::Matrix3d unwarping_ = Eigen::Matrix3d::Identity (); // Jacobian of warp^-1 at the point last evaluated
  FaceGroups groups_;
  std::vector<int> slots_near_, places_near_; // for them
  FaceVote vote_;
  Eigen::Vector3d slope_ = Eigen::Vector3d::Zero (); // of the fit last asked for its heights
  std::vector<double> heights_;                      // of that fit at the voters
  Eigen::Vector3d face_centroid_ = Eigen::Vector3d::Zero ();
  bool has_face_centroid_ = false; // else it is that of the support
  bool runs_out_ = false;          // whether the point is in a wall thinner than the nodes are apart
  double least_wall_ = 0.0, thickening_ = 0.0;
  int face_ = -1;
  std::uint64_t side_key_ = 0;
  FieldSample result_;
  std::vector<Eigen::Vector3d> places_;   // that sides are seen from, in the input's frame, before the warp
  std::vector<FieldSample> side_results_; // from there
  std::vector<ShapeFunction> shape_functions_;
  std::size_t evaluations_ = 0, support_nodes_ = 0;
};

} // namespace erkpa
