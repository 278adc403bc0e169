// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "enrichment.h"
#include "moment_system.h"
#include "pivot_floor.h"
#include "support.h"

#include <cmath>
#include <vector>

namespace erkpa
{

/** \brief The fit of the nodes in one support, and what it says at the support's centre x: f, ∇f, φ_i and ψ_i.
 *
 * Works in coordinates u = (y - x) / ε. What a node asks for depends on the constraint: the value λ_i, and in Hermite
 * form the gradient n_i as well; or Shen's functional value λ_i(x) = λ_i + (x - x_i)·n_i (eq. 2). The constant basis
 * has no gradient to fit: it takes the functional value for the Hermite constraint, too.
 *
 * \tparam BasisT polynomial part of the reproduction vector
 * \tparam Size number of terms with the enrichment, or Eigen::Dynamic
 */
template <typename BasisT, int Size, int MaxSize>
class FieldFit
{
public:
  using System = MomentSystem<Size, MaxSize>;
  using Vector = typename System::Vector;
  using Gradients = typename System::Gradients;

  FieldFit (const OrientedPoints &points, Constraint constraint, const Support &support, const Enrichment &enrichment)
      : points_ (points), fits_gradients_ (constraint == Constraint::HERMITE && BasisT::SIZE > 1),
        functional_ (constraint == Constraint::FUNCTIONAL || (constraint == Constraint::HERMITE && BasisT::SIZE == 1)),
        support_ (support), enrichment_ (enrichment), system_ (BasisT::SIZE + enrichment.size ()), R_ (system_.size ()),
        G_ (system_.size (), 3), floors_ (system_.size ()), fades_ (Vector::Zero (system_.size ()))
  {
    for (const SupportNode &node : support_.nodes ())
    {
      evaluateTerms (node);
      system_.addValue (node.weight, R_, lambda (node));
      if (fits_gradients_)
        system_.addGradient (node.weight / node.ratio, G_, normalOf (node));
    }
    setFloors ();
    setFades ();
    system_.factorize (floors_, fades_);
    lookAgain ();
  }

  /** \brief Take up that the enrichment looks at x from another side. */
  void
  lookAgain ()
  {
    evaluateTermsAtCenter ();
    shape_ = system_.solve (R_);
  }

  /** \brief f(x) = ε R(x)·M^-1 b (eq. 16, 18). */
  double
  value () const
  {
    return support_.radius () * shape_.dot (system_.rhs ());
  }

  /** \brief ∇f(x): of R, of the weights and the radius, and of the raised pivots. */
  Eigen::Vector3d
  gradient ()
  {
    evaluateTermsAtCenter ();
    const Vector c = system_.solve (system_.rhs ());
    Eigen::Vector3d result = G_.transpose () * c;
    // d(R·M^-1 b) = a·(db - dM c), a = M^-1 R: the residuals of the fit, weighted by ∇w. Then the share of the
    // gradient terms, which grows with ε².
    for (const SupportNode &node : support_.nodes ())
    {
      evaluateTerms (node);
      double residual = shape_.dot (R_) * (lambda (node) - c.dot (R_));
      if (fits_gradients_)
      {
        const double of_gradients = (G_.transpose () * shape_).dot (normalOf (node) - G_.transpose () * c) / node.ratio;
        residual += of_gradients;
        result += support_.growth () * (node.weight * of_gradients);
      }
      result += support_.weightGradient (node) * residual;
      if (functional_)
        result += node.weight * shape_.dot (R_) * normalOf (node); // ∇λ_i(x) = n_i
    }
    return result - gradientOfRaises (c) - turnOfRaises (shape_, c) - turnOfRaises (c, shape_);
  }

  /** \brief The gradient at x of the fitted combination, its coefficients held. */
  Eigen::Vector3d
  slope ()
  {
    evaluateTermsAtCenter ();
    return G_.transpose () * system_.solve (system_.rhs ());
  }

  /** \brief What the fit says at a gathered value point, u = (x_i - x) / ε. */
  double
  heightAt (int slot, const Eigen::Vector3d &u)
  {
    if (!has_coefficients_)
      coefficients_ = system_.solve (system_.rhs ());
    has_coefficients_ = true;
    evaluateTerms (slot, u);
    return support_.radius () * coefficients_.dot (R_);
  }

  /** \brief φ_i and ψ_i of all nodes in the support (eq. 19). */
  void
  shapeFunctions (std::vector<ShapeFunction> &functions)
  {
    for (const SupportNode &node : support_.nodes ())
    {
      evaluateTerms (node);
      ShapeFunction function;
      function.node = support_.pointOf (node).node;
      function.side = support_.pointOf (node).side;
      function.phi = node.weight * shape_.dot (R_);
      if (functional_)
        function.psi = -support_.radius () * function.phi * node.u;
      else if (fits_gradients_)
        function.psi = support_.radius () * node.weight / node.ratio * (G_.transpose () * shape_);
      functions.push_back (function);
    }
  }

private:
  static constexpr double FADE =
      0.1; // about a kink's pivot in the middle of an edge: it halves at a presence of one half

