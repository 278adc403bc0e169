// SPDX-License-Identifier: BSD-3-Clause
#include "enrichment.h"

#include "enriching_surface.h"

#include <algorithm>

namespace erkpa
{

namespace
{

/** \brief Where fewer of the nodes than this lie on one side of a surface, its θ² fades out. */
constexpr double LEAST_BALANCE = 0.2;

/** \brief Rises from 0 to 1 as t does, C1. */
double
smoothStep (double t)
{
  return t >= 1.0 ? 1.0 : t * t * (3.0 - 2.0 * t);
}

double
smoothStepSlope (double t)
{
  return t >= 1.0 ? 0.0 : 6.0 * t * (1.0 - t);
}

} // namespace

Enrichment::Enrichment (const ImplicitField &field)
    : field_ (field), jumps_ (field.options ().enrichment == EnrichmentType::JUMP)
{
  const Order order = field.options ().order;
  known_.resize (field.enrichingSurfaces ().size ());
  const bool squares = !jumps_ && field.options ().constraint == Constraint::HERMITE;
  for (const SharpSurface::ConstPtr &surface : field.enrichingSurfaces ())
  {
    const EnrichingSurface known (surface);
    const bool is_square_in_basis = known.isPlane () && order == Order::QUADRATIC;
    is_plane_.push_back (known.isPlane () ? 1 : 0);
    costly_.push_back (known.isField () ? 1 : 0);
    reversible_.push_back (jumps_ || (known.isPlane () && order != Order::CONSTANT) ? 1 : 0);
    squared_.push_back (squares && order != Order::CONSTANT && !is_square_in_basis ? 1 : 0);
  }
}

void
Enrichment::gather (const Support &support)
{
  near_count_ = 0;
  near_pencils_.clear ();
  const int surfaces = static_cast<int> (field_.enrichingSurfaces ().size ());
  for (int surface = 0; surface < surfaces; ++surface)
    evaluateThetas (support, surface);
  if (near_count_ < 3)
    return;
  std::vector<char> is_near (static_cast<std::size_t> (surfaces), 0);
  for (std::size_t i = 0; i < near_count_; ++i)
    is_near[static_cast<std::size_t> (near_[i].surface)] = 1;
  for (const Pencil &pencil : field_.pencils ())
    if (std::all_of (pencil.surfaces.begin (), pencil.surfaces.end (),
                     [&] (int surface) { return is_near[static_cast<std::size_t> (surface)] != 0; }))
      near_pencils_.push_back (pencil);
}

/** \brief Keep a surface that is present and has gathered nodes on either side. */
void
Enrichment::evaluateThetas (const Support &support, int surface)
{
  const SharpSurface &sharp = *field_.enrichingSurfaces ()[static_cast<std::size_t> (surface)];
  const Eigen::Vector3d center = support.center () + field_.points ().origin;
  if (sharp.isAbsentIn (center, support.reach ()))
    return;
  constexpr double MARGIN = 1.0 + 1e-9; // for rounding: θ of a plane is the distance itself
  if (is_plane_[static_cast<std::size_t> (surface)] != 0 && std::abs (sharp.theta (center)) > MARGIN * support.reach ())
    return;
  const std::size_t slots = support.points ().size ();
  const auto position = [&] (std::size_t slot)
  { return Eigen::Vector3d (support.position (slot) + field_.points ().origin); };
  if (near_.size () == near_count_)
    near_.emplace_back ();
  NearSurface &near = near_[near_count_];
  near.surface = surface;
  near.at_nodes.clear ();
  const bool is_costly = costly_[static_cast<std::size_t> (surface)] != 0;
  bool below = false, above = false;
  for (std::size_t slot = 0; slot < slots; ++slot)
  {
    near.at_nodes.push_back (is_costly ? knownTheta (support, surface, slot)
                                       : Theta{sharp.theta (position (slot)), Eigen::Vector3d::Zero ()});
    below = below || near.at_nodes.back ().value < 0.0;
    above = above || near.at_nodes.back ().value > 0.0;
  }
  if (!below || !above)
    return;
  for (std::size_t slot = 0; slot < slots && !is_costly; ++slot)
    near.at_nodes[slot].gradient = sharp.thetaGradient (position (slot));
  ++near_count_;
}

const Enrichment::Theta &
Enrichment::knownTheta (const Support &support, int surface, std::size_t slot)
{
  const auto i = static_cast<std::size_t> (surface);
  const ValuePoint &point = support.points ()[slot];
  const auto [known, is_new] = known_[i].try_emplace (field_.valueIndex (point.node, point.side));
  if (is_new)
    field_.enrichingSurfaces ()[i]->evaluate (support.position (slot) + field_.points ().origin, known->second.value,
                                              known->second.gradient);
  return known->second;
}

int
Enrichment::activeIndex (int surface) const
{
  for (std::size_t i = 0; i < near_count_; ++i)
    if (near_[i].surface == surface && near_[i].active)
      return static_cast<int> (i);
  return -1;
}

void
Enrichment::select (const Support &support, const Eigen::Vector3d &x)
{
  terms_.clear ();
  is_continued_ = false;
  if (near_count_ == 0)
    return;
  position_ = x + field_.points ().origin;
  total_weight_ = 0.0;
  for (const SupportNode &node : support.nodes ())
    total_weight_ += node.weight;
  for (std::size_t i = 0; i < near_count_; ++i)
  {
    NearSurface &near = near_[i];
    activate (near, support);
    if (near.active)
      addTerm ({static_cast<int> (i), -1, -1, 1.0, 1.0, false, false, near.presence});
  }
  const std::size_t kinks = terms_.size ();
  if (kinks >= 3)
    for (const Pencil &pencil : near_pencils_)
      addCornerTerms (pencil);
  for (std::size_t i = 0; i < kinks; ++i)
    addSquare (terms_[i].first);
}

void
Enrichment::activate (NearSurface &near, const Support &support)
{
  near.weight_below = near.weight_above = 0.0;
  for (const SupportNode &node : support.nodes ())
  {
    const double theta = near.at_nodes[static_cast<std::size_t> (node.slot)].value;
    if (theta < 0.0)
      near.weight_below += node.weight;
    else if (theta > 0.0)
      near.weight_above += node.weight;
  }
  near.active = near.weight_below > 0.0 && near.weight_above > 0.0 && size () < MAX_TERMS;
  if (!near.active)
    return;
  const SharpSurface &surface = surfaceOf (near);
  near.presence = surface.presence (position_, support.radius ());
  near.active = near.presence > MIN_PRESENCE;
  if (!near.active)
    return;
  surface.evaluate (position_, near.at_point.value, near.at_point.gradient);
}

void
Enrichment::lookFrom (const Eigen::Vector3d *place)
{
  is_continued_ = place != nullptr;
  for (std::size_t i = 0; i < near_count_ && is_continued_; ++i)
    if (near_[i].active)
      near_[i].at_place = surfaceOf (near_[i]).theta (*place);
}

double
Enrichment::balance (const NearSurface &near) const
{
  return std::min (near.weight_below, near.weight_above) / total_weight_;
}

Eigen::Vector3d
Enrichment::balanceGradient (const NearSurface &near, const Support &support) const
{
  const double sign = near.weight_below < near.weight_above ? -1.0 : 1.0;
  Eigen::Vector3d of_side = Eigen::Vector3d::Zero (), of_all = Eigen::Vector3d::Zero ();
  for (const SupportNode &node : support.nodes ())
  {
    const Eigen::Vector3d change = support.weightGradient (node);
    of_all += change;
    if (sign * near.at_nodes[static_cast<std::size_t> (node.slot)].value > 0.0)
      of_side += change;
  }
  return (of_side - balance (near) * of_all) / total_weight_;
}

Eigen::Vector3d
Enrichment::surfacePresenceGradient (const NearSurface &near, const Support &support) const
{
  PresenceSlope slope;
  surfaceOf (near).presence (position_, support.radius (), &slope);
  return support.radius () * (slope.by_position + slope.by_radius * support.radiusGradient ());
}

Eigen::Vector3d
Enrichment::presenceGradient (int term, const Support &support) const
{
  const Term &t = terms_[static_cast<std::size_t> (term)];
  Eigen::Vector3d relative = Eigen::Vector3d::Zero (); // of a product
  for (const int index : {t.first, t.second, t.third})
  {
    if (index < 0)
      continue;
    const NearSurface &near = near_[static_cast<std::size_t> (index)];
    if (near.presence < 1.0)
      relative += surfacePresenceGradient (near, support) / near.presence;
  }
  const NearSurface &near = near_[static_cast<std::size_t> (t.first)];
  const double share = t.is_square ? balance (near) / LEAST_BALANCE : 1.0;
  if (share < 1.0)
    relative += smoothStepSlope (share) / (LEAST_BALANCE * smoothStep (share)) * balanceGradient (near, support);
  return t.presence * relative;
}

void
Enrichment::addSquare (int near)
{
  const NearSurface &surface = near_[static_cast<std::size_t> (near)];
  const double presence = surface.presence * smoothStep (balance (surface) / LEAST_BALANCE);
  if (squared_[static_cast<std::size_t> (surface.surface)] != 0 && presence > MIN_PRESENCE && size () < MAX_TERMS)
    terms_.push_back ({near, -1, -1, 1.0, 1.0, false, true, presence});
}

bool
Enrichment::isReversible (int near) const
{
  return near < 0 || reversible_[static_cast<std::size_t> (near_[static_cast<std::size_t> (near)].surface)] != 0;
}

/** \brief Adds the term that is not zero where all its scaled θ are positive, or negative if x is among those.
 *
 * Seen from the other side a corner's term is another combination of the terms, so that it matters from which side
 * it fades: one that does is always seen from the same.
 */
void
Enrichment::addTerm (const Term &term)
{
  const auto theta = [this] (int near) { return near_[static_cast<std::size_t> (near)].at_point.value; };
  const bool is_corner = term.second >= 0;
  const bool holds_x =
      term.scale_a * theta (term.first) >= 0.0 && (!is_corner || term.scale_b * theta (term.second) >= 0.0);
  const bool fades = is_corner && term.presence < 1.0;
  Term &added = terms_.emplace_back (term);
  added.open = holds_x && !fades && isReversible (term.first) && isReversible (term.second);
  added.scale_a *= added.open ? -1.0 : 1.0;
  added.scale_b *= added.open ? -1.0 : 1.0;
}

void
Enrichment::addCornerTerms (const Pencil &pencil)
{
  const int a = activeIndex (pencil.surfaces[0]), b = activeIndex (pencil.surfaces[1]);
  const int c = activeIndex (pencil.surfaces[2]);
  if (a < 0 || b < 0 || c < 0 || size () + 1 + (jumps_ ? 1 : 0) > MAX_TERMS)
    return;
  double presence = 1.0;
  for (const int near : {a, b, c})
    presence *= near_[static_cast<std::size_t> (near)].presence;
  if (!(presence > MIN_PRESENCE))
    return;
  addTerm ({a, b, c, pencil.scale_a, pencil.scale_b, false, false, presence});
  // The six sectors around the line have six indicators: 1, H(a), H(b), H(c), and two products.
  if (jumps_)
    addTerm ({b, c, a, 1.0, 1.0, false, false, presence});
}

int
Enrichment::nearestSurface (double &distance) const
{
  int nearest = -1;
  for (std::size_t i = 0; i < near_count_; ++i)
    if (near_[i].active && (nearest < 0 || std::abs (near_[i].at_point.value) < distance))
    {
      nearest = near_[i].surface;
      distance = std::abs (near_[i].at_point.value);
    }
  return nearest;
}

std::uint64_t
Enrichment::sideKey () const
{
  std::uint64_t key = 0;
  for (std::size_t i = 0; i < near_count_; ++i)
    if (near_[i].active)
      key = extendSideKey (key, near_[i].surface, near_[i].at_point.value < 0.0);
  return key;
}

} // namespace erkpa
