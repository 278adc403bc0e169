// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_moments.h"
#include "lane_reach.h"
#include "lane_support.h"
#include "lane_term_sums.h"
#include "lane_terms.h"
#include "lane_weights.h"

namespace erkpa::lanes
{

/** \brief The value that a node asks for, as a share of ε.
 * \param[in] scale 1 / ε
 */
template <Constraint CONSTRAINT, typename B, typename WeightsT>
B
heightOf (const WeightsT &weights, std::size_t i, B scale, const B *u, const B *n)
{
  const B lambda = weights.lambda (i) * scale;
  return CONSTRAINT == Constraint::HERMITE ? lambda : lambda - dot (u, n); // eq. (2)
}

/** \brief M and b of eq. (17) for LaneEnrichedFit, but for the products of the gradients of polynomials. */
template <typename B, Basis BASIS, Constraint CONSTRAINT, template <typename> class KernelT, typename KinksT,
          typename SystemT>
class LaneEnrichedSums
{
public:
  using MomentsT = LaneMoments<B, BASIS, CONSTRAINT, KernelT>;

  /** \param kinks,system,reach are made */
  LaneEnrichedSums (const LaneSupport<B> &support, const LaneWeights<B, KernelT> &weights, KinksT &kinks,
                    SystemT &system, LaneReach<B> &reach)
      : support_ (support), weights_ (weights), kinks_ (kinks), system_ (system), reach_ (reach)
  {
  }

  /** \param moments with memory for sums */
  void
  sum (MomentsT &moments)
  {
    if constexpr (!IS_HERMITE)
      if (MomentsT::isNear (support_))
      {
        sumColumns (moments);
        return;
      }
    weights_.visitNodes (
        [this] (std::size_t i, B squared, B t, const B *u)
        {
          const B weight = weights_.weightAt (i, t);
          reach_.count (squared);
          kinks_.weigh (support_.node (i), weight);
          addNode (i, weight, u);
        });
    reach_.endOnSurface ();
  }

private:
  using TermsT = Terms<B, BASIS>;
  static constexpr bool IS_HERMITE = CONSTRAINT == Constraint::HERMITE;
  static constexpr int SIZE = TermsT::SIZE, MAX_SIZE = SIZE + KinksT::MAX_TERMS;

  /** \brief The same sums of weights times numbers; only eq. (2) has nothing but such. */
  void
  sumColumns (MomentsT &moments)
  {
    LaneTermSums<B, BASIS, typename MomentsT::ColumnsT, KinksT> sums (kinks_, support_);
    moments.sum (support_, [&sums] (const auto &columns, std::size_t first, std::size_t count)
                 { sums.add (columns, first, count); });
    reach_ = moments.reach (0);
    for (int s = 0; s < kinks_.surfaces (); ++s)
      kinks_.weighSides (s, sums.onSide (s, true), sums.onSide (s, false));
    const B shift[] = {support_.x (0), support_.x (1), support_.x (2)}; // from the origin of the lanes
    for (int j = 0; j < SIZE; ++j)
    {
      for (int k = 0; k <= j; ++k)
        system_.M[at (j, k)] = scaled (moments.system (0).M[at (j, k)], TermsT::degree (j) + TermsT::degree (k));
      system_.b[j] = scaled (moments.system (0).b[j], TermsT::degree (j) + 1);
    }
    for (int e = 0; e < kinks_.terms (); ++e)
    {
      const int degree = static_cast<int> (kinks_.degree (e));
      B *const row = system_.M + at (SIZE + e, 0);
      sums.withPolynomials (e, shift, row);
      for (int j = 0; j < SIZE; ++j)
        row[j] = scaled (row[j], TermsT::degree (j) + degree);
      for (int other = 0; other <= e; ++other)
        row[SIZE + other] = scaled (sums.withTerm (e, other), degree + static_cast<int> (kinks_.degree (other)));
      system_.b[SIZE + e] = scaled (sums.withHeight (e, shift), degree + 1);
    }
  }

  /** \brief From lengths to shares of ε, of which it goes with a power. */
  B
  scaled (B sum, int power) const
  {
    for (int i = 0; i < power; ++i)
      sum *= support_.inverse ();
    return sum;
  }

  void
  addNode (std::size_t i, B weight, const B *u)
  {
    const std::size_t node = support_.node (i);
    B n[3], R[MAX_SIZE], G[KinksT::MAX_TERMS][3];
    weights_.normal (i, n);
    TermsT::evaluate (u, dot (u, u), R);
    if constexpr (IS_HERMITE)
      TermsT::addNormal (weight, u, n, system_.b);
    const unsigned there = kinks_.evaluate (node, R + SIZE, G);
    const bool has_height = !IS_HERMITE || weights_.hasLambda ();
    const B height = heightOf<CONSTRAINT> (weights_, i, support_.inverse (), u, n);
    for (int j = 0; j < system_.size (); ++j)
    {
      if (j >= SIZE && (there >> (j - SIZE) & 1u) == 0)
        continue;
      const B wr = weight * R[j];
      for (int k = 0; k <= j; ++k)
        system_.M[at (j, k)] = xsimd::fma (wr, R[k], system_.M[at (j, k)]);
      if (has_height)
        system_.b[j] = xsimd::fma (wr, height, system_.b[j]);
      if (IS_HERMITE && j >= SIZE)
        addSlopesOf (j - SIZE, weight, u, n, G);
    }
  }

  /** \brief The products of the gradients of kink term e with those of the terms before it; polynomials' own follow
   * later. */
  void
  addSlopesOf (int e, B weight, const B *u, const B *n, const B (*G)[3])
  {
    const int j = SIZE + e;
    B weighted[3];
    for (int a = 0; a < 3; ++a)
      weighted[a] = weight * G[e][a];
    for (int a = 0; a < 3; ++a)
      system_.M[at (j, 1 + a)] += weighted[a];
    if constexpr (SIZE > 4)
      system_.M[at (j, 4)] = xsimd::fma (B (2.0f), dot (weighted, u), system_.M[at (j, 4)]);
    for (int other = 0; other <= e; ++other)
      system_.M[at (j, SIZE + other)] += dot (weighted, G[other]);
    system_.b[j] += dot (weighted, n);
  }

  const LaneSupport<B> &support_;
  const LaneWeights<B, KernelT> &weights_;
  KinksT &kinks_;
  SystemT &system_;
  LaneReach<B> &reach_;
};

} // namespace erkpa::lanes
