// SPDX-License-Identifier: BSD-3-Clause
#include "block_field.h"

#include "enrichment.h"
#include "lane_settings.h"
#include "support.h"
#include "support_size.h"

#include <algorithm>
#include <cmath>

namespace erkpa
{

namespace
{

constexpr double ROUNDING = 1e-5; // of a length, in float

/** \brief What ε nowhere exceeds within \a extent of a place where it is \a radius, or next to nowhere. */
double
trustedRadius (double radius, double extent, bool on_surface)
{
  // Nodes are closer together in the middle; points are off the surface, all of them or where they have moved to.
  constexpr double UNEVEN = 1.25, ASIDE = 0.6, MOVED = 0.2;
  return std::min (radius + extent, std::hypot (UNEVEN * radius, (on_surface ? MOVED : ASIDE) * extent));
}

} // namespace

bool
BlockField::canEvaluate (const ImplicitField &field)
{
  const FieldOptions &options = field.options ();
  return laneKernelOf (options) && !options.warp && field.points ().shapes.empty () &&
         field.supportSize ().kind () != SupportSize::Kind::PER_NODE && field.supportSize ().typical () > 0.0;
}

BlockField::BlockField (const ImplicitField &field, const lanes::Engine &engine, const MomentLattice *lattice)
    : field_ (field), can_evaluate_ (canEvaluate (field)), engine_ (engine), unit_ (field.supportSize ().typical ()),
      inverse_unit_ (1.0 / unit_), settings_ (laneSettingsOf (field)), nodes_ (field, engine, unit_),
      faces_ (field, engine, settings_, unit_), enrichment_ (field, unit_),
      plain_ (static_cast<std::size_t> (field.points ().channels), termsOf (settings_.basis),
              field.faces () != nullptr),
      enriched_ (static_cast<std::size_t> (field.points ().channels), termsOf (settings_.basis),
                 field.faces () != nullptr),
      interpolated_ (static_cast<std::size_t> (field.points ().channels), 0, false),
      lattice_ (lattice, engine, static_cast<std::size_t> (field.points ().channels))
{
  setReach (1.0, 0.0, 0.0);
}

void
BlockField::setReach (double share, double offset, double near_enough, double farthest)
{
  farthest_ = farthest;
  settings_.reach = static_cast<float> (share);
  settings_.offset = static_cast<float> (offset * inverse_unit_);
  settings_.near_enough = static_cast<float> (near_enough * inverse_unit_);
}

bool
BlockField::gather (const Eigen::Vector3d &center, double extent, bool on_surface)
{
  clearPoints ();
  lattice_.clear ();
  if (!can_evaluate_)
    return false;
  // A middle that floats can say: then differences from it are exact.
  center_ = center.cast<float> ().cast<double> ();
  const double all = extent_ = extent + (center - center_).norm ();
  if (!findReach (center_, all, on_surface))
    return false;
  has_separations_ = faces_.gather (center_, all);
  const bool by_nearest = field_.supportSize ().kind () == SupportSize::Kind::NEAREST;
  const double farthest = (by_nearest ? center_radius_ + 2.0 * all : reach_) + field_.largestOffset ();
  enrichment_.gather (center_, (has_separations_ ? Support::PART_REACH : 1.0) * farthest);
  has_nodes_ = by_nearest;
  if (by_nearest)
    nodes_.addValues ();
  return true;
}

void
BlockField::copyNodes ()
{
  if (has_nodes_)
    return;
  nodes_.lookAround (center_, reach_);
  nodes_.copyWithin (reach_);
  has_nodes_ = true;
}

/** \brief See Support::gather (). */
bool
BlockField::findReach (const Eigen::Vector3d &center, double extent, bool on_surface)
{
  const SupportSize &size = field_.supportSize ();
  if (size.kind () != SupportSize::Kind::NEAREST)
  {
    center_radius_ = size.radiusAt (center);
    const double stretch = size.kind () == SupportSize::Kind::FUNCTION ? 2.0 : 1.0;
    reach_ = std::max (center_radius_, 0.0) + stretch * extent;
    return true;
  }
  constexpr double FARTHEST = 1e18; // its square is still a float
  const auto k = static_cast<std::size_t> (settings_.k);
  double guess = 1.15 * (center_radius_ > 0.0 ? std::min (center_radius_, 2.0 * unit_) : unit_);
  for (; center.norm () < FARTHEST && guess < FARTHEST; guess *= 2.0)
  {
    nodes_.copyAround (center, trustedRadius (guess, extent, on_surface) + extent);
    if (nodes_.count () < k)
      continue;
    center_radius_ = nodes_.boundOfKth (k, guess);
    if (!(center_radius_ <= guess))
      continue;
    trusted_ = trustedRadius (center_radius_, extent, on_surface);
    reach_ = trusted_ + extent;
    return true;
  }
  center_radius_ = 0.0;
  return false;
}

void
BlockField::widen ()
{
  trusted_ = center_radius_ + extent_;
  reach_ = trusted_ + extent_;
  nodes_.lookAround (center_, reach_);
  nodes_.copyWithin (reach_);
}

double
BlockField::reachAt (const Eigen::Vector3d &x, bool with_parts) const
{
  const bool is_function = field_.supportSize ().kind () == SupportSize::Kind::FUNCTION;
  const double radius = (is_function ? reach_ : center_radius_) + (x - center_).norm ();
  return ((with_parts ? Support::PART_REACH : 1.0) * radius + field_.largestOffset ()) * (1.0 + ROUNDING);
}

void
BlockField::clearPoints ()
{
  places_.clear ();
  plain_.clear ();
  interpolated_.clear ();
  at_faces_.clear ();
  enriched_.clear ();
  enriched_at_.clear ();
  enriched_reach_ = 0.0;
  seen_from_.clear ();
  side_questions_.clear ();
}

bool
BlockField::addPoint (const Eigen::Vector3d &x)
{
  const bool is_at_faces = has_separations_ && faces_.groups ().hasSeparationAt (x);
  if (is_at_faces && !BlockFaces::canEvaluate (field_))
    return false;
  const double reach = enrichment_.isEmpty () ? 0.0 : reachAt (x, is_at_faces);
  if (!enrichment_.isAbsentAt (x, reach))
  {
    if (is_at_faces || !enrichment_.canEvaluateAt (x, reach))
      return false;
    addEnriched (x, reach);
    return true;
  }
  if (lattice_.covers (x))
  {
    places_.push_back ({Kind::INTERPOLATED, static_cast<std::uint32_t> (interpolated_.size ()), -1});
    interpolated_.add (((x - center_) * inverse_unit_).cast<float> ());
    return true;
  }
  addPlain (x, is_at_faces);
  return true;
}

void
BlockField::addEnriched (const Eigen::Vector3d &x, double reach)
{
  places_.push_back ({Kind::ENRICHED, static_cast<std::uint32_t> (enriched_.size ()), -1});
  enriched_.add (((x - center_) * inverse_unit_).cast<float> ());
  enriched_at_.push_back (x);
  enriched_reach_ = std::max (enriched_reach_, reach);
}

void
BlockField::addPlain (const Eigen::Vector3d &x, bool is_at_faces)
{
  const auto index = static_cast<std::uint32_t> (plain_.size ());
  places_.push_back ({Kind::PLAIN, index, is_at_faces ? static_cast<int> (at_faces_.size ()) : -1});
  if (is_at_faces)
    at_faces_.push_back (index);
  plain_.add (((x - center_) * inverse_unit_).cast<float> ());
}

/** \brief What is known of ε at the points. */
void
BlockField::setRadii (BlockPoints &points) const
{
  const SupportSize &size = field_.supportSize ();
  const auto radius = static_cast<float> (center_radius_ * inverse_unit_);
  const auto trusted = static_cast<float> (trusted_ * inverse_unit_);
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    const Eigen::Vector3f x = points.position (i);
    float bound = radius;
    if (size.kind () == SupportSize::Kind::NEAREST)
      bound = std::min (radius + x.norm (), trusted) * static_cast<float> (1.0 + ROUNDING); // ε is 1-Lipschitz
    else if (size.kind () == SupportSize::Kind::FUNCTION)
    {
      const Eigen::Vector3d position = center_ + unit_ * x.cast<double> ();
      bound = static_cast<float> (size.radiusAt (position) * inverse_unit_);
      points.setGrowth (i, size.radiusGradientAt (position).cast<float> ());
    }
    points.setRadius (i, bound, radius);
  }
}

