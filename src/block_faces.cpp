// SPDX-License-Identifier: BSD-3-Clause
#include "block_faces.h"

#include "lane_settings.h"

#include "support.h"
#include "support_size.h"

#include <algorithm>
#include <cmath>

namespace erkpa
{

BlockFaces::BlockFaces (const ImplicitField &field, const lanes::Engine &engine, const lanes::Settings &settings,
                        double unit)
    : field_ (field), engine_ (engine), settings_ (settings), unit_ (unit), groups_ (field.faces ()),
      all_ (field, engine, unit), near_points_ (field, engine, unit), of_part_ (field, engine, unit),
      at_part_ (0, termsOf (settings.basis), true)
{
}

bool
BlockFaces::canEvaluate (const ImplicitField &field)
{
  const FieldOptions &options = field.options ();
  return field.supportSize ().kind () == SupportSize::Kind::NEAREST && options.order != Order::CONSTANT &&
         options.flatten >= 1.0;
}

bool
BlockFaces::gather (const Eigen::Vector3d &center, double extent)
{
  center_ = center;
  reach_of_parts_ = reach_of_voters_ = 0.0;
  return groups_.gather (center, extent);
}

/** \brief All nodes that fits to parts of them can reach at some points: see Support::gatherForParts (). */
void
BlockFaces::gatherNodes (const std::vector<std::uint32_t> &which, const BlockPoints &points)
{
  constexpr double SPARE = 1.02; // for where the points move to
  double of_parts = 0.0, of_voters = 0.0;
  for (const std::uint32_t point : which)
  {
    if (points.states[point] != lanes::State::DEFINED)
      continue;
    const auto away = static_cast<double> (points.position (point).norm ());
    const auto radius = static_cast<double> (points.radii[point]);
    of_parts = std::max (of_parts, unit_ * (Support::PART_REACH * radius + away));
    of_voters = std::max (of_voters, unit_ * (FaceGroups::REACH * radius + away));
  }
  if (of_parts <= reach_of_parts_ && of_voters <= reach_of_voters_)
    return;
  reach_of_parts_ = SPARE * of_parts;
  reach_of_voters_ = SPARE * of_voters;
  all_.find (center_, reach_of_parts_);
  groups_.assign (all_.count (), [this] (std::size_t i) { return all_.node (i); });
  slots_.clear ();
  const auto is_near = [&, limit = static_cast<float> (reach_of_voters_ * reach_of_voters_)] (std::size_t i)
  {
    const bool is_in_reach = all_.squaredDistance (i) <= limit;
    if (is_in_reach)
      slots_.push_back (static_cast<int> (i));
    return is_in_reach;
  };
  near_points_.select (all_, is_near);
  near_points_.copyPositions ();
}

void
BlockFaces::combine (const lanes::Settings &settings, const lanes::Nodes &nodes,
                     const std::vector<std::uint32_t> &which, BlockPoints &points)
{
  settings_ = settings;
  settings_.k = Support::neighborsOfPart (settings.k);
  settings_.limited = true;
  gatherNodes (which, points);
  if (groups_.present () > MAX_PRESENT)
    for (const std::uint32_t point : which)
      points.states[point] = lanes::State::UNSETTLED;
  combined_.assign (which.size (), Combined ());
  listed_ = 0;
  parts_.clear ();
  for (std::size_t i = 0; i < which.size (); ++i)
    if (points.states[which[i]] == lanes::State::DEFINED && !isClearOfSurface (nodes, points, which[i]))
      askForParts (points, which[i], combined_[i]);
  fitParts (points);
  for (std::size_t i = 0; i < which.size (); ++i)
    vote (points, which[i], combined_[i]);
}

/** \brief The nodes that have a say at x (see FaceGroups::REACH), as voters whose weights are squared distances yet. */
void
BlockFaces::listNear (const Eigen::Vector3f &x, float radius)
{
  const auto reach = static_cast<float> (FaceGroups::REACH) * radius;
  const std::size_t room = near_points_.count () + lanes::MAX_WIDTH;
  makeRoom (room, places_);
  makeRoom (listed_ + room, weights_);
  lanes::Table table{};
  lanes::Copies copies{places_.data (), {}, weights_.data () + listed_};
  for (std::size_t a = 0; a < 3; ++a)
  {
    makeRoom (listed_ + room, voters_[a]);
    table.columns[a] = near_points_.coordinates (a);
    copies.columns[a] = voters_[a].data () + listed_;
  }
  const lanes::Stretch all{0, static_cast<std::uint32_t> (near_points_.count ())};
  near_.resize (engine_.search->copyWithin (table, &all, 1, x.data (), reach * reach, 1.0f / radius, copies));
  for (std::size_t n = 0; n < near_.size (); ++n)
    near_[n] = slots_[places_[n]];
}

/** \brief Whether a point is so clear of the surface that the fit to all nodes tells its side, whatever the faces.
 *
 * The steeper the fit, the less the faces turn, and the less it rounds between them; in thin walls it says anything,
 * which the nearest node tells. Of such points of sampled solids less than one in a thousand was on the other side of
 * what the faces make, all where data contradicts itself. Functional values have no slope, and are never clear.
 */
bool
BlockFaces::isClearOfSurface (const lanes::Nodes &nodes, const BlockPoints &points, std::uint32_t point) const
{
  constexpr float FAR = 0.15f, STEEP = 0.9f; // support radii
  const float radius = points.radii[point], value = points.values[point] - level_;
  const Eigen::Vector3f slope (points.coefficient (point, 1), points.coefficient (point, 2),
                               points.coefficient (point, 3));
  if (settings_.gradients || !(std::abs (value) >= FAR * radius) || slope.norm () < STEEP * radius ||
      !FaceVote::isOneFaceEnough (static_cast<double> (points.nearest_distances[point]), static_cast<double> (radius),
                                  least_wall_))
    return false;
  const std::size_t i = points.nearest[point];
  const Eigen::Vector3f way = points.position (point) - Eigen::Vector3f (nodes.x[i], nodes.y[i], nodes.z[i]);
  const float height = way.dot (Eigen::Vector3f (nodes.nx[i], nodes.ny[i], nodes.nz[i])) - level_;
  return (value > 0.0f ? height : -height) >= FAR * radius;
}

/** \brief Whether the nodes close to the point at hand are of one face. */
bool
BlockFaces::holdsOneFace (float radius)
{
  const float close = static_cast<float> (FaceGroups::CLOSE) * radius;
  slots_close_.clear ();
  for (std::size_t n = 0; n < near_.size (); ++n)
    if (weights_[listed_ + n] <= close * close)
      slots_close_.push_back (near_[n]);
  return groups_.areOfOneFace (slots_close_);
}

/** \brief List the groups that a point sees, and the nodes that will vote. */
void
BlockFaces::askForParts (const BlockPoints &points, std::uint32_t point, Combined &combined)
{
  combined.first_part = parts_.size ();
  combined.first_voter = combined.last_voter = listed_;
  const Eigen::Vector3f x = points.position (point);
  const float radius = points.radii[point];
  listNear (x, radius);
  const auto nearest = static_cast<double> (points.nearest_distances[point]);
  if (FaceVote::isOneFaceEnough (nearest, static_cast<double> (radius), least_wall_) && holdsOneFace (radius))
    return;
  if (!groups_.select (center_ + unit_ * x.cast<double> (), near_))
    return;
  combined.groups = std::min (groups_.count (), FaceTree::MAX_FACES);
  for (int group = 0; group < combined.groups; ++group)
  {
    Part part{};
    part.point = point;
    part.faces = groups_.facesOf (group);
    part.state = lanes::State::UNDEFINED;
    parts_.push_back (part);
  }
  weighVoters (radius, combined);
}

/** \brief Those that are of a point's groups have a vote; the last vector of them is filled up. */
void
BlockFaces::weighVoters (float radius, Combined &combined)
{
  const float fall = 1.0f / radius / static_cast<float> (FaceGroups::REACH);
  float *const weights = weights_.data () + listed_;
  const std::size_t count = near_.size ();
  for (std::size_t n = 0; n < count; ++n)
  {
    const int group = groups_.groupOfSlot (near_[n]);
    const float weight = std::max (1.0f - std::sqrt (weights[n]) * fall, 0.0f);
    weights[n] = group >= 0 && group < combined.groups ? weight : 0.0f;
  }
  listed_ += count;
  combined.last_voter = listed_;
  for (const auto array : {&voters_[0], &voters_[1], &voters_[2], &weights_})
    std::fill_n (array->begin () + static_cast<std::ptrdiff_t> (listed_), lanes::MAX_WIDTH, 0.0f);
  listed_ += lanes::MAX_WIDTH;
}

void
BlockFaces::fitParts (const BlockPoints &points)
{
  std::vector<std::uint64_t> groups;
  for (const Part &part : parts_)
    if (std::find (groups.begin (), groups.end (), part.faces) == groups.end ())
      groups.push_back (part.faces);
  for (const std::uint64_t faces : groups)
    fitPart (points, faces);
}

/** \brief The fits to one group at all points that see it. */
void
BlockFaces::fitPart (const BlockPoints &points, std::uint64_t faces)
{
  of_part_.select (all_, [&] (std::size_t i) { return groups_.isOfFaces (static_cast<int> (i), faces); });
  of_part_.copy ();
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
    const float radius = points.radii[point], limit = static_cast<float> (Support::PART_REACH) * radius;
    at_part_.setRadius (i, limit, radius);
    if (settings_.gradients)
      at_part_.setGrowth (i, static_cast<float> (Support::PART_REACH) *
                                 Eigen::Vector3f (points.radius_gradients[0][point], points.radius_gradients[1][point],
                                                  points.radius_gradients[2][point]));
  }
  at_part_.run (engine_, settings_, of_part_.view (false), settings_.gradients);
  evaluations_ += parts_to_fit_.size ();
  for (std::size_t i = 0; i < parts_to_fit_.size (); ++i)
  {
    support_nodes_ += at_part_.supports[i];
    takeUp (i, parts_[parts_to_fit_[i]]);
  }
}

