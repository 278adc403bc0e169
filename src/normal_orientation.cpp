// SPDX-License-Identifier: BSD-3-Clause
#include "normal_orientation.h"

#include "threads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace erkpa
{

namespace
{

constexpr std::size_t LINKS = 10; // a node is linked to so many of its neighbours, near and far
constexpr double SEEN = 0.85;     // share of a piece that must agree for the view point to be believed

/** \brief A pair of neighbours; unsureness is 0 for two points of one flat patch, and grows from there. */
struct Link
{
  float unsureness;
  int from, to;
  bool flips;

  bool
  operator<(const Link &other) const
  {
    return std::make_pair (unsureness, std::make_pair (from, to)) <
           std::make_pair (other.unsureness, std::make_pair (other.from, other.to));
  }
};

/** \brief Sets of nodes whose signs are known relative to each other. */
class SignedSets
{
public:
  explicit SignedSets (std::size_t size) : parents_ (size), flips_ (size, 0)
  {
    std::iota (parents_.begin (), parents_.end (), 0);
  }

  /** \brief The set of a node and whether the node is flipped against it. */
  std::pair<int, bool>
  find (int node)
  {
    bool flipped = false;
    int root = node;
    for (; parent (root) != root; root = parent (root))
      flipped ^= flip (root) != 0;
    bool rest = flipped;
    while (parent (node) != root && node != root) // compress the path
    {
      const int next = parent (node);
      const bool own = flip (node) != 0;
      parent (node) = root;
      flip (node) = rest ? 1 : 0;
      rest ^= own;
      node = next;
    }
    return {root, flipped};
  }

  void
  unite (const Link &link)
  {
    const auto [a, a_flipped] = find (link.from);
    const auto [b, b_flipped] = find (link.to);
    if (a == b)
      return;
    const int low = std::min (a, b), high = std::max (a, b);
    parent (high) = low;
    flip (high) = (a_flipped ^ b_flipped ^ link.flips) ? 1 : 0;
  }

private:
  int &
  parent (int i)
  {
    return parents_[static_cast<std::size_t> (i)];
  }

  char &
  flip (int i)
  {
    return flips_[static_cast<std::size_t> (i)];
  }

  std::vector<int> parents_;
  std::vector<char> flips_;
};

Link
linkBetween (const OrientedPoints &points, const std::vector<Eigen::Vector3f> &normals, int from, int to)
{
  const auto i = static_cast<std::size_t> (from), j = static_cast<std::size_t> (to);
  const Eigen::Vector3f way = (points.positions[j] - points.positions[i]).normalized ();
  const float slope = normals[i].dot (way), other_slope = normals[j].dot (way);
  const float mirrored = normals[i].dot (normals[j]) - 2.0f * slope * other_slope;
  // A pair that stands along its normals is a thin wall or two layers of a noisy scan: to be asked last.
  const float steepness = std::max (slope * slope, other_slope * other_slope);
  return {1.0f - std::abs (mirrored) + steepness, from, to, mirrored < 0.0f};
}

std::vector<Link>
linkNeighbors (const OrientedPoints &points, const NeighborSearch &search, const std::vector<Eigen::Vector3f> &normals,
               int k, int threads)
{
  struct Scratch
  {
    std::vector<int> indices;
    std::vector<float> squared;
    std::vector<std::pair<float, int>> order;
  };
  std::vector<std::vector<Link>> of_node (points.size ());
  parallelFor (
      points.size (), threads, [] { return Scratch (); },
      [&] (Scratch &scratch, std::size_t i)
      {
        search.nearestK (points.positions[i], k, scratch.indices, scratch.squared);
        scratch.order.clear ();
        for (std::size_t j = 0; j < scratch.indices.size (); ++j)
          if (scratch.indices[j] != static_cast<int> (i))
            scratch.order.emplace_back (scratch.squared[j], scratch.indices[j]);
        std::sort (scratch.order.begin (), scratch.order.end ());
        const std::size_t step = std::max<std::size_t> (1, scratch.order.size () / LINKS);
        for (std::size_t j = 0; j < scratch.order.size (); j += step)
          of_node[i].push_back (linkBetween (points, normals, static_cast<int> (i), scratch.order[j].second));
      });
  std::vector<Link> links;
  links.reserve (points.size () * LINKS);
  for (const auto &some : of_node)
    links.insert (links.end (), some.begin (), some.end ());
  std::sort (links.begin (), links.end ());
  return links;
}

/** \brief What speaks for the sign of one piece; positive means that its signs are right as they are. */
struct Votes
{
  double given = 0.0;              ///< normals that came with the input
  double seen = 0.0, unseen = 0.0; ///< agreement with the view point
  std::array<float, 26> farthest;  ///< per direction, how far out the outermost node lies
  std::array<float, 26> outward{}; ///< and how its normal looks that way
  double upward = 0.0;             ///< for a sheet, which has no outside

  Votes ()
  {
    farthest.fill (-HUGE_VALF);
  }

  bool
  outwards () const
  {
    const float sum = std::accumulate (outward.begin (), outward.end (), 0.0f);
    return std::abs (sum) > 1.0f ? sum > 0.0f : upward >= 0.0;
  }
};

std::array<Eigen::Vector3f, 26>
directions ()
{
  std::array<Eigen::Vector3f, 26> all;
  std::size_t count = 0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0)
          all[count++] = Eigen::Vector3f (float (x), float (y), float (z)).normalized ();
  return all;
}

void
castVote (Votes &votes, const std::array<Eigen::Vector3f, 26> &ways, const Eigen::Vector3f &position,
          const Eigen::Vector3f &normal, const Eigen::Vector3f &view_point)
{
  (normal.dot (view_point - position) >= 0.0f ? votes.seen : votes.unseen) += 1.0;
  votes.upward += normal.z ();
  for (std::size_t d = 0; d < ways.size (); ++d)
    if (position.dot (ways[d]) > votes.farthest[d])
    {
      votes.farthest[d] = position.dot (ways[d]);
      votes.outward[d] = normal.dot (ways[d]);
    }
}

} // namespace