  Eigen::Vector3d
  normalOf (const SupportNode &node) const
  {
    return points_.normals[static_cast<std::size_t> (support_.pointOf (node).node)].cast<double> ();
  }

  double
  lambda (const SupportNode &node) const
  {
    const double lambda = support_.pointOf (node).lambda / support_.radius ();
    return functional_ ? lambda - node.u.dot (normalOf (node)) : lambda;
  }

  /** \brief R and ∂R at a node (eq. 15, 25). */
  void
  evaluateTerms (const SupportNode &node)
  {
    evaluateTerms (node.slot, node.u);
  }

  void
  evaluateTerms (int slot, const Eigen::Vector3d &u)
  {
    BasisT::evaluate (u, R_, G_);
    Eigen::Vector3d slope;
    for (int e = 0; e < enrichment_.size (); ++e)
    {
      enrichment_.atNode (e, slot, support_.radius (), R_[BasisT::SIZE + e], slope);
      G_.row (BasisT::SIZE + e) = slope.transpose ();
    }
  }

  void
  evaluateTermsAtCenter ()
  {
    BasisT::evaluate (Eigen::Vector3d::Zero (), R_, G_);
    Eigen::Vector3d slope;
    for (int e = 0; e < enrichment_.size (); ++e)
    {
      enrichment_.atPoint (e, support_.radius (), R_[BasisT::SIZE + e], slope);
      G_.row (BasisT::SIZE + e) = slope.transpose ();
    }
  }

  int
  degree (int term) const
  {
    return term < BasisT::SIZE ? BasisT::degree (term) : enrichment_.degree (term - BasisT::SIZE);
  }

  PivotFloor
  floorOf (int term) const
  {
    const bool is_polynomial = term < BasisT::SIZE || enrichment_.isSquare (term - BasisT::SIZE);
    return is_polynomial ? floorOfPolynomial (degree (term), functional_) : floorOfEnrichment (fits_gradients_);
  }

  void
  setFloors ()
  {
    for (const SupportNode &node : support_.nodes ())
      centroid_ += node.weight / system_.totalWeight () * node.u;
    for (const SupportNode &node : support_.nodes ())
      spread_ += node.weight * (node.u - centroid_).squaredNorm ();
    const double weight = system_.totalWeight ();
    for (int j = 0; j < system_.size (); ++j)
    {
      const PivotFloor floor = floorOf (j);
      double reference = floor.of == PivotFloor::Of::MOMENT ? system_.moment (j) : weight;
      for (int p = 0; p < degree (j) && floor.of == PivotFloor::Of::SPREAD; ++p)
        reference *= spread_ / weight;
      floors_[j] = floor.share * reference;
    }
  }

  /** \brief A term that is present by p has its pivot raised by W FADE ((1 - p) / p)²: not at all in full force, and
   * without limit, so that its coefficient goes to zero, as p does. */
  void
  setFades ()
  {
    for (int e = 0; e < enrichment_.size (); ++e)
      if (const double p = enrichment_.presence (e); p < 1.0)
        fades_[BasisT::SIZE + e] = FADE * system_.totalWeight () * (1.0 - p) * (1.0 - p) / (p * p);
  }

  /** \brief ∇ of how much the pivot of a term is raised because it fades. */
  Eigen::Vector3d
  gradientOfFade (int term) const
  {
    const double p = enrichment_.presence (term - BasisT::SIZE), weight = system_.totalWeight ();
    Eigen::Vector3d of_weight = Eigen::Vector3d::Zero ();
    for (const SupportNode &node : support_.nodes ())
      of_weight += support_.weightGradient (node);
    const double by_presence = -2.0 * FADE * weight * (1.0 - p) / (p * p * p);
    return fades_[term] / weight * of_weight +
           by_presence * enrichment_.presenceGradient (term - BasisT::SIZE, support_);
  }

  /** \brief Σ_j a_j c_j ∇ρ_j over the raised pivots.
   *
   * ρ_j depends on x through its pivot and its floor. pivot_j = v^T M v with v the residual of term j, so
   * ∇pivot_j = v^T ∇M v + Σ_(k<j) v_k² ∇ρ_k. All is taken in the frame of x; a term of degree p scales with ε^p.
   */
  Eigen::Vector3d
  gradientOfRaises (const Vector &c)
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
    std::vector<Eigen::Vector3d> of_raise (static_cast<std::size_t> (system_.size ()), sum);
    const Eigen::Vector3d &scale = support_.radiusGradient (); // ∇ε / ε in units of 1/ε
    for (int j = 0; j < system_.size (); ++j)
    {
      Eigen::Vector3d &of_this = of_raise[static_cast<std::size_t> (j)];
      if (fades_[j] > 0.0)
        of_this += gradientOfFade (j) + 2.0 * degree (j) * fades_[j] * scale;
      if (system_.raise (j) > 0.0)
        of_this += gradientOfRaise (j, of_raise);
      sum += shape_[j] * c[j] * of_this;
    }
    return sum;
  }