void
BlockFaces::takeUp (std::size_t i, Part &part) const
{
  part.state = at_part_.states[i];
  part.value = at_part_.values[i];
  part.radius = at_part_.radii[i];
  part.aside = at_part_.asides[i];
  part.nearest = at_part_.nearest_distances[i];
  if (part.state == lanes::State::UNDEFINED)
    return;
  part.face = field_.faces ()->faceOf (of_part_.node (at_part_.nearest[i]));
  for (std::size_t j = 0; j < termsOf (settings_.basis); ++j)
    part.coefficients[j] = at_part_.coefficient (i, j);
  if (!settings_.gradients)
    return;
  part.border_offset = at_part_.border_offsets[i];
  for (std::size_t a = 0; a < 3; ++a)
    part.gradient[static_cast<Eigen::Index> (a)] = at_part_.gradients[a][i];
}

/** \brief FaceVote::electTree () in lanes. */
const FaceTree &
BlockFaces::electTree (const Combined &combined, float radius) const
{
  const std::vector<FaceTree> &trees = treesOf (static_cast<int> (vote_.size ()));
  if (trees.size () == 1)
    return trees.front ();
  lanes::Voters voters{combined.last_voter - combined.first_voter, {}, weights_.data () + combined.first_voter};
  for (std::size_t a = 0; a < 3; ++a)
    voters.u[a] = voters_[a].data () + combined.first_voter;
  lanes::FaceFits fits{vote_.size (), settings_.basis, {}, {}};
  for (std::size_t face = 0; face < vote_.size (); ++face)
  {
    const Part &part = parts_[combined.first_part + static_cast<std::size_t> (vote_.groupOf (face))];
    fits.coefficients[face] = part.coefficients.data ();
    fits.scale[face] = radius / part.radius;
  }
  std::array<float, lanes::Trees::MAX> distances;
  engine_.measureTrees (voters, fits, laneTreesOf (vote_.size ()), distances.data ());
  const auto last = distances.begin () + static_cast<std::ptrdiff_t> (trees.size ());
  return trees[static_cast<std::size_t> (std::min_element (distances.begin (), last) - distances.begin ())];
}

