// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_kernel.h"
#include "lane_support.h"
#include "lane_terms.h"

namespace erkpa::lanes
{

/** \brief FieldFit with kinks in lanes, for the Hermite constraint: after the polynomials a term θH(θ) for every sharp
 * surface, then their θ². See Enrichment for what they are and when they count; a lane where a term does not count has
 * zeros for it.
 */
template <typename B, Basis BASIS, template <typename> class KernelT>
class LaneEnrichedFit
{
public:
  using Mask = decltype (B () < B ());
  static constexpr int SIZE = Terms<B, BASIS>::SIZE;
  static constexpr bool IS_ENRICHED = true;

  /** \param[in] first place of the evaluation point in the first lane */
  LaneEnrichedFit (const Settings &settings, const Nodes &nodes, const SharpSurfaces &sharp, std::size_t first,
                   const LaneSupport<B> &support)
      : settings_ (settings), nodes_ (nodes), sharp_ (sharp), support_ (support), kernel_ (settings.kernel),
        scale_ (support.inverse ()), kinks_ (static_cast<int> (sharp.count))
  {
    for (int s = 0; s < kinks_; ++s)
      seeFrom (first, s);
    sumMoments ();
    TermsT::addGradientMoments (M_);
    for (int s = 0; s < kinks_; ++s)
      activate (s);
    for (int a = 0; a < 3; ++a)
      centroid_[a] = M_[at (1 + a, 0)] / weight_;
    factorize ();
    for (int j = 0; j < size (); ++j)
      c_[j] = b_[j];
    solve (c_);
  }

  Mask
  isDefined () const
  {
    return in_support_ >= B (static_cast<float> (settings_.min_nodes)) && weight_ > B (0.0f);
  }

  B
  value () const
  {
    B sum = c_[0];
    for (int j = SIZE; j < size (); ++j)
      sum = xsimd::fma (c_[j], at_x_[j], sum);
    return support_.radius () * sum;
  }

  B
  supportNodes () const
  {
    return in_support_;
  }

  Mask
  isInReach () const
  {
    const B quarter = xsimd::floor (on_surface_ * B (0.25f));
    return in_quarter_ > quarter || nearest_ <= B (settings_.near_enough * settings_.near_enough);
  }

  B
  nearestNode () const
  {
    return nearest_node_;
  }

  B
  nearestDistance () const
  {
    return xsimd::sqrt (nearest_);
  }

  B
  aside () const
  {
    return xsimd::sqrt (dot (centroid_, centroid_));
  }

  int
  surfaces () const
  {
    return kinks_;
  }

  /** \brief 1 where a sharp surface passes between the nodes of the support. */
  B
  isActive (int surface) const
  {
    return active_[surface];
  }

  /** \brief ∇f(x); see FieldFit::gradient (). */
  void
  gradient (const B *radius_gradient, B *gradient)
  {
    for (int a = 0; a < 3; ++a)
      growth_[a] = B (2.0f) * radius_gradient[a];
    for (int j = 0; j < size (); ++j)
      a_[j] = at_x_[j];
    solve (a_);
    Change all, below[MAX_SURFACES], above[MAX_SURFACES];
    B by_u[3] = {B (0.0f), B (0.0f), B (0.0f)}, by_radius (0.0f);
    for (std::size_t i = 0; i < support_.size (); ++i)
      addResidual (support_.node (i), by_u, by_radius, all, below, above);
    for (int a = 0; a < 3; ++a)
      gradient[a] = xsimd::fma (growth_[a], by_radius, c_[1 + a] - by_u[a]);
    for (int s = 0; s < kinks_; ++s)
    {
      addSlopes (s, gradient);
      subtractFade (s, radius_gradient, all, below[s], above[s], gradient);
    }
  }

  /** \brief Where corners would have terms of their own, or a pivot that is raised moves the gradient. */
  Mask
  isUnsettled () const
  {
    constexpr float NEGLIGIBLE = 1e-5f;
    Mask unsettled = isAtCorner ();
    for (int j = 1; j < size (); ++j)
      unsettled =
          unsettled || xsimd::abs (a_[j] * c_[j] * raises_[j]) > B (NEGLIGIBLE); // a term that is zero has no part
    return unsettled;
  }

