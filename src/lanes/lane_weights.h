// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_kernel.h"
#include "lane_support.h"

namespace erkpa::lanes
{

/** \brief What a node brings into the sums at the evaluation points: its weight w(t) Δx_i, and what it asks for. */
template <typename B, template <typename> class KernelT>
class LaneWeights
{
public:
  LaneWeights (const Settings &settings, const Nodes &nodes, const LaneSupport<B> &support)
      : nodes_ (nodes), support_ (support), kernel_ (settings.kernel), scale_ (support.inverse ())
  {
  }

  /** \brief Zero beyond the support.
   * \param[out] d x_i - x
   * \param[out] t |x_i - x| / ε, at most 1
   */
  B
  weight (std::size_t node, B *d, B &squared, B &t) const
  {
    squared = support_.offset (node, d);
    t = xsimd::min (xsimd::sqrt (squared) * scale_, B (1.0f));
    return confident (node, kernel_.weight (t));
  }

  /** \brief dw/dt / t, likewise. */
  B
  slope (std::size_t node, B t) const
  {
    return confident (node, kernel_.slope (t));
  }

  void
  normal (std::size_t node, B *n) const
  {
    n[0] = B (nodes_.nx[node]);
    n[1] = B (nodes_.ny[node]);
    n[2] = B (nodes_.nz[node]);
  }

  /** \brief λ_i, a length. */
  B
  lambda (std::size_t node) const
  {
    return B (nodes_.lambda != nullptr ? nodes_.lambda[node] : 0.0f);
  }

  /** \brief Σ w of an attribute. */
  B
  sum (const float *attribute) const
  {
    B sum (0.0f);
    for (std::size_t i = 0; i < support_.size (); ++i)
    {
      const std::size_t node = support_.node (i);
      B d[3], squared, t;
      sum = xsimd::fma (weight (node, d, squared, t), B (attribute[node]), sum);
    }
    return sum;
  }

private:
  B
  confident (std::size_t node, B weight) const
  {
    return nodes_.confidence != nullptr ? weight * B (nodes_.confidence[node]) : weight;
  }

  const Nodes &nodes_;
  const LaneSupport<B> &support_;
  KernelT<B> kernel_;
  B scale_;
};

} // namespace erkpa::lanes