void
BlockField::evaluate (bool gradients)
{
  settings_.gradients = gradients;
  evaluations_ += size ();
  if (interpolated_.size () > 0)
  {
    if (!lattice_.evaluate (settings_, center_, unit_, interpolated_))
      interpolated_.leaveOpen ();
    takeUnsettled ();
  }
  runAll (true);
  finishPlain ();
  finishEnriched ();
}

void
BlockField::runAll (bool attributes)
{
  run (attributes);
  if (!plain_.hasShort () && !enriched_.hasShort ())
    return;
  widen ();
  run (attributes);
}

void
BlockField::takeUnsettled ()
{
  for (Place &place : places_)
    if (place.kind == Kind::INTERPOLATED)
    {
      if (interpolated_.states[place.index] == lanes::State::DEFINED)
      {
        support_nodes_ += interpolated_.supports[place.index];
        continue;
      }
      const Eigen::Vector3f x = interpolated_.position (place.index);
      place = {Kind::PLAIN, static_cast<std::uint32_t> (plain_.size ()), -1};
      plain_.add (x);
    }
}

void
BlockField::run (bool attributes)
{
  if (plain_.size () + enriched_.size () > 0)
    copyNodes ();
  const bool has_attributes = attributes && settings_.gradients && plain_.size () + enriched_.size () > 0;
  if (has_attributes)
    nodes_.copyAttributes ();
  if (plain_.size () > 0)
  {
    setRadii (plain_);
    const bool is_function = field_.supportSize ().kind () == SupportSize::Kind::FUNCTION;
    plain_.run (engine_, settings_, nodes_.view (has_attributes), is_function);
  }
  if (enriched_.size () > 0)
  {
    setRadii (enriched_);
    enrichment_.run (engine_, settings_, nodes_.view (has_attributes), nodes_, enriched_at_, seen_from_,
                     enriched_reach_, enriched_);
  }
}