/** \brief The nodes around a point say how its groups combine; the result takes the place of the fit to all nodes. */
void
BlockFaces::vote (BlockPoints &points, std::uint32_t point, Combined &combined)
{
  if (combined.groups < 2)
  {
    settleReach (points, point, static_cast<double> (points.asides[point]));
    return;
  }
  const auto radius = static_cast<double> (points.radii[point]);
  vote_.start (radius);
  for (int group = 0; group < combined.groups; ++group)
  {
    const Part &part = parts_[combined.first_part + static_cast<std::size_t> (group)];
    if (part.state == lanes::State::UNDEFINED)
      continue;
    const auto own_radius = static_cast<double> (part.radius);
    const Eigen::Vector3d slope =
        Eigen::Vector3f (part.coefficients[1], part.coefficients[2], part.coefficients[3]).cast<double> () / own_radius;
    vote_.addFace (group, static_cast<double> (part.value), slope, static_cast<double> (part.nearest), {});
  }
  vote_.dropFarFaces ();
  points.states[point] = lanes::State::UNDEFINED;
  points.values[point] = std::nanf ("");
  double aside = static_cast<double> (points.asides[point]);
  if (vote_.size () > 0)
  {
    const FaceTree &tree = electTree (combined, points.radii[point]);
    const std::size_t winner = vote_.winnerOf (tree);
    const Part &part = parts_[combined.first_part + static_cast<std::size_t> (vote_.groupOf (winner))];
    const double spacing = radius * std::sqrt (M_PI / static_cast<double> (points.supports[point]));
    combined.thickening = vote_.thickening (tree, least_wall_);
    combined.face = part.face;
    aside = vote_.isInThinWall (tree, spacing) ? 0.0 : static_cast<double> (part.aside);
    points.states[point] = part.state;
    points.values[point] = static_cast<float> (vote_.valueOf (winner) - combined.thickening);
    points.border_offsets[point] = part.border_offset;
    for (std::size_t a = 0; a < 3; ++a)
      points.gradients[a][point] = part.gradient[static_cast<Eigen::Index> (a)];
  }
  settleReach (points, point, aside);
}

void
BlockFaces::settleReach (BlockPoints &points, std::uint32_t point, double aside) const
{
  const auto nearest = static_cast<double> (points.nearest_distances[point]);
  if (FaceVote::isBeyondBorder (nearest - static_cast<double> (settings_.offset),
                                static_cast<double> (points.radii[point]), aside) &&
      nearest > static_cast<double> (settings_.near_enough))
    points.in_reach[point] = 0;
}

} // namespace erkpa
