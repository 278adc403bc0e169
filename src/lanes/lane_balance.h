// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_vector.h"

namespace erkpa::lanes
{

/** \brief The weight of the nodes on either side of a sharp surface. Its θ² fades where few of them are on one: see
 * Enrichment. */
template <typename B>
class LaneBalance
{
public:
  LaneBalance () = default;

  LaneBalance (B below, B above) : below_ (below), above_ (above) {}

  void
  add (bool is_below, B weight)
  {
    (is_below ? below_ : above_) += weight;
  }

  auto
  hasBoth () const
  {
    return below_ > B (0.0f) && above_ > B (0.0f);
  }

  /** \brief How much of the square it leaves.
   * \param[in] weight of all nodes
   */
  B
  presence (B weight) const
  {
    const B share = xsimd::min (lesser (weight) * B (1.0f / LEAST), B (1.0f));
    return share * share * (B (3.0f) - B (2.0f) * share);
  }

  /** \brief W ε∇ of that.
   * \param[in] of_all,of_below,of_above ε∇ of the weights of all nodes and of those on either side
   */
  B
  change (B weight, B of_all, B of_below, B of_above) const
  {
    const B of_side = xsimd::select (below_ < above_, of_below, of_above), share = lesser (weight) * B (1.0f / LEAST);
    const B rise = xsimd::select (share < B (1.0f), B (6.0f / LEAST) * share * (B (1.0f) - share), B (0.0f));
    return rise * fnma (lesser (weight), of_all, of_side);
  }

private:
  static constexpr float LEAST = 0.2f; // of the nodes, on each side

  /** \brief The share of the nodes on the side where there are fewer. */
  B
  lesser (B weight) const
  {
    return xsimd::min (below_, above_) / weight;
  }

  B below_ = B (0.0f), above_ = B (0.0f);
};

} // namespace erkpa::lanes
