// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "block_enrichment.h"
#include "block_faces.h"
#include "block_lattice.h"
#include "block_nodes.h"
#include "block_points.h"
#include "field_sketch.h"
#include "local_field.h"

#include <erkpa/implicit_field.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace erkpa
{

/** \brief The field at many points of one ball at once: LocalField's quick double, for what BlockFaces and
 * BlockEnrichment can do.
 *
 * Gathers the nodes around a ball, and hands them with the points to the vectors of the processor (lanes.h), in the
 * typical radius as unit. One object per thread.
 */
class BlockField
{
public:
  /** \param[in] lattice moments to interpolate where they cover a point; null: sums over the nodes everywhere */
  explicit BlockField (const ImplicitField &field, const lanes::Engine &engine = lanes::bestEngine (),
                       const MomentLattice *lattice = nullptr);

  /** \brief Whether fields with such settings are evaluated here at all. */
  static bool
  canEvaluate (const ImplicitField &field);

  /** \brief Decide what in-reach means: see lanes::Settings, and SupportSize::farthest (). */
  void
  setReach (double share, double offset, double near_enough, double farthest = HUGE_VAL);

  /** \brief See LocalField::thicken (). */
  void
  thicken (double least_wall)
  {
    faces_.thicken (least_wall);
  }

  /** \brief Say which surface f = \a level is looked for: without gradients, points that are clear of it then have the
   * value of all nodes alike where faces meet, and only its side of the level is that of the faces. */
  void
  setLevel (double level)
  {
    faces_.setLevel (level);
  }

  /** \brief Prepare for points within \a extent of \a center (local frame).
   * \param[in] on_surface whether they are expected on f = iso, more or less: fewer nodes will do
   * \return false where the field is none of canEvaluate (), or no nodes are in reach
   */
  bool
  gather (const Eigen::Vector3d &center, double extent, bool on_surface = false);

  /** \brief Whether a point is in the ball that was gathered for. */
  bool
  covers (const Eigen::Vector3d &x) const
  {
    return (x - center_).norm () <= extent_;
  }

  /** \brief Forget the points, then take up others. */
  void
  clearPoints ();

  /** \brief Take up a point of the ball that was gathered for.
   * \return false, and it is not taken up, where it cannot be evaluated here: the sharp surfaces in its reach decide
   */
  bool
  addPoint (const Eigen::Vector3d &x);

  std::size_t
  size () const
  {
    return places_.size ();
  }

  /** \brief Evaluate f at the points, and ∇f, border offsets and attributes where \a gradients are wanted. */
  void
  evaluate (bool gradients);

  /** \brief f; NaN where undefined. */
  double
  value (std::size_t point) const
  {
    return unit_ * static_cast<double> (at (point).values[placeOf (point)]);
  }

  /** \brief Whether a surface may be there: see setReach (). */
  bool
  isInReach (std::size_t point) const
  {
    return at (point).in_reach[placeOf (point)] != 0 && radius (point) <= farthest_;
  }

  /** \brief Whether value (but see setLevel ()) and gradient are as LocalField's; false also where f is undefined. */
  bool
  isSettled (std::size_t point) const
  {
    return at (point).states[placeOf (point)] == lanes::State::DEFINED;
  }

  bool
  isUnsettled (std::size_t point) const
  {
    return at (point).states[placeOf (point)] == lanes::State::UNSETTLED;
  }

  Eigen::Vector3d
  gradient (std::size_t point) const
  {
    const auto &gradients = at (point).gradients;
    const std::size_t i = placeOf (point);
    return {static_cast<double> (gradients[0][i]), static_cast<double> (gradients[1][i]),
            static_cast<double> (gradients[2][i])};
  }

  /** \brief ε. */
  double
  radius (std::size_t point) const
  {
    return unit_ * static_cast<double> (at (point).radii[placeOf (point)]);
  }

  double
  borderOffset (std::size_t point) const
  {
    return static_cast<double> (at (point).border_offsets[placeOf (point)]);
  }

  float
  attribute (std::size_t point, std::size_t channel) const
  {
    return at (point).attribute (placeOf (point), channel);
  }

  /** \brief See LocalField::face (); elsewhere that of the nearest node; -1 where the field has no faces. */
  int
  face (std::size_t point) const;

  /** \brief Whether pieces of the field on either side of creases may be had here at all. */
  static bool
  canSampleSides (const ImplicitField &field);

  /** \brief Take up a point, and sides whose pieces of f are wanted there.
   * \return false, and it is not taken up, where it is not in the ball, or cannot be evaluated here
   */
  bool
  addSides (const Eigen::Vector3d &x, const std::vector<Side> &sides);

  struct SideAnswer
  {
    FieldSample sample;      ///< undefined where the face is out of reach
    bool is_settled = false; ///< else ask LocalField
  };

  /** \brief LocalField::sampleOnSides () at all points, with nothing but addSides () taken up: side after side. */
  void
  sampleSides (LocalField::Slope slope, std::vector<SideAnswer> &answers);

  /** \brief See LocalField::keepsApart (). */
  bool
  keepsApart (int face, int other, const Eigen::Vector3d &x) const
  {
    return has_separations_ && covers (x) && faces_.groups ().keepsApart (face, other, x);
  }

  /** \brief Take up a point for sketch (), as if no sharp surface and no other face were near.
   * \return false with eq. (2): what the nodes ask for depends on the point, and their fit says nothing of other ones
   */
  bool
  addSketchPoint (const Eigen::Vector3d &x);

  /** \brief About how f goes on from such a point; false where it is undefined. */
  bool
  sketch (std::size_t point, FieldSketch &sketch) const;

  /** \brief See LocalField::sideKey (). */
  std::uint64_t
  sideKey (std::size_t point) const;

  /** \brief See LocalField::thickening (). */
  double
  thickening (std::size_t point) const;

  std::size_t
  evaluations () const
  {
    return evaluations_ + faces_.evaluations ();
  }

  std::size_t
  supportNodes () const
  {
    return support_nodes_ + faces_.supportNodes ();
  }

private:
  enum class Kind : std::uint8_t
  {
    PLAIN,
    ENRICHED,
    INTERPOLATED ///< from a lattice
  };

  /** \brief Where a point is kept, and as which. */
  struct Place
  {
    Kind kind;
    std::uint32_t index;
    int at_faces; ///< place among the points where faces are kept apart; -1 elsewhere
  };

  bool
  findReach (const Eigen::Vector3d &center, double extent, bool on_surface);

  /** \brief How far the support of a point goes, at most; with parts that of fits to some of the faces as well. */
  double
  reachAt (const Eigen::Vector3d &x, bool with_parts) const;

  void
  setRadii (BlockPoints &points) const;

  /** \brief Gather all nodes that any support of a point of the ball may hold. */
  void
  widen ();

  /** \brief Copy the nodes of the ball, unless they are there. */
  void
  copyNodes ();

  /** \param[in] attributes whether they are wanted, with gradients */
  void
  run (bool attributes);

  /** \brief The same again where ε was larger than expected. */
  void
  runAll (bool attributes);

  /** \brief Take up a point where no sharp surface but those between faces is near. */
  void
  addPlain (const Eigen::Vector3d &x, bool is_at_faces);

  void
  addEnriched (const Eigen::Vector3d &x, double reach);

  /** \brief What is wanted at a point: the piece of f that holds on a face. */
  struct SideQuestion
  {
    std::size_t point;
    int face;
  };

  /** \brief Whether the faces at a point have to tell its pieces of f. */
  bool
  isOfFaces (const SideQuestion &question) const
  {
    return places_[question.point].at_faces >= 0 && isSettled (question.point);
  }

  SideAnswer
  answerOf (std::size_t point, const BlockParts::Part *part, LocalField::Slope slope) const;

  /** \brief Take those points of the lattice that want sums over the nodes to the plain ones. */
  void
  takeUnsettled ();

  void
  finishPlain ();

  void
  finishEnriched ();

  void
  refuseUncovered (BlockPoints &points) const;

  const BlockPoints &
  at (std::size_t point) const
  {
    const Kind kind = places_[point].kind;
    return kind == Kind::PLAIN ? plain_ : kind == Kind::ENRICHED ? enriched_ : interpolated_;
  }

  std::size_t
  placeOf (std::size_t point) const
  {
    return places_[point].index;
  }

  const ImplicitField &field_;
  bool can_evaluate_;
  const lanes::Engine &engine_;
  double farthest_ = 0.0;      // supports with a surface in them
  double unit_, inverse_unit_; // of the lanes' lengths
  lanes::Settings settings_;
  BlockNodes nodes_;
  BlockFaces faces_;
  BlockEnrichment enrichment_;
  std::vector<Place> places_; // of the points
  BlockPoints plain_, enriched_, interpolated_;
  BlockLattice lattice_;
  bool has_nodes_ = false;
  bool has_separations_ = false;
  std::vector<std::uint32_t> at_faces_;      // of plain_
  std::vector<Eigen::Vector3d> enriched_at_; // local frame
  std::vector<Eigen::Vector3d> seen_from_;   // of sides: where each of them is seen from
  std::vector<SideQuestion> side_questions_;
  double enriched_reach_ = 0.0; // the largest of them
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero ();
  double extent_ = 0.0;        // of the ball
  double center_radius_ = 0.0; // ε in its middle, at most
  double trusted_ = 0.0;       // ε at its points, at most; but for State::SHORT
  double reach_ = 0.0;         // how far around it the nodes are gathered
  std::size_t evaluations_ = 0, support_nodes_ = 0;
};

} // namespace erkpa
