// SPDX-License-Identifier: BSD-3-Clause
#include "block_faces.h"

#include "lane_settings.h"

#include "support_size.h"

#include <algorithm>
#include <cmath>

namespace erkpa
{

BlockFaces::BlockFaces (const ImplicitField &field, const lanes::Engine &engine, const lanes::Settings &settings,
                        double unit)
    : engine_ (engine), settings_ (settings), unit_ (unit), parts_ (field, engine, settings, unit)
{
}

bool
BlockFaces::canEvaluate (const ImplicitField &field)
{
  const FieldOptions &options = field.options ();
  return options.order != Order::CONSTANT && options.flatten >= 1.0;
}

void
BlockFaces::combine (const lanes::Settings &settings, const lanes::Nodes &nodes,
                     const std::vector<std::uint32_t> &which, BlockPoints &points)
{
  settings_ = settings;
  if (!parts_.start (settings, which, points))
    for (const std::uint32_t point : which)
      points.states[point] = lanes::State::UNSETTLED;
  combined_.assign (which.size (), Combined ());
  listed_ = 0;
  for (std::size_t i = 0; i < which.size (); ++i)
    if (points.states[which[i]] == lanes::State::DEFINED && !isClearOfSurface (nodes, points, which[i]))
      askForParts (points, which[i], combined_[i]);
  parts_.fit (points);
  for (std::size_t i = 0; i < which.size (); ++i)
    vote (points, which[i], combined_[i]);
}

/** \brief The nodes that have a say at x, as voters whose weights are squared distances yet. */
void
BlockFaces::listNear (const Eigen::Vector3f &x, float radius)
{
  const std::size_t room = parts_.nearNodes () + lanes::MAX_WIDTH;
  makeRoom (listed_ + room, weights_);
  lanes::Copies copies{nullptr, {}, weights_.data () + listed_};
  for (std::size_t a = 0; a < 3; ++a)
  {
    makeRoom (listed_ + room, voters_[a]);
    copies.columns[a] = voters_[a].data () + listed_;
  }
  parts_.listNear (x, radius, copies);
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
BlockFaces::holdsOneFace (float radius) const
{
  const float close = static_cast<float> (FaceGroups::CLOSE) * radius;
  const std::vector<int> &near = parts_.near ();
  int face = -1;
  for (std::size_t n = 0; n < near.size (); ++n)
  {
    if (!(weights_[listed_ + n] <= close * close))
      continue;
    if (near[n] < 0 || (face >= 0 && near[n] != face))
      return false;
    face = near[n];
  }
  return face >= 0;
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
  if (!parts_.select (x))
    return;
  combined.groups = std::min (groups ().count (), FaceTree::MAX_FACES);
  for (int group = 0; group < combined.groups; ++group)
    parts_.ask (point, group);
  weighVoters (radius, combined);
}

/** \brief Those that are of a point's groups have a vote; the last vector of them is filled up. */
void
BlockFaces::weighVoters (float radius, Combined &combined)
{
  const float fall = 1.0f / radius / static_cast<float> (FaceGroups::REACH);
  float *const weights = weights_.data () + listed_;
  const std::vector<int> &near = parts_.near ();
  const std::size_t count = near.size ();
  Eigen::Map<Eigen::ArrayXf> all (weights, static_cast<Eigen::Index> (count));
  all = (1.0f - all.sqrt () * fall).max (0.0f);
  shares_.assign (groups ().present () + 1, 0.0f); // nodes of no face have none
  for (std::size_t place = 0; place < groups ().present (); ++place)
  {
    const int group = groups ().groupOfPlace (place);
    shares_[place + 1] = group >= 0 && group < combined.groups ? 1.0f : 0.0f;
  }
  for (std::size_t n = 0; n < count; ++n)
    weights[n] *= shares_[static_cast<std::size_t> (near[n]) + 1];
  listed_ += count;
  combined.last_voter = listed_;
  for (const auto array : {&voters_[0], &voters_[1], &voters_[2], &weights_})
    std::fill_n (array->begin () + static_cast<std::ptrdiff_t> (listed_), lanes::MAX_WIDTH, 0.0f);
  listed_ += lanes::MAX_WIDTH;
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
    const BlockParts::Part &part = partOf (combined, vote_.groupOf (face));
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
    const BlockParts::Part &part = partOf (combined, group);
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
    const BlockParts::Part &part = partOf (combined, vote_.groupOf (winner));
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

bool
BlockFaces::sampleSides (const lanes::Settings &settings, const std::vector<std::uint32_t> &which,
                         const BlockPoints &points, const std::vector<Question> &questions,
                         std::vector<BlockParts::Part> &answers)
{
  answers.assign (questions.size (), BlockParts::Part ());
  if (!parts_.start (settings, which, points))
    return false;
  listed_ = 0;
  std::vector<std::size_t> asked;
  bool has_groups = false;
  for (std::size_t i = 0; i < questions.size (); ++i)
  {
    const std::uint32_t point = questions[i].point;
    if (i == 0 || point != questions[i - 1].point)
    {
      listNear (points.position (point), points.radii[point]);
      has_groups = parts_.select (points.position (point));
    }
    if (!has_groups)
      continue;
    answers[i].faces = ~std::uint64_t (0); // not all nodes alike
    answers[i].state = lanes::State::UNDEFINED;
    const int group = groups ().groupOf (questions[i].face);
    if (group < 0)
      continue;
    parts_.ask (point, group);
    asked.push_back (i);
  }
  parts_.fit (points);
  for (std::size_t n = 0; n < asked.size (); ++n)
    answers[asked[n]] = parts_.part (n);
  return true;
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
