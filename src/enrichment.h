// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "support.h"

#include <array>
#include <vector>

namespace erkpa
{

/** \brief Three sharp surfaces through one line, as three faces that meet in a corner give.
 *
 * With a = scale_a θ_a and b = scale_b θ_b the third is a - b up to its own scale. Max, min and saddle of the three
 * faces differ from combinations of the θ⁺ by one function only: min (a⁺, b⁺).
 */
struct Pencil
{
  std::array<int, 3> surfaces;
  double scale_a, scale_b;
};

/** \brief The pencils among planes: triples that share a line to within \a tolerance (a length). Planes seen through
 * the same warp share the warped line. */
std::vector<Pencil>
findPencils (const std::vector<SharpSurface::ConstPtr> &surfaces, double tolerance);

/** \brief The terms that sharp surfaces add to the reproduction vector, and those of the corners: θH(θ) (eq. 22), at a
 * pencil min (a⁺, b⁺); or, where the field may jump, H(θ), at a pencil H(a)H(b) and H(b)H(c).
 *
 * A surface is active at x where the support holds nodes on either side of it (paper, section 3.3). Where θH(θ) and
 * -θH(-θ) differ by a polynomial of the basis, the one is taken that is zero at x: the term then takes up what lies
 * beyond the sharp surface and leaves the value at x to the polynomials, which is kinder to terms that drop out.
 */
class Enrichment
{
public:
  /** \brief More terms than this are not used at one point; the first surfaces given go first. */
  static constexpr int MAX_TERMS = 30;

  explicit Enrichment (const ImplicitField &field);

  /** \brief Evaluate θ and ∇θ at the gathered value points, for the surfaces that pass between them. */
  void
  gather (const Support &support);

  /** \brief Choose the active terms for the support selected at \a x, and evaluate θ(x). */
  void
  select (const Support &support, const Eigen::Vector3d &x);

  /** \brief Number of active terms. */
  int
  size () const
  {
    return static_cast<int> (terms_.size ());
  }

  /** \brief The power of the length scale that the terms go with. */
  int
  degree () const
  {
    return jumps_ ? 0 : 1;
  }

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

  /** \brief A term of one near surface (second < 0), or of two that meet in a corner. */
  struct Term
  {
    int first, second;
    double scale_a, scale_b;
    bool open; ///< whether the side on which it is not zero lacks its boundary: H(0) = 1 (eq. 23) seen from behind
  };

  struct NearSurface
  {
    int surface;
    std::vector<Theta> at_nodes;
    Theta at_point;
    bool active;
  };

  void
  evaluateThetas (const Support &support, int surface);

  int
  activeIndex (int surface) const;

  /** \brief Whether the terms of a near surface (< 0: none) may be seen from either side: 1 or θ is in the basis. */
  bool
  isReversible (int near) const;

  void
  addTerm (int first, int second, double scale_a, double scale_b);

  void
  evaluate (const Term &term, const Theta &a, const Theta *b, double radius, double &value,
            Eigen::Vector3d &gradient) const;

  void
  addCornerTerms (const Pencil &pencil);

  const ImplicitField &field_;
  bool jumps_;
  std::vector<char> reversible_; // per sharp surface
  std::vector<Pencil> near_pencils_;
  std::vector<NearSurface> near_;
  std::size_t near_count_ = 0; // near_ keeps its memory from ball to ball
  std::vector<Term> terms_;
};

} // namespace erkpa