  /** \brief Where three sharp surfaces meet. */
  Mask
  isAtCorner () const
  {
    Mask corner = B (0.0f) > B (1.0f);
    for (std::size_t p = 0; p < sharp_.pencil_count; ++p)
    {
      const int *of = sharp_.pencils[p];
      corner = corner || active_[of[0]] * active_[of[1]] * active_[of[2]] > B (0.5f);
    }
    return corner;
  }

  B
  borderOffset (const B *gradient) const
  {
    const B squared = dot (gradient, gradient), along = dot (centroid_, gradient) / squared;
    B across[3];
    for (int a = 0; a < 3; ++a)
      across[a] = xsimd::fnma (along, gradient[a], centroid_[a]);
    return xsimd::select (squared > B (0.0f), xsimd::sqrt (dot (across, across)), B (3e38f));
  }

  B
  blend (const float *attribute) const
  {
    B sum (0.0f);
    for (std::size_t i = 0; i < support_.size (); ++i)
    {
      const std::size_t node = support_.node (i);
      B d[3], t;
      sum = xsimd::fma (weightOf (support_.offset (node, d), node, t), B (attribute[node]), sum);
    }
    return sum / weight_;
  }

private:
  using TermsT = Terms<B, BASIS>;
  static constexpr int MAX_SIZE = SIZE + 2 * static_cast<int> (MAX_SURFACES);
  static constexpr float LEAST_BALANCE = 0.2f, FADE = 0.1f, MIN_PRESENCE = 1e-6f; // see Enrichment and FieldFit

  /** \brief A sum of changes of weights with x: Σ w' u and Σ w' t², w' = dw/dt / t. */
  struct Change
  {
    B by_u[3] = {B (0.0f), B (0.0f), B (0.0f)};
    B by_radius = B (0.0f);

    void
    add (B slope, const B *u, B t)
    {
      for (int a = 0; a < 3; ++a)
        by_u[a] = xsimd::fma (slope, u[a], by_u[a]);
      by_radius = xsimd::fma (slope, t * t, by_radius);
    }

    /** \brief ε ∇ of the sum of the weights. */
    B
    along (int a, const B *growth) const
    {
      return xsimd::fnma (B (0.5f) * by_radius, growth[a], -by_u[a]);
    }
  };

  int
  size () const
  {
    return SIZE + 2 * kinks_;
  }

  static B
  dot (const B *a, const B *b)
  {
    return xsimd::fma (a[2], b[2], xsimd::fma (a[1], b[1], a[0] * b[0]));
  }

  B
  weightOf (B squared, std::size_t node, B &t) const
  {
    t = xsimd::min (xsimd::sqrt (squared) * scale_, B (1.0f));
    const B weight = kernel_.weight (t);
    return nodes_.confidence != nullptr ? weight * B (nodes_.confidence[node]) : weight;
  }

  /** \brief Take the kink that is zero at x where it may be seen from either side. */
  void
  seeFrom (std::size_t first, int s)
  {
    const Surface &surface = sharp_.surfaces[s];
    const B theta = B::load_unaligned (surface.theta_at + first), one (1.0f), zero (0.0f);
    const auto holds_x = theta >= zero;
    sign_[s] = surface.reversible ? xsimd::select (holds_x, -one, one) : one;
    open_[s] = surface.reversible ? xsimd::select (holds_x, one, zero) : zero;
    const B height = sign_[s] * theta * scale_;
    const B on = isOn (height, s);
    at_x_[SIZE + s] = on * height;
    at_x_[SIZE + kinks_ + s] = theta * theta * scale_ * scale_;
    for (int a = 0; a < 3; ++a)
    {
      const B g = B::load_unaligned (surface.gradient_at[a] + first);
      slope_at_x_[s][a] = on * sign_[s] * g;
      slope_at_x_[kinks_ + s][a] = B (2.0f) * theta * scale_ * g;
    }
  }

  /** \brief 1 where a kink of this height is not zero. */
  B
  isOn (B height, int s) const
  {
    const B one (1.0f), zero (0.0f);
    return xsimd::select (height > zero, one, xsimd::select (height < zero, zero, one - open_[s]));
  }

  /** \brief R and ∂R of the enrichment at a node. */
  void
  evaluateKinks (std::size_t node, B *R, B (*G)[3]) const
  {
    for (int s = 0; s < kinks_; ++s)
    {
      const Surface &surface = sharp_.surfaces[s];
      const B theta = B (surface.theta[node]) * scale_, height = sign_[s] * theta, on = isOn (height, s);
      R[s] = on * height;
      R[kinks_ + s] = theta * theta;
      for (int a = 0; a < 3; ++a)
      {
        const B g (surface.gradient[a][node]);
        G[s][a] = on * sign_[s] * g;
        G[kinks_ + s][a] = B (2.0f) * theta * g;
      }
    }
  }

