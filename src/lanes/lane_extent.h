// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lanes.h"

#include <xsimd/xsimd.hpp>

namespace erkpa::lanes
{

/** \brief How much of a limited surface is in force at the evaluation points: LimitedSurface::presence (), 1 - t² (3 -
 * 2t).
 *
 * By the automatic fade t = 2 d / ε - 1, d the distance from the extent; else t = d / fade.
 */
template <typename B>
class LaneExtent
{
public:
  /** \param[in] first place of the evaluation point in the first lane
   * \param[in] scale 1 / ε
   */
  LaneExtent (const Surface &surface, std::size_t first, B scale) : surface_ (surface), first_ (first), scale_ (scale)
  {
    const B distance = B::load_unaligned (surface.distance_at + first), one (1.0f);
    const B along = isAutomatic () ? B (2.0f) * distance * scale - one : distance / B (surface.fade);
    t_ = xsimd::min (xsimd::max (along, B (0.0f)), one);
  }

  B
  presence () const
  {
    return B (1.0f) - t_ * t_ * (B (3.0f) - B (2.0f) * t_);
  }

  /** \brief ε∇ of it along an axis.
   * \param[in] radius_gradient ∇ε
   */
  B
  change (int axis, B radius_gradient) const
  {
    const B away = B::load_unaligned (surface_.away_at[axis] + first_), one (1.0f);
    const B of_t =
        isAutomatic () ? B (2.0f) * away - (t_ + one) * radius_gradient : away / (B (surface_.fade) * scale_);
    return B (-6.0f) * t_ * (one - t_) * of_t;
  }

private:
  bool
  isAutomatic () const
  {
    return !(surface_.fade > 0.0f);
  }

  const Surface &surface_;
  std::size_t first_;
  B scale_, t_;
};

} // namespace erkpa::lanes
