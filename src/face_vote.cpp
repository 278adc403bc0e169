// SPDX-License-Identifier: BSD-3-Clause
#include "face_vote.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace erkpa
{

void
FaceVote::start (double radius)
{
  radius_ = radius;
  voters_.clear ();
  groups_.clear ();
  values_.clear ();
  slopes_.clear ();
  distances_.clear ();
  heights_.clear ();
}

void
FaceVote::addFace (int group, double value, const Eigen::Vector3d &slope, double distance,
                   const std::vector<double> &heights)
{
  distances_.push_back (distance);
  groups_.push_back (group);
  values_.push_back (value);
  slopes_.push_back (slope);
  heights_.insert (heights_.end (), heights.begin (), heights.end ());
}

void
FaceVote::dropFarFaces ()
{
  constexpr double FAR = 1.35; // ε
  const double limit = FAR * radius_;
  if (std::all_of (distances_.begin (), distances_.end (), [limit] (double distance) { return distance > limit; }))
    return;
  std::size_t kept = 0;
  const std::size_t voters = voters_.size ();
  for (std::size_t f = 0; f < groups_.size (); ++f)
  {
    if (distances_[f] > limit)
      continue;
    groups_[kept] = groups_[f];
    values_[kept] = values_[f];
    slopes_[kept] = slopes_[f];
    distances_[kept] = distances_[f];
    std::copy_n (heights_.data () + f * voters, voters, heights_.data () + kept * voters);
    ++kept;
  }
  groups_.resize (kept);
  values_.resize (kept);
  slopes_.resize (kept);
  distances_.resize (kept);
  heights_.resize (kept * voters);
}

const FaceTree &
FaceVote::electTree () const
{
  const std::size_t faces = groups_.size (), voters = voters_.size ();
  const std::vector<FaceTree> &trees = treesOf (static_cast<int> (faces));
  if (trees.size () == 1)
    return trees.front ();
  // Voters that see the faces in the same order agree which one counts: they vote together.
  using OfFaces = std::array<double, FaceTree::MAX_FACES>;
  std::array<OfFaces, FaceTree::MAX_ORDERS> sums; // as many as there are orders
  const std::size_t orders = faces == 2 ? 2 : faces == 3 ? 6 : FaceTree::MAX_ORDERS;
  std::fill_n (sums.begin (), orders, OfFaces{});
  OfFaces heights{};
  for (std::size_t i = 0; i < voters; ++i)
  {
    for (std::size_t f = 0; f < faces; ++f)
      heights[f] = heights_[f * voters + i];
    OfFaces &sum = sums[FaceTree::orderOf (heights.data (), static_cast<int> (faces))];
    for (std::size_t f = 0; f < faces; ++f)
      sum[f] += voters_[i].weight * std::abs (heights[f]);
  }
  const auto distance = [&] (const FaceTree &tree)
  {
    double sum = 0.0;
    for (std::size_t order = 0; order < orders; ++order)
      sum += sums[order][tree.winners[order]];
    return sum;
  };
  return *std::min_element (trees.begin (), trees.end (),
                            [&] (const FaceTree &a, const FaceTree &b) { return distance (a) < distance (b); });
}

bool
FaceVote::thicknessBetween (const FaceTree &tree, std::size_t face, std::size_t other, double &thickness) const
{
  constexpr double OPPOSITE = -0.7; // cosine
  const double cosine = slopes_[face].dot (slopes_[other]);
  if (other == face || cosine > OPPOSITE * slopes_[face].norm () * slopes_[other].norm ())
    return false;
  const double side = tree.takesLarger (static_cast<int> (face), static_cast<int> (other)) ? -1.0 : 1.0;
  thickness = side * (values_[face] + values_[other]);
  return true;
}

double
FaceVote::thickening (const FaceTree &tree, double least_wall) const
{
  constexpr double FADE = 8.0;
  const std::size_t winner = winnerOf (tree);
  double most = 0.0, thickness = 0.0;
  for (std::size_t other = 0; other < groups_.size () && least_wall > 0.0; ++other)
  {
    if (!thicknessBetween (tree, winner, other, thickness))
      continue;
    const double side = tree.takesLarger (static_cast<int> (winner), static_cast<int> (other)) ? -1.0 : 1.0;
    const double half = 0.5 * least_wall + (thickness > 0.0 ? -0.5 : FADE) * thickness;
    if (half > std::abs (most))
      most = -side * half;
  }
  return most;
}

bool
FaceVote::isInThinWall (const FaceTree &tree, double most) const
{
  const std::size_t winner = winnerOf (tree);
  double thickness = 0.0;
  for (std::size_t other = 0; other < groups_.size (); ++other)
    if (tree.takesLarger (static_cast<int> (winner), static_cast<int> (other)) &&
        thicknessBetween (tree, winner, other, thickness) && thickness < most)
      return true;
  return false;
}

} // namespace erkpa