  void
  sumMoments ()
  {
    const B zero (0.0f), one (1.0f);
    for (int j = 0; j < size (); ++j)
    {
      b_[j] = zero;
      for (int i = 0; i <= j; ++i)
        M_[at (j, i)] = zero;
    }
    for (int s = 0; s < kinks_; ++s)
      below_[s] = above_[s] = zero;
    const B reach = xsimd::fma (support_.radius (), B (settings_.reach), B (settings_.offset));
    const B reach_squared = reach * reach, radius_squared = support_.squaredRadius ();
    in_support_ = on_surface_ = in_quarter_ = zero;
    nearest_ = B (3e38f);
    nearest_node_ = zero;
    for (std::size_t i = 0; i < support_.size (); ++i)
    {
      const std::size_t node = support_.node (i);
      B d[3], t;
      const B squared = support_.offset (node, d), weight = weightOf (squared, node, t);
      const auto inside = squared < radius_squared;
      in_support_ += xsimd::select (inside, one, zero);
      if (node < nodes_.on_surface)
      {
        on_surface_ += xsimd::select (inside, one, zero);
        in_quarter_ += xsimd::select (inside && squared <= reach_squared, one, zero);
        const auto is_nearer = squared < nearest_;
        nearest_node_ = xsimd::select (is_nearer, B (static_cast<float> (node)), nearest_node_);
        nearest_ = xsimd::select (is_nearer, squared, nearest_);
      }
      addNode (node, weight, d);
    }
    weight_ = M_[0];
  }

  void
  addNode (std::size_t node, B weight, const B *d)
  {
    B u[3], n[3], R[MAX_SIZE], G[2 * MAX_SURFACES][3];
    n[0] = B (nodes_.nx[node]);
    n[1] = B (nodes_.ny[node]);
    n[2] = B (nodes_.nz[node]);
    for (int a = 0; a < 3; ++a)
      u[a] = d[a] * scale_;
    const B q = dot (u, u), height = B (nodes_.lambda != nullptr ? nodes_.lambda[node] : 0.0f) * scale_;
    TermsT::evaluate (u, q, R);
    TermsT::addNormal (weight, u, n, b_);
    evaluateKinks (node, R + SIZE, G);
    for (int s = 0; s < kinks_; ++s)
      if (sharp_.surfaces[s].theta[node] < 0.0f)
        below_[s] += weight;
      else if (sharp_.surfaces[s].theta[node] > 0.0f)
        above_[s] += weight;
    for (int j = 0; j < size (); ++j)
    {
      const B wr = weight * R[j];
      for (int i = 0; i <= j; ++i)
        M_[at (j, i)] = xsimd::fma (wr, R[i], M_[at (j, i)]);
      b_[j] = xsimd::fma (wr, height, b_[j]);
    }
    for (int e = 0; e < 2 * kinks_; ++e)
      addSlopesOf (e, weight, u, n, G);
  }

  /** \brief The products of the gradients of term e with those of the terms before it; polynomials' own follow later.
   */
  void
  addSlopesOf (int e, B weight, const B *u, const B *n, const B (*G)[3])
  {
    const int j = SIZE + e;
    B weighted[3];
    for (int a = 0; a < 3; ++a)
      weighted[a] = weight * G[e][a];
    for (int a = 0; a < 3; ++a)
      M_[at (j, 1 + a)] += weighted[a];
    if constexpr (SIZE > 4)
      M_[at (j, 4)] = xsimd::fma (B (2.0f), dot (weighted, u), M_[at (j, 4)]);
    for (int other = 0; other <= e; ++other)
      M_[at (j, SIZE + other)] += dot (weighted, G[other]);
    b_[j] += dot (weighted, n);
  }

  /** \brief Strike out what does not count in a lane, and let squares fade. */
  void
  activate (int s)
  {
    const B zero (0.0f), one (1.0f);
    const B on = xsimd::select (below_[s] > zero && above_[s] > zero, one, zero);
    const B share = xsimd::min (xsimd::min (below_[s], above_[s]) / weight_ * B (1.0f / LEAST_BALANCE), one);
    presence_[s] = share * share * (B (3.0f) - B (2.0f) * share);
    active_[s] = on;
    keep (SIZE + s, on);
    keep (SIZE + kinks_ + s,
          sharp_.surfaces[s].squared ? xsimd::select (presence_[s] > B (MIN_PRESENCE), on, zero) : zero);
  }

