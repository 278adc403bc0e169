// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "enrichment.h"
#include "moment_system.h"
#include "support.h"

#include <erkpa/kernel.h>

#include <cmath>
#include <vector>

namespace erkpa
{

/** \brief The fit of the nodes in one support, and what it says at the support's centre x: f, ∇f, φ_i and ψ_i.
 *
 * Works in coordinates u = (y - x) / ε, where a node has the value λ_i = 0 and the gradient n_i. The constant basis
 * has no gradient to fit: there the value of a node is Shen's functional constraint λ_i(x) = (x - x_i)·n_i (eq. 2).
 *
 * \tparam BasisT polynomial part of the reproduction vector
 * \tparam Size number of terms with the enrichment, or Eigen::Dynamic
 */
template <typename BasisT, int Size, int MaxSize>
class HermiteFit
{
public:
  using System = MomentSystem<Size, MaxSize>;
  using Vector = typename System::Vector;
  using Gradients = typename System::Gradients;

  HermiteFit (const OrientedPoints &points, const Support &support, const Enrichment &enrichment)
      : points_ (points), support_ (support), enrichment_ (enrichment), system_ (BasisT::SIZE + enrichment.size ()),
        R_ (system_.size ()), G_ (system_.size (), 3)
  {
    for (const SupportNode &node : support_.nodes ())
    {
      evaluateTerms (node);
      system_.add (node.weight, R_, G_, lambda (node), normalOf (node));
    }
    system_.factorize (thresholds ());
    evaluateTermsAtCenter ();
    shape_ = system_.solve (R_);
  }

  /** \brief f(x) = ε R(x)·M^-1 b (eq. 18). */
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
    const Eigen::Vector3d growth = 2.0 * support_.radiusGradient ();
    for (const SupportNode &node : support_.nodes ())
    {
      evaluateTerms (node);
      const Eigen::Vector3d normal = normalOf (node);
      const double of_values = shape_.dot (R_) * (lambda (node) - c.dot (R_));
      const double of_gradients = (G_.transpose () * shape_)
                                      .dot (usesFunctionalValues () ? Eigen::Vector3d (Eigen::Vector3d::Zero ())
                                                                    : Eigen::Vector3d (normal - G_.transpose () * c));
      result += weightGradient (node) * (of_values + of_gradients) + growth * (node.weight * of_gradients);
      if (usesFunctionalValues ())
        result += node.weight * shape_.dot (R_) * normal; // ∇λ_i(x) = n_i
    }
    return result - gradientOfRaises (c);
  }

  /** \brief φ_i and ψ_i of all nodes in the support (eq. 19). */
  void
  shapeFunctions (std::vector<ShapeFunction> &functions)
  {
    for (const SupportNode &node : support_.nodes ())
    {
      evaluateTerms (node);
      ShapeFunction function;
      function.node = support_.candidates ()[static_cast<std::size_t> (node.slot)];
      function.phi = node.weight * shape_.dot (R_);
      if (usesFunctionalValues ())
        function.psi = -support_.radius () * function.phi * node.u;
      else
        function.psi = support_.radius () * node.weight * (G_.transpose () * shape_);
      functions.push_back (function);
    }
  }

private:
  static constexpr bool
  usesFunctionalValues ()
  {
    return BasisT::SIZE == 1;
  }

  Eigen::Vector3d
  normalOf (const SupportNode &node) const
  {
    const int i = support_.candidates ()[static_cast<std::size_t> (node.slot)];
    return points_.normals[static_cast<std::size_t> (i)].cast<double> ();
  }

  double
  lambda (const SupportNode &node) const
  {
    return usesFunctionalValues () ? -node.u.dot (normalOf (node)) : 0.0;
  }

