// SPDX-License-Identifier: BSD-3-Clause
#include "orientation_links.h"

#include "parallel_collect.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace erkpa
{

namespace
{

constexpr std::size_t LINKS = 12; // a node is linked to so many of its neighbours, near and far
constexpr float BLOCKED = 0.1f;   // weight of a link with another node in its way

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

} // namespace

std::vector<SignedLink>
linkNeighbors (const OrientedPoints &points, const NeighborSearch &search, const Facets &facets,
               const std::vector<int> &nodes, int threads)
{
  const int k = std::max<int> (LINKS + 1, facets.k / 2);
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
      nodes.size (), threads,
      [&] (std::size_t first, std::size_t last, std::vector<SignedLink> &links)
      {
        Query query;
        for (std::size_t i = first; i < last; ++i)
          link (query, static_cast<std::size_t> (nodes[i]), links);
      },
      STRETCH);
}

} // namespace erkpa