  void
  keep (int j, B on)
  {
    // A lane with nothing in reach holds NaNs, which a product would keep.
    const auto is_kept = on > B (0.5f);
    for (int i = 0; i <= j; ++i)
      M_[at (j, i)] = xsimd::select (is_kept, M_[at (j, i)], B (0.0f));
    for (int i = j + 1; i < size (); ++i)
      M_[at (i, j)] = xsimd::select (is_kept, M_[at (i, j)], B (0.0f));
    b_[j] = xsimd::select (is_kept, b_[j], B (0.0f));
    at_x_[j] = xsimd::select (is_kept, at_x_[j], B (0.0f));
  }

  /** \brief How much the pivot of a square is raised since it fades. */
  B
  fadeOf (int s) const
  {
    const B p = xsimd::max (presence_[s], B (MIN_PRESENCE)), left = B (1.0f) - p;
    return B (FADE) * weight_ * left * left / (p * p);
  }

  /** \brief See MomentSystem::factorize (). */
  void
  factorize ()
  {
    for (int j = 0; j < size (); ++j)
    {
      raisePivot (j);
      if (j >= SIZE + kinks_)
        M_[at (j, j)] += fadeOf (j - SIZE - kinks_);
      const B inverse = B (1.0f) / M_[at (j, j)];
      for (int k = j + 1; k < size (); ++k)
      {
        const B factor = M_[at (k, j)] * inverse;
        for (int i = k; i < size (); ++i)
          M_[at (i, k)] = xsimd::fnma (M_[at (i, j)], factor, M_[at (i, k)]);
      }
      for (int i = j + 1; i < size (); ++i)
        M_[at (i, j)] *= inverse;
    }
  }

  void
  raisePivot (int j)
  {
    constexpr float LEAST = 1e-9f, OF_POLYNOMIALS[] = {0.0f, 1e-10f, 1e-4f}, OF_KINKS = 2e-5f; // see PivotFloor
    const bool is_kink = j >= SIZE && j < SIZE + kinks_;
    const B floor = B (is_kink ? OF_KINKS : OF_POLYNOMIALS[j < SIZE ? TermsT::degree (j) : 2]) * weight_;
    const B one (1.0f), zero (0.0f), pivot = M_[at (j, j)];
    const auto is_low = pivot < floor;
    const B share = xsimd::max (pivot / xsimd::select (floor > zero, floor, one), B (LEAST));
    raises_[j] = xsimd::select (is_low, floor * (one - share) * (one - share) / share, zero);
    const B raised = xsimd::select (is_low, floor * share + raises_[j], pivot);
    M_[at (j, j)] = xsimd::select (raised > zero, raised, one);
  }

  void
  solve (B *v) const
  {
    const int n = size ();
    for (int j = 0; j < n; ++j)
      for (int i = j + 1; i < n; ++i)
        v[i] = xsimd::fnma (M_[at (i, j)], v[j], v[i]);
    for (int j = 0; j < n; ++j)
      v[j] /= M_[at (j, j)];
    for (int j = n - 2; j >= 0; --j)
      for (int i = j + 1; i < n; ++i)
        v[j] = xsimd::fnma (M_[at (i, j)], v[i], v[j]);
  }