  /** \brief R and ∂R at a node (eq. 15, 25). */
  void
  evaluateTerms (const SupportNode &node)
  {
    BasisT::evaluate (node.u, R_, G_);
    Eigen::Vector3d slope;
    for (int e = 0; e < enrichment_.size (); ++e)
    {
      enrichment_.atNode (e, node.slot, support_.radius (), R_[BasisT::SIZE + e], slope);
      G_.row (BasisT::SIZE + e) = slope.transpose ();
    }
    if (usesFunctionalValues ())
      G_.setZero ();
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
    return term < BasisT::SIZE ? BasisT::degree (term) : 1;
  }

  /** \brief Shares of the weight below which a term counts as undetermined. A smaller one keeps an enrichment exact up
   * to fewer nodes beyond its surface, a larger one fades it over a longer way: on the edges of a box |f| was measured
   * to stay below a third of the share, in units of ε. */
  Vector
  thresholds () const
  {
    constexpr double OF_DEGREE[] = {0.0, 1e-10, 1e-4};
    constexpr double OF_ENRICHMENT = 2e-5;
    Vector thresholds (system_.size ());
    for (int j = 0; j < system_.size (); ++j)
      thresholds[j] = j < BasisT::SIZE ? OF_DEGREE[degree (j)] : OF_ENRICHMENT;
    return thresholds;
  }

  /** \brief ∇w of a node with respect to x: w'(t) ∇t, with t = |x_i - x| / ε(x). */
  Eigen::Vector3d
  weightGradient (const SupportNode &node) const
  {
    const double slope = PaperKernel::derivativeOverT (node.t);
    return slope * (-node.u - node.t * node.t * support_.radiusGradient ());
  }

  /** \brief Σ_j a_j c_j ∇ρ_j over the raised pivots.
   *
   * ρ_j depends on x through its pivot and the total weight. pivot_j = v^T M v with v the residual of term j, so
   * ∇pivot_j = v^T ∇M v + Σ_(k<j) v_k² ∇ρ_k. All is taken in the frame of x; a term of degree p scales with ε^p.
   */
  Eigen::Vector3d
  gradientOfRaises (const Vector &c)
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
    std::vector<Eigen::Vector3d> of_raise (static_cast<std::size_t> (system_.size ()), sum);
    const Eigen::Vector3d scale = support_.radiusGradient (); // ∇ε / ε in units of 1/ε
    const Vector floors = thresholds ();
    for (int j = 0; j < system_.size (); ++j)
    {
      if (!(system_.raise (j) > 0.0))
        continue;
      const Vector v = system_.residualOfTerm (j);
      Eigen::Vector3d of_pivot = -2.0 * degree (j) * system_.pivot (j) * scale;
      Eigen::Vector3d of_weight = Eigen::Vector3d::Zero ();
      for (const SupportNode &node : support_.nodes ())
      {
        evaluateTerms (node);
        const double slopes = (G_.transpose () * v).squaredNorm (), height = v.dot (R_);
        const Eigen::Vector3d change = weightGradient (node);
        of_pivot += change * (height * height + slopes) + 2.0 * scale * (node.weight * slopes);
        of_weight += change;
      }
      for (int k = 0; k < j; ++k)
        of_pivot += v[k] * v[k] * of_raise[static_cast<std::size_t> (k)];
      // ρ is homogeneous of degree one in pivot and floor: ∂ρ/∂floor = (ρ - ρ' pivot) / floor.
      const double floor = floors[j] * system_.totalWeight ();
      const double of_floor = (system_.raise (j) - system_.raiseSlope (j) * system_.pivot (j)) / floor;
      of_raise[static_cast<std::size_t> (j)] = system_.raiseSlope (j) * of_pivot + of_floor * floors[j] * of_weight +
                                               2.0 * degree (j) * system_.raise (j) * scale;
      sum += shape_[j] * c[j] * of_raise[static_cast<std::size_t> (j)];
    }
    return sum;
  }

  const OrientedPoints &points_;
  const Support &support_;
  const Enrichment &enrichment_;
  System system_;
  Vector R_;     // terms at the node or point last visited
  Gradients G_;  // their gradients
  Vector shape_; // M^-1 R(x)
};

} // namespace erkpa
