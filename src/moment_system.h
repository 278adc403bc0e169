// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <utility>

namespace erkpa
{

/** \brief The moment matrix M(x) of eq. (17) and its solution.
 *
 * Around x the field is the combination c·R of the reproduction vector R (eq. 15) that minimises
 *   Σ_i w_i (c·R(x_i) - λ_i)²  and, where gradients are fitted,  + Σ_i w_i Σ_a (c·∂_aR(x_i) - n_i,a)²,
 * in coordinates centred on x and scaled by the support radius. Its normal equations are M c = b with
 *   M = Σ_i w_i (R R^T + Σ_a ∂_aR ∂_aR^T),   b = Σ_i w_i (R λ_i + Σ_a ∂_aR n_i,a).
 * The paper writes M with B(x, x_i) on the right, which is not symmetric but gives the same shape functions.
 *
 * A term that the nodes do not determine (an enrichment whose support holds nodes on one side only, a square on
 * a flat patch) has a vanishing pivot. Each pivot that falls below a floor is raised, the more the smaller it
 * is: the term's coefficient then goes to zero continuously, and with it the term drops out without a jump in f.
 *
 * \tparam Size number of terms, or Eigen::Dynamic
 * \tparam MaxSize upper bound of the number of terms
 */
template <int Size, int MaxSize = Size>
class MomentSystem
{
public:
  using Vector = Eigen::Matrix<double, Size, 1, 0, MaxSize, 1>;
  using Gradients = Eigen::Matrix<double, Size, 3, Size == 1 ? Eigen::RowMajor : Eigen::ColMajor, MaxSize, 3>;
  using Matrix = Eigen::Matrix<double, Size, Size, 0, MaxSize, MaxSize>;

  explicit MomentSystem (int size)
      : moments_ (Matrix::Zero (size, size)), rhs_ (Vector::Zero (size)), pivots_ (size), raise_ (size), slope_ (size)
  {
  }

  int
  size () const
  {
    return static_cast<int> (rhs_.size ());
  }

  /** \brief Adds the value λ of one node: R at the node, and its weight. */
  void
  addValue (double weight, const Vector &R, double lambda)
  {
    const int n = size ();
    total_weight_ += weight;
    for (int j = 0; j < n; ++j)
    {
      const double wr = weight * R[j];
      for (int i = j; i < n; ++i)
        moments_ (i, j) += wr * R[i];
      rhs_[j] += wr * lambda;
    }
  }

  /** \brief Adds the gradient n of one node: ∂R (columns) at the node, and its weight. */
  void
  addGradient (double weight, const Gradients &G, const Eigen::Vector3d &normal)
  {
    const int n = size ();
    for (int j = 0; j < n; ++j)
    {
      const double w0 = weight * G (j, 0), w1 = weight * G (j, 1), w2 = weight * G (j, 2);
      for (int i = j; i < n; ++i)
        moments_ (i, j) += w0 * G (i, 0) + w1 * G (i, 1) + w2 * G (i, 2);
      rhs_[j] += w0 * normal[0] + w1 * normal[1] + w2 * normal[2];
    }
  }

  /** \brief M_jj, before factorize(). */
  double
  moment (int j) const
  {
    return moments_ (j, j);
  }

  /** \brief M = L D L^T without pivoting, polynomials first, so that each pivot is what the nodes say about a term
   * beyond the terms before it.
   * \param[in] floors per term, below which its pivot is raised
   * \param[in] fades per term, by how much its pivot is raised whatever it is; zero for a term in full force
   */
  void
  factorize (const Vector &floors, const Vector &fades)
  {
    const int n = size ();
    for (int j = 0; j < n; ++j)
    {
      raisePivot (j, moments_ (j, j), floors[j]);
      moments_ (j, j) += fades[j];
      const double inverse = 1.0 / moments_ (j, j);
      for (int k = j + 1; k < n; ++k)
      {
        const double factor = moments_ (k, j) * inverse;
        for (int i = k; i < n; ++i)
          moments_ (i, k) -= moments_ (i, j) * factor;
      }
      for (int i = j + 1; i < n; ++i)
        moments_ (i, j) *= inverse;
    }
  }

  /** \brief M^-1 r, after factorize(). */
  Vector
  solve (const Vector &r) const
  {
    const int n = size ();
    Vector v = r;
    for (int j = 0; j < n; ++j)
      for (int i = j + 1; i < n; ++i)
        v[i] -= moments_ (i, j) * v[j];
    for (int j = 0; j < n; ++j)
      v[j] /= moments_ (j, j);
    backSubstitute (v, n - 1);
    return v;
  }

  /** \brief The vector v with pivot_j = v^T M v: what is left of term j after the fit of the terms before it. */
  Vector
  residualOfTerm (int j) const
  {
    Vector v = Vector::Zero (size ());
    v[j] = 1.0;
    backSubstitute (v, j);
    return v;
  }

  /** \brief b of the normal equations. */
  const Vector &
  rhs () const
  {
    return rhs_;
  }

  double
  totalWeight () const
  {
    return total_weight_;
  }

  /** \brief The pivot of term j before it was raised. */
  double
  pivot (int j) const
  {
    return pivots_[j];
  }

  /** \brief How much the pivot of term j was raised for its floor: ρ_j; zero for a term the nodes determine. */
  double
  raise (int j) const
  {
    return raise_[j];
  }

  /** \brief dρ_j / dpivot_j. */
  double
  raiseSlope (int j) const
  {
    return slope_[j];
  }

private:
  /** \brief pivot -> pivot + ρ, ρ = floor (1 - t)² / t with t = pivot / floor < 1: C1, and infinite at t = 0. */
  void
  raisePivot (int j, double &pivot, double floor)
  {
    pivots_[j] = pivot;
    raise_[j] = slope_[j] = 0.0;
    if (!(floor > 0.0) && !(pivot > 0.0))
      pivot = 1.0; // a term that is zero at all nodes: its coefficient is zero whatever its pivot
    if (pivot >= floor)
      return;
    const double t = std::max (pivot / floor, 1e-9);
    raise_[j] = floor * (1.0 - t) * (1.0 - t) / t;
    slope_[j] = t > 1e-9 ? 1.0 - 1.0 / (t * t) : 0.0;
    pivot = floor * t + raise_[j];
  }

  /** \brief v <- L^-T v, for a v that is zero beyond \a last. */
  void
  backSubstitute (Vector &v, int last) const
  {
    for (int j = last - 1; j >= 0; --j)
      for (int i = j + 1; i <= last; ++i)
        v[j] -= moments_ (i, j) * v[i];
  }

  Matrix moments_; // lower triangle: M, then L and D
  Vector rhs_;
  Vector pivots_, raise_, slope_;
  double total_weight_ = 0.0;
};

} // namespace erkpa
