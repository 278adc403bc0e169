// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_kernel.h"
#include "lane_support.h"
#include "lane_vector.h"

namespace erkpa::lanes
{

/** \brief A sum of changes of weights with x: Σ w' u and Σ w' t², w' = dw/dt / t. */
template <typename B>
struct WeightChange
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

  /** \brief ε ∇ of the sum of the weights.
   * \param[in] growth 2 ∇ε
   */
  B
  along (int a, const B *growth) const
  {
    return fnma (B (0.5f) * by_radius, growth[a], -by_u[a]);
  }
};

/** \brief What a node, the i-th to visit, brings into the sums at the evaluation points: its weight w(t) Δx_i, and what
 * it asks for. */
template <typename B, template <typename> class KernelT>
class LaneWeights
{
public:
  LaneWeights (const Settings &settings, const LaneSupport<B> &support)
      : support_ (support), lambda_ (support.near (LaneSupport<B>::LAMBDA)),
        confidence_ (support.near (LaneSupport<B>::CONFIDENCE)), kernel_ (settings.kernel),
        quarter_ (B (0.25f) * support.inverse () * support.inverse ()), stretch_ (settings.stretch)
  {
  }

  /** \brief Whether the supports of nodes are flattened: t is not |u| then. */
  bool
  areFlattened () const
  {
    return KernelT<B>::IS_GENERAL && stretch_ > 0.0f;
  }

  /** \brief From |x_i - x|² of N nodes from the i-th to visit on to the squares by which they are weighed. */
  template <std::size_t N>
  [[gnu::always_inline]] void
  stretch (std::size_t i, B *squared) const
  {
    if (!areFlattened ())
      return;
    for (std::size_t n = 0; n < N; ++n)
    {
      B d[3], along[3];
      support_.offset (i + n, d);
      normal (i + n, along);
      const B height = dot (d, along);
      squared[n] = xsimd::fma (B (stretch_) * height, height, squared[n]);
    }
  }

  /** \brief The direction in which t of a node grows: u, longer along its normal where supports are flattened. */
  void
  steepest (std::size_t i, const B *u, B *way) const
  {
    B along[3], more (0.0f);
    if (areFlattened ())
    {
      normal (i, along);
      more = B (stretch_) * dot (u, along);
    }
    for (int a = 0; a < 3; ++a)
      way[a] = areFlattened () ? xsimd::fma (more, along[a], u[a]) : u[a];
  }

  /** \brief |u|². */
  B
  squaredLength (B t, const B *u) const
  {
    return areFlattened () ? dot (u, u) : t * t;
  }

  /** \brief Calls visit (i, |x_i - x|², t, u) for each node to visit, u = (x_i - x) / ε; t is 1 beyond the support.
   *
   * Distances are made for some nodes ahead: what follows from them would wait for them one by one.
   */
  template <typename VisitT>
  void
  visitNodes (VisitT visit) const
  {
    constexpr std::size_t AHEAD = B::size == 16 ? 8 : 4;
    std::size_t i = 0;
    for (; i + AHEAD <= support_.size (); i += AHEAD)
      visitSome<AHEAD> (i, visit);
    for (; i < support_.size (); ++i)
      visitSome<1> (i, visit);
  }

  /** \brief t of N nodes, from |x_i - x|².
   *
   * To the last digit or so: a Newton step, t = q r (3 - q r²) with q = t²/4, from the processor's estimate r of 1/√q
   * takes a third of the time that its root takes. Operations for different nodes stand side by side, so that few of
   * them wait for others.
   */
  template <std::size_t N>
  [[gnu::always_inline]] void
  shares (const B *squared, B *t) const
  {
    const B quarter (0.25f), three (3.0f), scale = quarter_;
    B q[N], r[N];
    for (std::size_t n = 0; n < N; ++n)
      q[n] = xsimd::min (squared[n] * scale, quarter);
    for (std::size_t n = 0; n < N; ++n)
      r[n] = inverseRoot (q[n]);
    for (std::size_t n = 0; n < N; ++n)
      q[n] *= r[n];
    for (std::size_t n = 0; n < N; ++n)
      r[n] = fnma (q[n], r[n], three);
    for (std::size_t n = 0; n < N; ++n)
      t[n] = q[n] * r[n];
  }

  /** \brief From t to the weights of N nodes from the i-th to visit on. */
  template <std::size_t N>
  [[gnu::always_inline]] void
  weights (std::size_t i, B *t) const
  {
    kernel_.template weights<N> (t);
    if (confidence_ != nullptr)
      for (std::size_t n = 0; n < N; ++n)
        t[n] *= B (confidence_[i + n]);
  }

  B
  weightAt (std::size_t i, B t) const
  {
    return confident (i, kernel_.weight (t));
  }

  /** \brief dw/dt / t, likewise. */
  B
  slope (std::size_t i, B t) const
  {
    return confident (i, kernel_.slope (t));
  }

  void
  normal (std::size_t i, B *n) const
  {
    n[0] = B (support_.near (LaneSupport<B>::NORMAL + 0)[i]);
    n[1] = B (support_.near (LaneSupport<B>::NORMAL + 1)[i]);
    n[2] = B (support_.near (LaneSupport<B>::NORMAL + 2)[i]);
  }

  bool
  hasLambda () const
  {
    return lambda_ != nullptr;
  }

  /** \brief λ_i, a length; zero where there is none. */
  B
  lambda (std::size_t i) const
  {
    return B (lambda_ != nullptr ? lambda_[i] : 0.0f);
  }

  /** \brief Σ w of an attribute. */
  B
  sum (const float *attribute) const
  {
    B sum (0.0f);
    visitNodes ([&] (std::size_t i, B, B t, const B *)
                { sum = xsimd::fma (weightAt (i, t), B (attribute[support_.node (i)]), sum); });
    return sum;
  }

private:
  template <std::size_t N, typename VisitT>
  [[gnu::always_inline]] void
  visitSome (std::size_t i, VisitT &visit) const
  {
    B squared[N], t[N];
    support_.template distances<N> (i, squared);
    for (std::size_t n = 0; n < N; ++n)
      t[n] = squared[n];
    stretch<N> (i, t);
    shares<N> (t, t);
    const B scale = support_.inverse ();
    for (std::size_t n = 0; n < N; ++n)
    {
      B u[3];
      support_.offset (i + n, u);
      for (B &along : u)
        along *= scale;
      visit (i + n, squared[n], t[n], u);
    }
  }

  B
  confident (std::size_t i, B weight) const
  {
    return confidence_ != nullptr ? weight * B (confidence_[i]) : weight;
  }

  const LaneSupport<B> &support_;
  const float *lambda_, *confidence_;
  KernelT<B> kernel_;
  B quarter_;     // 1 / (4 ε²)
  float stretch_; // see Settings
};

} // namespace erkpa::lanes
