// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pencil.h"
#include "support.h"

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace erkpa
{

/** \brief The terms that sharp surfaces add to the reproduction vector, and those of the corners: θH(θ) (eq. 22), at a
 * pencil min (a⁺, b⁺); or, where the field may jump, H(θ), at a pencil H(a)H(b) and H(b)H(c).
 *
 * A surface is active at x where the support holds nodes on either side of it (paper, section 3.3). Where θH(θ) and
 * -θH(-θ) differ by a polynomial of the basis, the one is taken that is zero at x: the term then takes up what lies
 * beyond the sharp surface and leaves the value at x to the polynomials, which is kinder to terms that drop out.
 *
 * A kink comes with θ², where that is not in the basis. A smooth surface may be curved otherwise across the sharp
 * surface than along it, which the spherical basis cannot follow: the kink would, and leave a crease that the nodes
 * do not show.
 *
 * A term fades out with its presence: with the sharp surface it belongs to where that is limited, and θ² as well where
 * the nodes come to lie on one side.
 */
class Enrichment
{
public:
  /** \brief More terms than this are not used at one point; the first surfaces given go first. */
  static constexpr int MAX_TERMS = 30;

  /** \brief Terms of a smaller presence are not used. */
  static constexpr double MIN_PRESENCE = 1e-6;

  explicit Enrichment (const ImplicitField &field);

  /** \brief Evaluate θ and ∇θ at the gathered value points, for the surfaces that pass between them. */
  void
  gather (const Support &support);

  /** \brief Choose the active terms for the support selected at \a x, and evaluate θ(x). */
  void
  select (const Support &support, const Eigen::Vector3d &x);

  /** \brief See the evaluation point from the side of every sharp surface on which \a place lies (in the input's
   * frame): the terms go on smoothly beyond Γ. Null, and after select (): from where it is.
   */
  void
  lookFrom (const Eigen::Vector3d *place);

  /** \brief A number that says on which side of every active surface the evaluation point lies; 0 where none is active.
   */
  std::uint64_t
  sideKey () const;

  /** \brief How the key grows by an active surface; in the order of the field's surfaces. */
  static std::uint64_t
  extendSideKey (std::uint64_t key, int surface, bool is_below)
  {
    const auto side = 2 * static_cast<std::uint64_t> (surface) + (is_below ? 1 : 2);
    return (key ^ side) * 0x100000001b3ULL + 1; // FNV-1a
  }

  /** \brief The active surface nearest to the evaluation point, and |θ| there; -1 where none is active. */
  int
  nearestSurface (double &distance) const;

  /** \brief Number of active terms. */
  int
  size () const
  {
    return static_cast<int> (terms_.size ());
  }

  /** \brief The power of the length scale that a term goes with. */
  int
  degree (int term) const
  {
    return isSquare (term) ? 2 : jumps_ ? 0 : 1;
  }

  /** \brief Whether a term is a θ². */
  bool
  isSquare (int term) const
  {
    return terms_[static_cast<std::size_t> (term)].is_square;
  }

  /** \brief How much of a term is in force: 1, or less down to MIN_PRESENCE where it fades out. */
  double
  presence (int term) const
  {
    return terms_[static_cast<std::size_t> (term)].presence;
  }

  /** \brief ε∇ of it, for the support given to select (). */
  Eigen::Vector3d
  presenceGradient (int term, const Support &support) const;

  /** \brief Value and gradient of an active term at a gathered value point, in the scaled coordinates (θ/ε). */
  void
  atNode (int term, int slot, double radius, double &value, Eigen::Vector3d &gradient) const;

  /** \brief The same at the evaluation point. */
  void
  atPoint (int term, double radius, double &value, Eigen::Vector3d &gradient) const;

private:
  struct Theta
  {
    double value;
    Eigen::Vector3d gradient;
  };

  /** \brief A term of one near surface (second < 0), or of two that meet in a corner, with a third that goes by. */
  struct Term
  {
    int first, second, third;
    double scale_a, scale_b;
    bool open; ///< whether the side on which it is not zero lacks its boundary: H(0) = 1 (eq. 23) seen from behind
    bool is_square;
    double presence;
  };

  struct NearSurface
  {
    int surface;
    std::vector<Theta> at_nodes;
    Theta at_point;
    double at_place = 0.0; ///< θ where the point is looked at from
    bool active;
    double presence;           ///< of the surface at x
    double weight_below = 0.0; ///< of the support's nodes with θ < 0
    double weight_above = 0.0; ///< of those with θ > 0
  };

  void
  evaluateThetas (const Support &support, int surface);

  /** \brief θ and ∇θ of a costly surface at a value point: asked for once, then kept. */
  const Theta &
  knownTheta (const Support &support, int surface, std::size_t slot);

  /** \brief Weigh the support's nodes on either side of a near surface, and decide whether it is active. */
  void
  activate (NearSurface &near, const Support &support);

  int
  activeIndex (int surface) const;

  /** \brief Whether the terms of a near surface (< 0: none) may be seen from either side: 1 or θ is in the basis. */
  bool
  isReversible (int near) const;

  void
  addTerm (const Term &term);

  void
  addSquare (int near);

  /** \brief The share of the nodes that lie on the side of a near surface where there are fewer. */
  double
  balance (const NearSurface &near) const;

  Eigen::Vector3d
  balanceGradient (const NearSurface &near, const Support &support) const;

  Eigen::Vector3d
  surfacePresenceGradient (const NearSurface &near, const Support &support) const;

  const SharpSurface &
  surfaceOf (const NearSurface &near) const
  {
    return *field_.enrichingSurfaces ()[static_cast<std::size_t> (near.surface)];
  }

  bool
  isSecondLower (const Term &term, const Theta &a, const Theta &b, const Theta &third) const;

  void
  evaluate (const Term &term, const Theta &a, const Theta *b, const Theta *third, double radius, double &value,
            Eigen::Vector3d &gradient) const;

  void
  continueToPoint (const Term &term, double radius, double &value, Eigen::Vector3d &gradient) const;

  void
  addCornerTerms (const Pencil &pencil);

  const ImplicitField &field_;
  bool jumps_;
  std::vector<char> is_plane_;                                // per sharp surface: not seen through a warp
  std::vector<char> reversible_;                              // per sharp surface: see isReversible ()
  std::vector<char> squared_;                                 // per sharp surface: whether its kink comes with θ²
  std::vector<char> costly_;                                  // per sharp surface: whether known_ keeps its θ
  std::vector<std::unordered_map<std::size_t, Theta>> known_; // per sharp surface, by value index
  std::vector<Pencil> near_pencils_;
  std::vector<NearSurface> near_;
  std::size_t near_count_ = 0; // near_ keeps its memory from ball to ball
  std::vector<Term> terms_;
  bool is_continued_ = false;                           // looked at from another place
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero (); // selected for, in the input's frame
  double total_weight_ = 0.0;                           // of the support's nodes
};

/** \brief A number that differs between the sides of creases: of a face, and of what Enrichment::sideKey () says. */
inline std::uint64_t
sideKeyOf (int face, std::uint64_t enrichment = 0)
{
  return static_cast<std::uint64_t> (face + 1) << 40 ^ enrichment;
}

} // namespace erkpa
