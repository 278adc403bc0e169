// SPDX-License-Identifier: BSD-3-Clause
#include "block_enrichment.h"

#include "enrichment.h"
#include "support_size.h"

#include <algorithm>
#include <cmath>

namespace erkpa
{

namespace
{

using Kind = SharpSurfaceParts::Kind;

/** \brief Whether a surface is in force everywhere and cheap to ask. */
bool
isPlainModel (const SharpSurfaceParts &parts)
{
  return parts.kind == Kind::MODEL ||
         (parts.plane != nullptr && (parts.kind == Kind::BETWEEN || parts.kind == Kind::REVERSED));
}

} // namespace

BlockEnrichment::BlockEnrichment (const ImplicitField &field, double unit)
    : field_ (field), inverse_unit_ (1.0 / unit),
      can_evaluate_ (field.options ().constraint != Constraint::OFFSURFACE && field.options ().flatten >= 1.0 &&
                     (field.options ().order == Order::LINEAR || field.options ().order == Order::SPHERICAL))
{
  for (const SharpSurface::ConstPtr &surface : field.enrichingSurfaces ())
  {
    const SpaceWarp *warp = nullptr;
    is_plane_.push_back (planeBehind (*surface, &warp) != nullptr && warp == nullptr ? 1 : 0);
    parts_.push_back (surface->parts ());
    const SharpSurfaceParts whole =
        parts_.back ().kind == Kind::LIMITED ? parts_.back ().surface->parts () : parts_.back ();
    is_handled_.push_back (can_evaluate_ && isPlainModel (whole) ? 1 : 0);
    planes_.push_back (whole.plane);
  }
}

void
BlockEnrichment::gather (const Eigen::Vector3d &center, double reach)
{
  near_.clear ();
  const Eigen::Vector3d position = center + field_.points ().origin;
  for (std::size_t i = 0; i < field_.enrichingSurfaces ().size (); ++i)
  {
    const int index = static_cast<int> (i);
    if (surface (index).isAbsentIn (position, reach))
      continue;
    const Near near{index, is_plane_[i] != 0, is_handled_[i] != 0};
    if (isInReach (near, center, reach))
      near_.push_back (near);
  }
}

bool
BlockEnrichment::isInReach (const Near &near, const Eigen::Vector3d &x, double reach) const
{
  return !near.is_plane || std::abs (surface (near.surface).theta (x + field_.points ().origin)) <= reach;
}

bool
BlockEnrichment::isAbsentAt (const Eigen::Vector3d &x, double reach) const
{
  return std::none_of (near_.begin (), near_.end (), [&] (const Near &near) { return isInReach (near, x, reach); });
}

bool
BlockEnrichment::canEvaluateAt (const Eigen::Vector3d &x, double reach) const
{
  return std::all_of (near_.begin (), near_.end (),
                      [&] (const Near &near) { return near.is_handled || !isInReach (near, x, reach); });
}

void
BlockEnrichment::run (const lanes::Engine &engine, const lanes::Settings &settings, const lanes::Nodes &view,
                      const BlockNodes &nodes, const std::vector<Eigen::Vector3d> &places,
                      const std::vector<Eigen::Vector3d> &seen_from, double reach, BlockPoints &points)
{
  used_ = 0;
  std::size_t wanted = 0;
  for (const Near &near : near_)
  {
    if (!near.is_handled || std::none_of (places.begin (), places.end (),
                                          [&] (const Eigen::Vector3d &x) { return isInReach (near, x, reach); }))
      continue;
    if (++wanted > values_.size ())
      break;
    Values &values = values_[used_++];
    values.surface = near.surface;
    const SharpPlane *plane = planes_[static_cast<std::size_t> (near.surface)];
    if (plane != nullptr)
      evaluatePlaneAtNodes (*plane, nodes, values);
    else
      evaluateAtNodes (nodes, values);
    evaluateAtPoints (places, values);
    evaluateFrom (seen_from, values);
    measureExtentAtPoints (places, values);
  }
  lanes::SharpSurfaces sharp = viewOfSurfaces ();
  const bool has_all = listPencils (sharp) && wanted <= values_.size ();
  const bool is_function = field_.supportSize ().kind () == SupportSize::Kind::FUNCTION;
  points.run (engine, settings, view, is_function, &sharp);
  if (!has_all)
    std::fill_n (points.states.begin (), points.size (), lanes::State::UNSETTLED);
}

void
BlockEnrichment::evaluateAtNodes (const BlockNodes &nodes, Values &values) const
{
  values.theta.resize (nodes.count ());
  for (std::vector<float> &component : values.gradient)
    component.resize (nodes.count ());
  const SharpSurface &sharp = surface (values.surface);
  for (std::size_t i = 0; i < nodes.count (); ++i)
  {
    double theta = 0.0;
    Eigen::Vector3d gradient;
    sharp.evaluate (nodes.position (i).cast<double> () + field_.points ().origin, theta, gradient);
    values.theta[i] = static_cast<float> (theta * inverse_unit_);
    for (std::size_t a = 0; a < 3; ++a)
      values.gradient[a][i] = static_cast<float> (gradient[static_cast<Eigen::Index> (a)]);
  }
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
  const SharpSurface &sharp = surface (values.surface);
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
    values.theta_seen.push_back (
        static_cast<float> (surface (values.surface).theta (place + field_.points ().origin) * inverse_unit_));
  if (!seen_from.empty ())
    values.theta_seen.resize (seen_from.size () + lanes::MAX_WIDTH, values.theta_seen.back ());
}

void
BlockEnrichment::measureExtentAtPoints (const std::vector<Eigen::Vector3d> &places, Values &values) const
{
  const Extent *const extent = parts_[static_cast<std::size_t> (values.surface)].extent.get ();
  const std::size_t padded = extent != nullptr ? places.size () + lanes::MAX_WIDTH : 0;
  values.distance_at.resize (padded);
  for (std::vector<float> &component : values.away_at)
    component.resize (padded);
  double distance = 0.0;
  Eigen::Vector3d away = Eigen::Vector3d::Zero ();
  for (std::size_t i = 0; i < padded; ++i)
  {
    if (i < places.size ())
      distance = extent->distance (places[i] + field_.points ().origin, &away);
    values.distance_at[i] = static_cast<float> (distance * inverse_unit_);
    for (std::size_t a = 0; a < 3; ++a)
      values.away_at[a][i] = static_cast<float> (away[static_cast<Eigen::Index> (a)]);
  }
}

lanes::SharpSurfaces
BlockEnrichment::viewOfSurfaces () const
{
  lanes::SharpSurfaces sharp{};
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
    seen.fade = static_cast<float> (parts_[static_cast<std::size_t> (values.surface)].fade * inverse_unit_);
    seen.is_plane = is_plane_[static_cast<std::size_t> (values.surface)] != 0;
  }
  return sharp;
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
    if (sharp.pencil_count == lanes::SharpSurfaces::MAX_PENCILS)
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
