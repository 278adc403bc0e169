// SPDX-License-Identifier: BSD-3-Clause
#include "normal_orientation.h"

#include "orientation_facets.h"
#include "orientation_graph.h"
#include "orientation_layers.h"
#include "orientation_planes.h"
#include "parallel_collect.h"
#include "seen_side.h"
#include "sign_regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace erkpa
{

namespace
{

constexpr std::size_t LINKS = 12;    // a node is linked to so many of its neighbours, near and far
constexpr float BLOCKED = 0.1f;      // weight of a link with another node in its way
constexpr float LAYER_WEIGHT = 0.1f; // of a column's vote; that of two neighbours in a plane is 1
constexpr double OPEN = 0.35;        // share of columns with an odd number of layers: of a closed surface few miss one
constexpr double SEEN = 0.85;        // share of a piece that must agree for the view point to be believed
constexpr float ASTRAY = 0.5f;       // cosine between an estimated normal and its facet: one of a rim or thin wall

/** \brief What two neighbours say about their signs.
 *
 * Along a smooth piece of surface the normals agree. Where one lies off the plane of the other there is an edge or
 * another sheet between them: then both see each other below, or both above, their facets.
 * \return from -1 (opposite signs) to 1 (the same)
 */
float
agreement (const Facet &f, const Facet &g, const Eigen::Vector3f &chord, const Facets &facets)
{
  const float r = chord.norm (), reach = r / static_cast<float> (facets.spacing);
  const float deviation = std::max (f.deviation, g.deviation), bend = std::max (f.bend, g.bend);
  const float tolerance = 2.0f * deviation + (0.03f + 0.5f * bend * reach) * r;
  const float a = f.normal.dot (chord) / tolerance, b = g.normal.dot (chord) / tolerance;
  const float steepness = a * a + b * b;
  const float cosine = f.normal.dot (g.normal);
  // In a scan, parallel facets one above the other are of one noisy sheet, or both face the sensor.
  const float angled = facets.kind == SurfaceKind::CLOSED ? 1.0f : 1.0f - cosine * cosine;
  const float edge = -2.0f * a * b / (1.0f + steepness) * angled;
  const float smooth = cosine * 3.0f / (3.0f + steepness);
  const float trust = static_cast<float> (facets.tolerance) / deviation;
  return (edge + smooth) * std::exp (-0.25f * reach * reach) * trust;
}

/** \brief Scratch memory of a neighbour query. */
struct Query
{
  std::vector<int> indices;
  std::vector<float> squared;
  std::vector<std::pair<float, int>> order;
};

/** \brief Whether no neighbour lies in the ball over a pair (Gabriel): none in between that knows better. */
bool
isFree (const OrientedPoints &points, const Query &query, const Eigen::Vector3f &middle, float squared)
{
  constexpr float RADIUS = 0.2499f; // squared, of the pair's distance: its own ends are outside
  return std::none_of (query.order.begin (), query.order.end (),
                       [&] (const std::pair<float, int> &other)
                       {
                         const Eigen::Vector3f &x = points.positions[static_cast<std::size_t> (other.second)];
                         return (x - middle).squaredNorm () <= RADIUS * squared;
                       });
}

std::vector<SignedLink>
linkNeighbors (const OrientedPoints &points, const NeighborSearch &search, const Facets &facets, int k, int threads)
{
  const auto link = [&] (Query &query, std::size_t i, std::vector<SignedLink> &links)
  {
    const Eigen::Vector3f &x = points.positions[i];
    search.nearestK (x, k, query.indices, query.squared);
    query.order.clear ();
    for (std::size_t j = 0; j < query.indices.size (); ++j)
      if (query.indices[j] != static_cast<int> (i))
        query.order.emplace_back (query.squared[j], query.indices[j]);
    std::sort (query.order.begin (), query.order.end ());
    const std::size_t step = std::max<std::size_t> (1, query.order.size () / LINKS);
    for (std::size_t o = 0; o < query.order.size (); o += step)
    {
      const auto j = static_cast<std::size_t> (query.order[o].second);
      const Eigen::Vector3f &y = points.positions[j];
      const float weight = agreement (facets.of_node[i], facets.of_node[j], y - x, facets);
      const bool free = isFree (points, query, 0.5f * (x + y), query.order[o].first);
      links.push_back ({static_cast<int> (i), query.order[o].second, free ? weight : BLOCKED * weight});
    }
  };
  constexpr std::size_t STRETCH = 512;
  return parallelCollect<std::vector<SignedLink>> (
      points.size (), threads,
      [&] (std::size_t first, std::size_t last, std::vector<SignedLink> &links)
      {
        Query query;
        for (std::size_t i = first; i < last; ++i)
          link (query, i, links);
      },
      STRETCH);
}

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
  const int neighbors = std::max<int> (LINKS + 1, survey.facets.k / 2);
  network.links = linkNeighbors (points, search, survey.facets, neighbors, threads);
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
  turnRegions (network.links, between_neighbors, flips);
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

/** \brief Have all normals that were not given look at a viewer, or away from one whom most given ones look away from.
 * \return false where given normals say that the viewer has not seen the surface
 */
bool
faceViewer (const OrientedPoints &points, const Viewer &viewer, std::vector<Eigen::Vector3f> &normals)
{
  double given = 0.0, facing = 0.0;
  const auto isFacing = [&] (std::size_t i) { return normals[i].dot (viewer.from (points.positions[i])) >= 0.0f; };
  for (std::size_t i = 0; i < points.size (); ++i)
    if (!points.normals[i].isZero (0.0f))
    {
      given += 1.0;
      facing += isFacing (i) ? 1.0 : 0.0;
    }
  const bool is_other_side = viewer.is_far && facing < (1.0 - SEEN) * given;
  if (!is_other_side && facing < SEEN * given)
    return false;
  for (std::size_t i = 0; i < points.size (); ++i)
    if (points.normals[i].isZero (0.0f) && isFacing (i) == is_other_side)
      normals[i] = -normals[i];
  return true;
}

/** \brief Have the normals look to the side that a scan is seen from, if there is one.
 * \return false, and all is as before, where there is none
 */
bool
orientToOneSide (const OrientedPoints &points, const Facets &facets, const NormalOptions &options,
                 std::vector<Eigen::Vector3f> &normals, Orientation &orientation)
{
  std::optional<Eigen::Vector3f> view_point;
  if (options.has_view_point)
    view_point = (options.view_point - points.origin).cast<float> ();
  const auto viewer = findViewer (points, facets, view_point, Eigen::Vector3f (-points.origin.cast<float> ()));
  if (!viewer || !faceViewer (points, *viewer, normals))
    return false;
  orientation = options.has_view_point && !viewer->is_far ? Orientation::VIEW_POINT : Orientation::ONE_SIDE;
  return true;
}

/** \brief Whether the two sides of a wall would not be taken for one noisy sheet. */
bool
tellsWalls (const OrientedPoints &points, const NeighborSearch &search, const Facets &of_scan, int threads)
{
  constexpr double ALIKE = 0.7; // noise of single sheets, beside that of all neighbours
  constexpr double CLEAN = 0.1; // spacings
  return of_scan.tolerance < CLEAN * of_scan.spacing ||
         noiseOfSheets (points, search, of_scan.spacing, threads) > ALIKE * of_scan.tolerance;
}

} // namespace

Orientation
orientNormals (const OrientedPoints &points, const NeighborSearch &search, int k, const NormalOptions &options,
               std::vector<Eigen::Vector3f> &normals)
{
  Orientation orientation = Orientation::VIEW_POINT;
  const Facets of_scan = facetsOfNormals (points, search, SurfaceKind::OPEN, k, options.threads, normals);
  const bool tells_walls = tellsWalls (points, search, of_scan, options.threads);
  if (tells_walls && orientToOneSide (points, of_scan, options, normals, orientation))
    return orientation;
  Survey known = survey (points, search, SurfaceKind::CLOSED, k, options.threads, normals);
  if (known.open > OPEN)
  {
    if (!tells_walls && orientToOneSide (points, of_scan, options, normals, orientation))
      return orientation;
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

  orientation = Orientation::VIEW_POINT;
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
