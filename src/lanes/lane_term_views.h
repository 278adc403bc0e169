// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_vector.h"

#include <cstddef>

namespace erkpa::lanes
{

/** \brief What the terms of sharp surfaces have in the shape functions and in the fit, by the ways in which lanes see
 * them: from one side, a term is the same number at a node for all lanes, and zero at about half of the nodes. */
template <typename B, typename KinksT>
class LaneTermViews
{
public:
  /** \param[in] of_shape,of_fit coefficients of the terms, as shares of ε
   * \param[in] scale 1 / ε
   */
  LaneTermViews (const KinksT &kinks, const B *of_shape, const B *of_fit, B scale) : kinks_ (kinks)
  {
    kinks.visitViews (
        [&] (int term, bool from_behind)
        {
          const auto is_seen = from_behind ? kinks.isBehind (term) : !kinks.isBehind (term);
          const B unit = xsimd::select (is_seen, kinks.degree (term) > 0.0f ? scale : B (1.0f), B (0.0f));
          list_[count_++] = {term, from_behind, unit * of_shape[term], unit * of_fit[term]};
        });
  }

  /** \brief Add a node's terms to what the shape functions say there, and take them from what the fit leaves over. */
  void
  addTo (std::size_t node, B &share, B &residual) const
  {
    for (int v = 0; v < count_; ++v)
      if (const float value = kinks_.valueAtNode (list_[v].term, list_[v].from_behind, node); value > 0.0f)
      {
        share = xsimd::fma (list_[v].of_shape, B (value), share);
        residual = fnma (list_[v].of_fit, B (value), residual);
      }
  }

private:
  struct View
  {
    int term;
    bool from_behind;
    B of_shape, of_fit;
  };

  const KinksT &kinks_;
  int count_ = 0;
  View list_[2 * KinksT::MAX_TERMS];
};

} // namespace erkpa::lanes