  void
  addResidual (std::size_t node, B *by_u, B &by_radius, Change &all, Change *below, Change *above) const
  {
    B d[3], t, n[3], R[MAX_SIZE], G[2 * MAX_SURFACES][3];
    const B weight = weightOf (support_.offset (node, d), node, t);
    for (int a = 0; a < 3; ++a)
      d[a] *= scale_;
    n[0] = B (nodes_.nx[node]);
    n[1] = B (nodes_.ny[node]);
    n[2] = B (nodes_.nz[node]);
    TermsT::evaluate (d, t * t, R);
    evaluateKinks (node, R + SIZE, G);
    B share (0.0f), residual = B (nodes_.lambda != nullptr ? nodes_.lambda[node] : 0.0f) * scale_;
    B of_shape[3], of_fit[3];
    TermsT::slopes (a_, d, of_shape);
    TermsT::slopes (c_, d, of_fit);
    for (int j = 0; j < size (); ++j)
    {
      share = xsimd::fma (a_[j], R[j], share);
      residual = xsimd::fnma (c_[j], R[j], residual);
    }
    for (int e = 0; e < 2 * kinks_; ++e)
      for (int a = 0; a < 3; ++a)
      {
        of_shape[a] = xsimd::fma (a_[SIZE + e], G[e][a], of_shape[a]);
        of_fit[a] = xsimd::fma (c_[SIZE + e], G[e][a], of_fit[a]);
      }
    for (int a = 0; a < 3; ++a)
      n[a] -= of_fit[a];
    const B of_gradients = dot (of_shape, n);
    residual = xsimd::fma (share, residual, of_gradients);
    by_radius = xsimd::fma (weight, of_gradients, by_radius);
    B slope = kernel_.slope (t);
    if (nodes_.confidence != nullptr)
      slope *= B (nodes_.confidence[node]);
    const B force = slope * residual;
    by_radius = xsimd::fnma (B (0.5f) * t * t, force, by_radius);
    for (int a = 0; a < 3; ++a)
      by_u[a] = xsimd::fma (force, d[a], by_u[a]);
    all.add (slope, d, t);
    for (int s = 0; s < kinks_; ++s)
      if (sharp_.surfaces[s].theta[node] < 0.0f)
        below[s].add (slope, d, t);
      else if (sharp_.surfaces[s].theta[node] > 0.0f)
        above[s].add (slope, d, t);
  }

  /** \brief The gradients of the kink and the square at x, by their coefficients. */
  void
  addSlopes (int s, B *gradient) const
  {
    for (const int e : {s, kinks_ + s})
      for (int a = 0; a < 3; ++a)
        gradient[a] = xsimd::fma (c_[SIZE + e], slope_at_x_[e][a], gradient[a]);
  }

  /** \brief What the change of a square's presence does: FieldFit::gradientOfFade () and the scale of the term. */
  void
  subtractFade (int s, const B *radius_gradient, const Change &all, const Change &below, const Change &above,
                B *gradient) const
  {
    const int j = SIZE + kinks_ + s;
    const B p = xsimd::max (presence_[s], B (MIN_PRESENCE)), left = B (1.0f) - p, fade = fadeOf (s);
    const auto is_below = below_[s] < above_[s];
    const B balance = xsimd::min (below_[s], above_[s]) / weight_, share = balance * B (1.0f / LEAST_BALANCE);
    const B rise = xsimd::select (share < B (1.0f), B (6.0f / LEAST_BALANCE) * share * (B (1.0f) - share), B (0.0f));
    const B by_presence = B (-2.0f * FADE) * weight_ * left / (p * p * p) * rise / weight_;
    const B part = xsimd::select (active_[s] > B (0.5f), a_[j] * c_[j], B (0.0f));
    for (int a = 0; a < 3; ++a)
    {
      const B of_all = all.along (a, growth_);
      const B of_side = xsimd::select (is_below, below.along (a, growth_), above.along (a, growth_));
      const B of_fade = fade / weight_ * of_all + by_presence * xsimd::fnma (balance, of_all, of_side) +
                        B (4.0f) * fade * radius_gradient[a];
      gradient[a] = xsimd::fnma (part, of_fade, gradient[a]);
    }
  }

  const Settings &settings_;
  const Nodes &nodes_;
  const SharpSurfaces &sharp_;
  const LaneSupport<B> &support_;
  KernelT<B> kernel_;
  B scale_;
  int kinks_;
  B sign_[MAX_SURFACES], open_[MAX_SURFACES]; // of θ; 1 where the kink is zero on the surface itself
  B below_[MAX_SURFACES], above_[MAX_SURFACES], presence_[MAX_SURFACES], active_[MAX_SURFACES];
  B at_x_[MAX_SIZE] = {B (1.0f), B (0.0f), B (0.0f), B (0.0f), B (0.0f)}; // R(x)
  B slope_at_x_[2 * MAX_SURFACES][3];                                     // ∂R(x) of the enrichment
  B M_[MAX_SIZE * (MAX_SIZE + 1) / 2], b_[MAX_SIZE], raises_[MAX_SIZE];
  B c_[MAX_SIZE], a_[MAX_SIZE]; // M^-1 b, M^-1 R(x)
  B weight_, centroid_[3], growth_[3];
  B in_support_, on_surface_, in_quarter_, nearest_, nearest_node_;
};

} // namespace erkpa::lanes