  /** \brief ∇ρ_j, from those of the terms before it. */
  Eigen::Vector3d
  gradientOfRaise (int j, const std::vector<Eigen::Vector3d> &of_raise)
  {
    const Eigen::Vector3d &scale = support_.radiusGradient ();
    const Vector v = system_.residualOfTerm (j);
    const double power = 2.0 * degree (j);
    Eigen::Vector3d of_pivot, of_floor;
    gradientsOfPivot (j, v, of_pivot, of_floor);
    of_pivot += 2.0 * turnOfRaises (v, v) - power * system_.pivot (j) * scale;
    if (floorOf (j).of != PivotFloor::Of::WEIGHT)
      of_floor -= power * floors_[j] * scale;
    for (int k = 0; k < j; ++k)
      of_pivot += v[k] * v[k] * of_raise[static_cast<std::size_t> (k)];
    // ρ is homogeneous of degree one in pivot and floor: ∂ρ/∂floor = (ρ - ρ' pivot) / floor.
    const double by_floor = (system_.raise (j) - system_.raiseSlope (j) * system_.pivot (j)) / floors_[j];
    return system_.raiseSlope (j) * of_pivot + by_floor * of_floor + power * system_.raise (j) * scale;
  }

  /** \brief Σ_i a_i H_i (ρ∘b) over the squares R_i with Hessian H_i and the linear terms' ρ and b.
   *
   * ρ stands on the coefficients in the frame of x. As x moves, squares turn into squares and linear terms, so where
   * linear terms are raised the frame itself moves f.
   */
  Eigen::Vector3d
  turnOfRaises (const Vector &a, const Vector &b)
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
    if constexpr (BasisT::SIZE > LinearBasis::SIZE)
      for (int axis = 0; axis < 3; ++axis)
      {
        if (!(system_.raise (1 + axis) > 0.0))
          continue;
        BasisT::evaluate (Eigen::Vector3d::Unit (axis), R_, G_); // a row of H_i each, as G is linear in u
        for (int i = LinearBasis::SIZE; i < BasisT::SIZE; ++i)
          sum += a[i] * system_.raise (1 + axis) * b[1 + axis] * G_.row (i).transpose ();
      }
    return sum;
  }

  /** \brief The parts of ∇pivot_j and of the gradient of its floor that come from the weights. */
  void
  gradientsOfPivot (int j, const Vector &v, Eigen::Vector3d &of_pivot, Eigen::Vector3d &of_floor)
  {
    of_pivot.setZero ();
    of_floor.setZero ();
    for (const SupportNode &node : support_.nodes ())
    {
      evaluateTerms (node);
      const double height = v.dot (R_);
      const Eigen::Vector3d change = support_.weightGradient (node);
      of_pivot += change * (height * height);
      of_floor += change * floorSlope (j, node);
      if (!fits_gradients_)
        continue;
      const double slopes = (G_.transpose () * v).squaredNorm () / node.ratio;
      of_pivot += change * slopes + support_.growth () * (node.weight * slopes);
    }
  }

  /** \brief What the floor of term j gains with the weight of a node, whose terms are in R_. */
  double
  floorSlope (int j, const SupportNode &node) const
  {
    const PivotFloor floor = floorOf (j);
    const double weight = system_.totalWeight (), p = degree (j);
    switch (floor.of)
    {
      case PivotFloor::Of::MOMENT:
        return floor.share * R_[j] * R_[j];
      case PivotFloor::Of::SPREAD:
        return floors_[j] * ((1.0 - p) / weight + p * (node.u - centroid_).squaredNorm () / spread_);
      case PivotFloor::Of::WEIGHT:
        break;
    }
    return floor.share;
  }

  const OrientedPoints &points_;
  bool fits_gradients_; // Hermite
  bool functional_;     // eq. (2)
  const Support &support_;
  const Enrichment &enrichment_;
  System system_;
  Vector R_;                                            // terms at the node or point last visited
  Gradients G_;                                         // their gradients
  Vector floors_;                                       // of the pivots
  Vector fades_;                                        // how much they are raised whatever they are
  Eigen::Vector3d centroid_ = Eigen::Vector3d::Zero (); // of the weighted nodes
  double spread_ = 0.0;                                 // Σ w |u - centroid|²
  Vector shape_;                                        // M^-1 R(x)
  Vector coefficients_;                                 // M^-1 b
  bool has_coefficients_ = false;
};

} // namespace erkpa