Orientation
orientNormals (const OrientedPoints &points, const NeighborSearch &search, int k, const NormalOptions &options,
               std::vector<Eigen::Vector3f> &normals)
{
  SignedSets sets (points.size ());
  for (const Link &link : linkNeighbors (points, search, normals, k, options.threads))
    sets.unite (link);

  const Eigen::Vector3f view_point = (options.view_point - points.origin).cast<float> ();
  const std::array<Eigen::Vector3f, 26> ways = directions ();
  std::map<int, Votes> pieces;
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    const auto [piece, flipped] = sets.find (static_cast<int> (i));
    const Eigen::Vector3f normal = flipped ? Eigen::Vector3f (-normals[i]) : normals[i];
    castVote (pieces[piece], ways, points.positions[i], normal, view_point);
    if (!points.normals[i].isZero (0.0f))
      pieces[piece].given += flipped ? -1.0 : 1.0;
  }

  Orientation orientation = Orientation::VIEW_POINT;
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    if (!points.normals[i].isZero (0.0f))
      continue;
    const auto [piece, flipped] = sets.find (static_cast<int> (i));
    const Votes &votes = pieces[piece];
    const double agreement = std::max (votes.seen, votes.unseen) / (votes.seen + votes.unseen);
    bool flip = flipped != (votes.given != 0.0 ? votes.given < 0.0 : !votes.outwards ());
    if (votes.given == 0.0 && options.has_view_point && agreement >= SEEN)
      flip = normals[i].dot (view_point - points.positions[i]) < 0.0f;
    else
      orientation = Orientation::PROPAGATION;
    if (flip)
      normals[i] = -normals[i];
  }
  return orientation;
}

} // namespace erkpa
