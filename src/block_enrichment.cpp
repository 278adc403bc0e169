// SPDX-License-Identifier: BSD-3-Clause
#include "block_enrichment.h"

#include "enrichment.h"
#include "support_size.h"

#include <algorithm>
#include <cmath>

namespace erkpa
{

BlockEnrichment::BlockEnrichment (const ImplicitField &field, double unit)
    : field_ (field), inverse_unit_ (1.0 / unit),
      can_evaluate_ (field.options ().constraint != Constraint::OFFSURFACE && field.options ().flatten >= 1.0 &&
                     (field.options ().order == Order::LINEAR || field.options ().order == Order::SPHERICAL))
{
  for (const SharpSurface::ConstPtr &surface : field.enrichingSurfaces ())
    surfaces_.emplace_back (surface);
  recalled_.resize (surfaces_.size ());
}

void
BlockEnrichment::gather (const Eigen::Vector3d &center, double reach)
{
  near_.clear ();
  const Eigen::Vector3d position = center + field_.points ().origin;
  for (std::size_t i = 0; i < surfaces_.size (); ++i)
    if (!surfaces_[i].surface ().isAbsentIn (position, reach) && surfaces_[i].canPass (position, reach))
      near_.push_back (static_cast<int> (i));
}

bool
BlockEnrichment::isAbsentAt (const Eigen::Vector3d &x, double reach) const
{
  return std::none_of (near_.begin (), near_.end (),
                       [&] (int near) { return surface (near).canPass (x + field_.points ().origin, reach); });
}

bool
BlockEnrichment::canEvaluateAt (const Eigen::Vector3d &x, double reach) const
{
  return can_evaluate_ && std::all_of (near_.begin (), near_.end (),
                                       [&] (int near) {
                                         return surface (near).hasKnownPresence () ||
                                                !surface (near).canPass (x + field_.points ().origin, reach);
                                       });
}

bool
BlockEnrichment::passes (int s, const std::vector<Eigen::Vector3d> &places, double reach) const
{
  const EnrichingSurface &known = surface (s);
  return known.hasKnownPresence () &&
         std::any_of (places.begin (), places.end (),
                      [&] (const Eigen::Vector3d &x) { return known.canPass (x + field_.points ().origin, reach); });
}

void
BlockEnrichment::run (const lanes::Engine &engine, const lanes::Settings &settings, const lanes::Nodes &view,
                      const BlockNodes &nodes, const std::vector<Eigen::Vector3d> &places,
                      const std::vector<Eigen::Vector3d> &seen_from, double reach, BlockPoints &points)
{
  choose (places, reach);
  lanes::SharpSurfaces sharp{};
  if (used_ > lanes::SharpSurfaces::MOST || !listPencils (sharp))
  {
    points.leaveOpen ();
    return;
  }
  for (std::size_t s = 0; s < used_; ++s)
  {
    evaluateAtNodes (nodes, values_[s]);
    evaluateAtPoints (places, values_[s]);
    evaluateFrom (seen_from, values_[s]);
    measureExtentAtPoints (places, values_[s]);
  }
  showSurfaces (sharp);
  const bool is_function = field_.supportSize ().kind () == SupportSize::Kind::FUNCTION;
  points.run (engine, settings, view, is_function, &sharp);
}

void
BlockEnrichment::choose (const std::vector<Eigen::Vector3d> &places, double reach)
{
  used_ = 0;
  for (const int near : near_)
  {
    if (!passes (near, places, reach))
      continue;
    if (values_.size () == used_)
      values_.emplace_back ();
    values_[used_++].surface = near;
  }
}

void
BlockEnrichment::evaluateAtNodes (const BlockNodes &nodes, Values &values)
{
  const EnrichingSurface &known = surface (values.surface);
  if (known.isPlane ())
  {
    evaluatePlaneAtNodes (*known.plane (), nodes, values);
    return;
  }
  values.theta.resize (nodes.count ());
  for (std::vector<float> &component : values.gradient)
    component.resize (nodes.count ());
  for (std::size_t i = 0; i < nodes.count (); ++i)
  {
    const Eigen::Vector4f both = known.isQuick () ? thetaAtNode (known, nodes, i) : recall (values.surface, nodes, i);
    values.theta[i] = both[3];
    for (std::size_t a = 0; a < 3; ++a)
      values.gradient[a][i] = both[static_cast<Eigen::Index> (a)];
  }
}

/** \brief ∇θ and θ. */
Eigen::Vector4f
BlockEnrichment::thetaAtNode (const EnrichingSurface &known, const BlockNodes &nodes, std::size_t i) const
{
  double theta = 0.0;
  Eigen::Vector3d gradient;
  known.surface ().evaluate (nodes.position (i).cast<double> () + field_.points ().origin, theta, gradient);
  Eigen::Vector4f both;
  both << gradient.cast<float> (), static_cast<float> (theta * inverse_unit_);
  return both;
}

/** \brief The same of a surface that is not quick: blocks that follow each other share most of their nodes. */
Eigen::Vector4f
BlockEnrichment::recall (int s, const BlockNodes &nodes, std::size_t i)
{
  constexpr std::size_t PLACES = 1u << 12; // some blocks' nodes
  std::vector<Recalled> &all = recalled_[static_cast<std::size_t> (s)];
  all.resize (PLACES);
  const auto node = static_cast<std::uint32_t> (nodes.node (i));
  Recalled &recalled = all[node % PLACES];
  if (recalled.node != node)
    recalled = {node, thetaAtNode (surface (s), nodes, i)};
  return recalled.theta;
}

/** \brief The same for the most frequent of surfaces; its θ is that of every other place that asks for it, to the last
 * bit: nodes on it are on one side of it for all blocks. */
void
BlockEnrichment::evaluatePlaneAtNodes (const SharpPlane &plane, const BlockNodes &nodes, Values &values) const
{
  const Eigen::Vector3d &origin = field_.points ().origin;
  const Eigen::Vector3f gradient = plane.SharpPlane::thetaGradient (origin).cast<float> ();
  values.theta.resize (nodes.count ());
  for (std::size_t i = 0; i < nodes.count (); ++i)
    values.theta[i] =
        static_cast<float> (plane.SharpPlane::theta (nodes.position (i).cast<double> () + origin) * inverse_unit_);
  for (std::size_t a = 0; a < 3; ++a)
    values.gradient[a].assign (nodes.count (), gradient[static_cast<Eigen::Index> (a)]);
}

/** \brief The last vector is filled up with the last point. */
void
BlockEnrichment::evaluateAtPoints (const std::vector<Eigen::Vector3d> &places, Values &values) const
{
  const std::size_t padded = places.size () + lanes::MAX_WIDTH;
  values.theta_at.resize (padded);
  for (std::vector<float> &component : values.gradient_at)
    component.resize (padded);
  const SharpSurface &sharp = surface (values.surface).surface ();
  double theta = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero ();
  for (std::size_t i = 0; i < padded; ++i)
  {
    if (i < places.size ())
      sharp.evaluate (places[i] + field_.points ().origin, theta, gradient);
    values.theta_at[i] = static_cast<float> (theta * inverse_unit_);
    for (std::size_t a = 0; a < 3; ++a)
      values.gradient_at[a][i] = static_cast<float> (gradient[static_cast<Eigen::Index> (a)]);
  }
}

void
BlockEnrichment::evaluateFrom (const std::vector<Eigen::Vector3d> &seen_from, Values &values) const
{
  values.theta_seen.clear ();
  for (const Eigen::Vector3d &place : seen_from)
    values.theta_seen.push_back (static_cast<float> (
        surface (values.surface).surface ().theta (place + field_.points ().origin) * inverse_unit_));
  if (!seen_from.empty ())
    values.theta_seen.resize (seen_from.size () + lanes::MAX_WIDTH, values.theta_seen.back ());
}

void
BlockEnrichment::measureExtentAtPoints (const std::vector<Eigen::Vector3d> &places, Values &values) const
{
  const EnrichingSurface &known = surface (values.surface);
  const std::size_t padded = known.isLimited () ? places.size () + lanes::MAX_WIDTH : 0;
  values.distance_at.resize (padded);
  for (std::vector<float> &component : values.away_at)
    component.resize (padded);
  double distance = 0.0;
  Eigen::Vector3d away = Eigen::Vector3d::Zero ();
  for (std::size_t i = 0; i < padded; ++i)
  {
    if (i < places.size ())
      distance = known.distanceFromExtent (places[i] + field_.points ().origin, away);
    values.distance_at[i] = static_cast<float> (distance * inverse_unit_);
    for (std::size_t a = 0; a < 3; ++a)
      values.away_at[a][i] = static_cast<float> (away[static_cast<Eigen::Index> (a)]);
  }
}

void
BlockEnrichment::showSurfaces (lanes::SharpSurfaces &sharp) const
{
  sharp.count = used_;
  sharp.jumps = field_.options ().enrichment == EnrichmentType::JUMP;
  for (std::size_t s = 0; s < used_; ++s)
  {
    const Values &values = values_[s];
    lanes::Surface &seen = sharp.surfaces[s];
    seen.theta = values.theta.data ();
    seen.theta_at = values.theta_at.data ();
    seen.theta_seen = values.theta_seen.empty () ? nullptr : values.theta_seen.data ();
    for (std::size_t a = 0; a < 3; ++a)
    {
      seen.gradient[a] = values.gradient[a].data ();
      seen.gradient_at[a] = values.gradient_at[a].data ();
      seen.away_at[a] = values.away_at[a].data ();
    }
    seen.distance_at = values.distance_at.empty () ? nullptr : values.distance_at.data ();
    seen.fade = static_cast<float> (surface (values.surface).fade () * inverse_unit_);
    seen.is_plane = surface (values.surface).isPlane ();
  }
}

/** \brief False where there are too many. */
bool
BlockEnrichment::listPencils (lanes::SharpSurfaces &sharp) const
{
  const auto place_of = [this] (int surface)
  {
    for (std::size_t s = 0; s < used_; ++s)
      if (values_[s].surface == surface)
        return static_cast<int> (s);
    return -1;
  };
  for (const Pencil &pencil : field_.pencils ())
  {
    const int a = place_of (pencil.surfaces[0]), b = place_of (pencil.surfaces[1]), c = place_of (pencil.surfaces[2]);
    if (a < 0 || b < 0 || c < 0)
      continue;
    if (sharp.pencil_count == lanes::SharpSurfaces::MOST)
      return false;
    sharp.pencils[sharp.pencil_count++] = {
        {a, b, c}, static_cast<float> (pencil.scale_a), static_cast<float> (pencil.scale_b)};
  }
  return true;
}

std::uint64_t
BlockEnrichment::sideKey (const BlockPoints &points, std::size_t i) const
{
  std::uint64_t key = 0;
  for (std::size_t s = 0; s < used_; ++s)
    if ((points.active[i] >> s & 1u) != 0)
      key = Enrichment::extendSideKey (key, values_[s].surface, values_[s].theta_at[i] < 0.0f);
  return key;
}

} // namespace erkpa
