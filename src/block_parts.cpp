// SPDX-License-Identifier: BSD-3-Clause
#include "block_parts.h"

#include "lane_settings.h"
#include "support.h"
#include "support_size.h"

#include <algorithm>
#include <numeric>

namespace erkpa
{

BlockParts::BlockParts (const ImplicitField &field, const lanes::Engine &engine, const lanes::Settings &settings,
                        double unit)
    : field_ (field), engine_ (engine), settings_ (settings), unit_ (unit), groups_ (field.faces ()),
      all_ (field, engine, unit), at_part_ (0, termsOf (settings.basis), true),
      part_reach_ (field.supportSize ().kind () == SupportSize::Kind::NEAREST ? Support::PART_REACH : 1.0)
{
}

bool
BlockParts::gather (const Eigen::Vector3d &center, double extent)
{
  center_ = center;
  reach_of_parts_ = reach_of_near_ = 0.0;
  return groups_.gather (center, extent);
}

bool
BlockParts::start (const lanes::Settings &settings, const std::vector<std::uint32_t> &which, const BlockPoints &points)
{
  settings_ = settings;
  settings_.k = Support::neighborsOfPart (settings.k);
  settings_.limited = true;
  parts_.clear ();
  gatherNodes (which, points);
  return groups_.present () <= MAX_PRESENT;
}

/** \brief All nodes that fits to parts of them can reach at some points: see Support::gatherForParts (). */
void
BlockParts::gatherNodes (const std::vector<std::uint32_t> &which, const BlockPoints &points)
{
  constexpr double SPARE = 1.02; // for where the points move to
  double of_parts = 0.0, of_near = 0.0;
  for (const std::uint32_t point : which)
  {
    if (points.states[point] != lanes::State::DEFINED)
      continue;
    const auto away = static_cast<double> (points.position (point).norm ());
    const auto radius = static_cast<double> (points.radii[point]);
    of_parts = std::max (of_parts, unit_ * (part_reach_ * radius + away));
    of_near = std::max (of_near, unit_ * (FaceGroups::REACH * radius + away));
  }
  if (of_parts <= reach_of_parts_ && of_near <= reach_of_near_)
    return;
  reach_of_parts_ = SPARE * of_parts;
  reach_of_near_ = SPARE * of_near;
  all_.copyAround (center_, reach_of_parts_);
  groups_.assign (all_.count (), [this] (std::size_t i) { return all_.node (i); });
  sortByFace ();
  findNearPoints (static_cast<float> (reach_of_near_ / unit_));
}

/** \brief List the nodes of each face. */
void
BlockParts::sortByFace ()
{
  known_groups_.clear ();
  const auto face_of = [this] (std::size_t i)
  { return static_cast<std::size_t> (groups_.placeOfSlot (static_cast<int> (i))) + 1; }; // -1 wraps around to 0
  ends_of_faces_.assign (groups_.present () + 1, 0);
  for (std::size_t i = 0; i < all_.count (); ++i)
    ++ends_of_faces_[face_of (i)];
  std::exclusive_scan (ends_of_faces_.begin (), ends_of_faces_.end (), ends_of_faces_.begin (), std::size_t (0));
  makeRoom (all_.count (), by_face_);
  for (std::size_t i = 0; i < all_.count (); ++i)
    by_face_[ends_of_faces_[face_of (i)]++] = static_cast<std::uint32_t> (i);
}

/** \brief Lay the nodes in reach of lists side by side. */
void
BlockParts::findNearPoints (float reach)
{
  const std::size_t room = all_.count () + lanes::MAX_WIDTH;
  makeRoom (room, places_);
  lanes::Table table{};
  lanes::Copies copies{places_.data (), {}, nullptr};
  for (std::size_t a = 0; a < 3; ++a)
  {
    makeRoom (room, near_points_[a]);
    table.columns[a] = all_.coordinates (a);
    copies.columns[a] = near_points_[a].data ();
  }
  const lanes::Stretch all{0, static_cast<std::uint32_t> (all_.count ())};
  const std::array<float, 3> center{};
  near_faces_.resize (engine_.search->copyWithin (table, &all, 1, center.data (), reach * reach, 1.0f, copies));
  for (std::size_t i = 0; i < near_faces_.size (); ++i)
    near_faces_[i] = groups_.placeOfSlot (static_cast<int> (places_[i]));
}

void
BlockParts::listNear (const Eigen::Vector3f &x, float radius, lanes::Copies copies)
{
  const auto reach = static_cast<float> (FaceGroups::REACH) * radius;
  copies.places = places_.data ();
  const lanes::Table table{{near_points_[0].data (), near_points_[1].data (), near_points_[2].data ()}};
  const lanes::Stretch all{0, static_cast<std::uint32_t> (near_faces_.size ())};
  near_.resize (engine_.search->copyWithin (table, &all, 1, x.data (), reach * reach, 1.0f / radius, copies));
  for (std::size_t n = 0; n < near_.size (); ++n)
    near_[n] = near_faces_[places_[n]];
}

bool
BlockParts::select (const Eigen::Vector3f &x)
{
  return groups_.select (center_ + unit_ * x.cast<double> (), near_);
}

void
BlockParts::ask (std::uint32_t point, int group)
{
  Part part{};
  part.point = point;
  part.faces = groups_.facesOf (group);
  part.state = lanes::State::UNDEFINED;
  parts_.push_back (part);
}

void
BlockParts::fit (const BlockPoints &points)
{
  std::vector<std::uint64_t> groups;
  for (const Part &part : parts_)
    if (std::find (groups.begin (), groups.end (), part.faces) == groups.end ())
      groups.push_back (part.faces);
  for (const std::uint64_t faces : groups)
    fitGroup (points, faces);
}

/** \brief The nodes of a group; the same ones are mostly asked for again. */
const BlockNodes &
BlockParts::nodesOf (std::uint64_t faces)
{
  const auto known = std::find (known_groups_.begin (), known_groups_.end (), faces);
  const auto place = static_cast<std::size_t> (known - known_groups_.begin ());
  if (known != known_groups_.end ())
    return of_groups_[place];
  known_groups_.push_back (faces);
  if (place == of_groups_.size ())
    of_groups_.emplace_back (field_, engine_, unit_);
  BlockNodes &nodes = of_groups_[place];
  nodes.clear ();
  for (std::size_t face = 0; face < groups_.present (); ++face)
    if ((faces >> face & 1) != 0)
      nodes.append (all_, by_face_.data () + ends_of_faces_[face], by_face_.data () + ends_of_faces_[face + 1]);
  nodes.addValues ();
  return nodes;
}

/** \brief The fits to one group at all points that ask for it. */
void
BlockParts::fitGroup (const BlockPoints &points, std::uint64_t faces)
{
  const BlockNodes &nodes = nodesOf (faces);
  at_part_.clear ();
  parts_to_fit_.clear ();
  for (std::uint32_t p = 0; p < parts_.size (); ++p)
    if (parts_[p].faces == faces)
    {
      parts_to_fit_.push_back (p);
      at_part_.add (points.position (parts_[p].point));
    }
  for (std::size_t i = 0; i < parts_to_fit_.size (); ++i)
  {
    const std::size_t point = parts_[parts_to_fit_[i]].point;
    const float radius = points.radii[point], limit = static_cast<float> (part_reach_) * radius;
    at_part_.setRadius (i, limit, radius);
    if (settings_.gradients)
      at_part_.setGrowth (i, static_cast<float> (part_reach_) *
                                 Eigen::Vector3f (points.radius_gradients[0][point], points.radius_gradients[1][point],
                                                  points.radius_gradients[2][point]));
  }
  at_part_.run (engine_, settings_, nodes.view (false), settings_.gradients);
  evaluations_ += parts_to_fit_.size ();
  for (std::size_t i = 0; i < parts_to_fit_.size (); ++i)
  {
    support_nodes_ += at_part_.supports[i];
    takeUp (i, nodes, parts_[parts_to_fit_[i]]);
  }
}

void
BlockParts::takeUp (std::size_t i, const BlockNodes &nodes, Part &part) const
{
  part.state = at_part_.states[i];
  part.value = at_part_.values[i];
  part.radius = at_part_.radii[i];
  part.aside = at_part_.asides[i];
  part.nearest = at_part_.nearest_distances[i];
  if (part.state == lanes::State::UNDEFINED)
    return;
  part.face = field_.faces ()->faceOf (nodes.node (at_part_.nearest[i]));
  for (std::size_t j = 0; j < termsOf (settings_.basis); ++j)
    part.coefficients[j] = at_part_.coefficient (i, j);
  if (!settings_.gradients)
    return;
  part.border_offset = at_part_.border_offsets[i];
  for (std::size_t a = 0; a < 3; ++a)
    part.gradient[static_cast<Eigen::Index> (a)] = at_part_.gradients[a][i];
}

} // namespace erkpa
