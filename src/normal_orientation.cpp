// SPDX-License-Identifier: BSD-3-Clause
#include "normal_orientation.h"

#include "one_sided.h"
#include "orientation_facets.h"
#include "orientation_graph.h"
#include "orientation_layers.h"
#include "orientation_links.h"
#include "sign_regions.h"

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

constexpr float LAYER_WEIGHT = 0.1f; // of a column's vote; that of two neighbours in a plane is 1
constexpr double OPEN = 0.35;        // share of columns with an odd number of layers: of a closed surface few miss one
constexpr double SEEN = 0.85;        // share of a piece that must agree for the view point to be believed
constexpr float ASTRAY = 0.5f;       // cosine between an estimated normal and its facet: one of a rim or thin wall

/** \brief The facets, and what the layers that they make say about the outside. */
struct Survey
{
  Facets facets;
  std::vector<LayerVotes> layers; ///< of each node
  double open = 0.0;              ///< share of columns with an odd number of layers
};

Survey
survey (const OrientedPoints &points, const NeighborSearch &search, SurfaceKind kind, int k, int threads,
        const std::vector<Eigen::Vector3f> &normals)
{
  Survey result;
  result.facets = findFacets (points, search, kind, k, threads, normals);
  result.layers = votesOfLayers (points, result.facets, threads);
  double odd = 0.0, all = 0.0;
  for (const LayerVotes &layers : result.layers)
  {
    odd += layers.odd;
    all += layers.odd + layers.even;
  }
  result.open = all > 0.0 ? odd / all : 1.0;
  return result;
}

/** \brief What the nodes say about their signs. */
struct Network
{
  std::vector<SignedLink> links;
  std::vector<int> pieces;    ///< of each node
  std::map<int, double> open; ///< of each piece: the share of columns with an odd number of layers
};

Network
connect (const OrientedPoints &points, const NeighborSearch &search, const Survey &survey, int threads)
{
  Network network;
  std::vector<int> nodes (points.size ());
  std::iota (nodes.begin (), nodes.end (), 0);
  network.links = linkNeighbors (points, search, survey.facets, nodes, threads);
  network.pieces = piecesOf (static_cast<int> (points.size ()), network.links);
  std::map<int, double> odd, all;
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    const LayerVotes &layers = survey.layers[i];
    odd[network.pieces[i]] += layers.odd;
    all[network.pieces[i]] += layers.odd + layers.even;
  }
  for (const auto &[piece, count] : all)
    network.open[piece] = count > 0.0 ? odd[piece] / count : 1.0;
  return network;
}

/** \brief What speaks for the sign of one piece; positive means that its signs are right as they are. */
struct Votes
{
  double given = 0.0;              ///< normals that came with the input
  double seen = 0.0, unseen = 0.0; ///< agreement with the view point
  double layers = 0.0;             ///< agreement with the layers of a closed surface
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
    if (std::abs (layers) > seen + unseen) // more than one column per node
      return layers > 0.0;
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

/** \brief Pieces of the cloud whose normals' signs are known relative to each other. */
struct Pieces
{
  std::vector<int> of_node;
  std::map<int, Votes> votes;
};

/** \brief Finds signs that agree within each piece.
 * \param[in,out] normals those that were not given and have nothing to do with their facet are replaced
 * \param[out] turned per node, whether its normal must be turned for that
 */
Pieces
agree (const OrientedPoints &points, const NeighborSearch &search, const Survey &known, int threads,
       std::vector<Eigen::Vector3f> &normals, std::vector<char> &turned)
{
  Network network = connect (points, search, known, threads);
  const std::size_t between_neighbors = network.links.size ();
  const auto count = static_cast<int> (points.size ());
  std::vector<int> layers (points.size (), 0);
  for (std::size_t i = 0; i < points.size (); ++i)
    if (network.open[network.pieces[i]] < OPEN)
    {
      layers[i] = known.layers[i].outwards;
      if (layers[i] != 0) // the node after the last is the outside
        network.links.push_back ({static_cast<int> (i), count, LAYER_WEIGHT * static_cast<float> (layers[i])});
    }
  std::vector<char> flips = agreeOnSigns (count + 1, network.links, between_neighbors, threads);
  turnRegions (network.links, flips);
  Pieces pieces;
  pieces.of_node = network.pieces;
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    const Eigen::Vector3f &facet = known.facets.of_node[i].normal;
    if (points.normals[i].isZero (0.0f) && std::abs (facet.dot (normals[i])) < ASTRAY)
      normals[i] = facet;
    turned[i] = (flips[i] != 0) != (facet.dot (normals[i]) < 0.0f);
    pieces.votes[pieces.of_node[i]].layers += flips[i] != 0 ? -layers[i] : layers[i];
  }
  return pieces;
}

} // namespace

Orientation
orientNormals (const OrientedPoints &points, const NeighborSearch &search, int k, const NormalOptions &options,
               std::vector<Eigen::Vector3f> &normals)
{
  OneSided one_sided (points, search, k, options);
  if (one_sided.tellsWalls (normals) && one_sided.orient (normals))
    return one_sided.orientation ();
  Survey known = survey (points, search, SurfaceKind::CLOSED, k, options.threads, normals);
  if (known.open > OPEN)
  {
    if (one_sided.orient (normals))
      return one_sided.orientation ();
    known = survey (points, search, SurfaceKind::OPEN, k, options.threads, normals);
  }
  std::vector<char> turned (points.size ());
  Pieces pieces = agree (points, search, known, options.threads, normals, turned);

  const Eigen::Vector3f view_point = (options.view_point - points.origin).cast<float> ();
  const std::array<Eigen::Vector3f, 26> ways = directions ();
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    Votes &votes = pieces.votes[pieces.of_node[i]];
    const Eigen::Vector3f normal = turned[i] ? Eigen::Vector3f (-normals[i]) : normals[i];
    castVote (votes, ways, points.positions[i], normal, view_point);
    if (!points.normals[i].isZero (0.0f))
      votes.given += turned[i] ? -1.0 : 1.0;
  }

  Orientation orientation = Orientation::VIEW_POINT;
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    if (!points.normals[i].isZero (0.0f))
      continue;
    const Votes &votes = pieces.votes[pieces.of_node[i]];
    const double agreement = std::max (votes.seen, votes.unseen) / (votes.seen + votes.unseen);
    bool flip = (turned[i] != 0) != (votes.given != 0.0 ? votes.given < 0.0 : !votes.outwards ());
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