void
BlockField::finishPlain ()
{
  for (std::size_t i = 0; i < plain_.size (); ++i)
    support_nodes_ += plain_.supports[i];
  refuseUncovered (plain_);
  if (!at_faces_.empty ())
    faces_.combine (settings_, nodes_.view (false), at_faces_, plain_);
}

void
BlockField::finishEnriched ()
{
  for (std::size_t i = 0; i < enriched_.size (); ++i)
  {
    support_nodes_ += enriched_.supports[i];
    const auto nearest = static_cast<double> (enriched_.nearest_distances[i]);
    if (nearest > static_cast<double> (settings_.near_enough) &&
        FaceVote::isBeyondBorder (nearest - static_cast<double> (settings_.offset),
                                  static_cast<double> (enriched_.radii[i]), static_cast<double> (enriched_.asides[i])))
      enriched_.in_reach[i] = 0;
  }
  refuseUncovered (enriched_);
}

/** \brief A radius that is a function may reach farther than was gathered for: see Support::covers (). */
void
BlockField::refuseUncovered (BlockPoints &points) const
{
  if (field_.supportSize ().kind () != SupportSize::Kind::FUNCTION)
    return;
  for (std::size_t i = 0; i < points.size (); ++i)
    if (unit_ * static_cast<double> (points.position (i).norm () + points.bound (i)) > reach_ * (1.0 + ROUNDING))
      points.states[i] = lanes::State::UNSETTLED;
}

int
BlockField::face (std::size_t point) const
{
  if (field_.faces () == nullptr)
    return -1;
  const int place = places_[point].at_faces;
  const int face = place < 0 ? -1 : faces_.face (static_cast<std::size_t> (place));
  return face >= 0 ? face : field_.faces ()->faceOf (nodes_.node (at (point).nearest[placeOf (point)]));
}

std::uint64_t
BlockField::sideKey (std::size_t point) const
{
  return sideKeyOf (face (point),
                    places_[point].kind == Kind::ENRICHED ? enrichment_.sideKey (enriched_, placeOf (point)) : 0);
}

double
BlockField::thickening (std::size_t point) const
{
  const int place = places_[point].at_faces;
  return place < 0 ? 0.0 : faces_.thickening (static_cast<std::size_t> (place));
}

} // namespace erkpa
