// SPDX-License-Identifier: BSD-3-Clause
//
// What the terms of an enrichment are at a point: θH(θ) and its like (eq. 22), and their gradients.
#include "enrichment.h"

namespace erkpa
{

/** \brief Whether it is the second of a corner's surfaces that is lower.
 *
 * The third says where they are equal, and the kink there sees its side: a node on it, where rounding decides, must be
 * on the same side for both.
 */
bool
Enrichment::isSecondLower (const Term &term, const Theta &a, const Theta &b, const Theta &third) const
{
  const double turn = (term.scale_a * a.gradient - term.scale_b * b.gradient).dot (third.gradient);
  return turn > 0.0 ? third.value >= 0.0 : third.value < 0.0;
}

void
Enrichment::evaluate (const Term &term, const Theta &a, const Theta *b, const Theta *third, double radius,
                      double &value, Eigen::Vector3d &gradient) const
{
  double scale = term.scale_a, height = scale * a.value;
  Eigen::Vector3d slope = scale * a.gradient;
  if (b != nullptr && (jumps_ ? term.scale_b * b->value < height : isSecondLower (term, a, *b, *third)))
  {
    scale = term.scale_b;
    height = scale * b->value;
    slope = scale * b->gradient;
  }
  if (term.is_square)
  {
    value = height * height / (radius * radius);
    gradient = 2.0 * height / radius * slope;
    return;
  }
  value = 0.0;
  gradient.setZero ();
  // A node on a sharp surface is above it for the slopes of all kinks, whichever side they are seen from.
  const bool counts_at_zero = jumps_ ? !term.open : scale > 0.0;
  if (!(height > 0.0) && (!counts_at_zero || height < 0.0))
    return;
  value = jumps_ ? 1.0 : height / radius;
  if (!jumps_)
    gradient = slope;
}

void
Enrichment::atNode (int term, int slot, double radius, double &value, Eigen::Vector3d &gradient) const
{
  const Term &t = terms_[static_cast<std::size_t> (term)];
  const auto i = static_cast<std::size_t> (slot);
  const auto theta_of = [&] (int near)
  { return near < 0 ? nullptr : &near_[static_cast<std::size_t> (near)].at_nodes[i]; };
  evaluate (t, *theta_of (t.first), theta_of (t.second), theta_of (t.third), radius, value, gradient);
}

void
Enrichment::atPoint (int term, double radius, double &value, Eigen::Vector3d &gradient) const
{
  const Term &t = terms_[static_cast<std::size_t> (term)];
  if (is_continued_ && !t.is_square)
  {
    continueToPoint (t, radius, value, gradient);
    return;
  }
  const auto theta_of = [&] (int near)
  { return near < 0 ? nullptr : &near_[static_cast<std::size_t> (near)].at_point; };
  evaluate (t, *theta_of (t.first), theta_of (t.second), theta_of (t.third), radius, value, gradient);
}

/** \brief Of the smooth pieces of a term take the one that holds at the place it is looked at from. */
void
Enrichment::continueToPoint (const Term &term, double radius, double &value, Eigen::Vector3d &gradient) const
{
  const NearSurface *near = &near_[static_cast<std::size_t> (term.first)];
  double scale = term.scale_a;
  if (term.second >= 0)
  {
    const NearSurface &b = near_[static_cast<std::size_t> (term.second)];
    if (term.scale_b * b.at_place < scale * near->at_place)
    {
      near = &b;
      scale = term.scale_b;
    }
  }
  value = 0.0;
  gradient.setZero ();
  if (!(scale * near->at_place > 0.0))
    return;
  value = jumps_ ? 1.0 : scale * near->at_point.value / radius;
  if (!jumps_)
    gradient = scale * near->at_point.gradient;
}

} // namespace erkpa
