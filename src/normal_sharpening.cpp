// SPDX-License-Identifier: BSD-3-Clause
#include "normal_sharpening.h"

#include "node_table.h"
#include "normal_sharpener.h"
#include "normal_smoothing.h"
#include "threads.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief Pieces of a cloud around points that are on no smooth surface. */
struct RoughPieces
{
  OrientedPoints points;
  std::vector<std::size_t> middle; ///< those of the points with all of their surroundings
};

/** \brief Some points of a cloud that are on no smooth surface; where noise looks like edges, rather those at edges. */
std::vector<std::size_t>
findRough (const NeighborSearch &search, const NormalScale &scale, int threads, const OrientedPoints &points)
{
  const std::vector<std::size_t> sample = spreadSample (points.size ());
  const NormalSharpener sharpener (search, scale, threads, points);
  std::vector<std::pair<double, std::size_t>> roughness (sample.size ());
  parallelFor (
      sample.size (), threads, [] { return Neighborhood (); },
      [&] (Neighborhood &near, std::size_t s) {
        roughness[s] = {sharpener.roughness (near, sample[s]), sample[s]};
      });
  std::sort (roughness.rbegin (), roughness.rend ());
  const auto smooth =
      std::find_if (roughness.begin (), roughness.end (), [] (const auto &r) { return r.first == 0.0; });
  std::vector<std::size_t> rough;
  for (auto r = roughness.begin (); r < roughness.begin () + (smooth - roughness.begin () + 1) / 2; ++r)
    rough.push_back (r->second);
  std::sort (rough.begin (), rough.end ());
  return rough;
}

/** \brief Whether some of the points at edges have neighbours with normals half way between faces.
 *
 * Of smeared normals most have (0.7 and more), of exact ones few: a quick answer for these.
 */
bool
areBlended (const NeighborSearch &search, const NormalScale &scale, int threads, const OrientedPoints &points,
            const std::vector<std::size_t> &rough)
{
  constexpr std::size_t ENOUGH = 300;
  constexpr int SHARE = 4;
  const std::size_t step = rough.size () / ENOUGH + 1;
  const NormalSharpener sharpener (search, scale, threads, points);
  std::atomic<int> at_edges{0}, blended{0};
  parallelFor ((rough.size () + step - 1) / step, threads, [] { return Neighborhood (); },
               [&] (Neighborhood &near, std::size_t r)
               {
                 bool is_at_edge = false;
                 blended += sharpener.isBlended (near, rough[r * step], is_at_edge) ? 1 : 0;
                 at_edges += is_at_edge ? 1 : 0;
               });
  return SHARE * blended > at_edges;
}

/** \param[in] nodes about how many */
RoughPieces
gatherPieces (const NeighborSearch &search, const OrientedPoints &points, const std::vector<std::size_t> &rough, int k,
              std::size_t nodes)
{
  constexpr std::size_t PIECES = 64; // at most
  constexpr int AROUND = 5;          // times the neighbours of a fit
  const std::size_t count = std::clamp<std::size_t> (nodes / static_cast<std::size_t> (AROUND * k), 1, PIECES);
  const std::size_t step = (rough.size () + count - 1) / count;
  std::map<int, bool> is_middle;
  std::vector<int> found;
  std::vector<float> squared;
  for (std::size_t r = 0; r < rough.size (); r += step)
  {
    search.nearestK (points.positions[rough[r]], AROUND * k, found, squared);
    for (const int node : found)
      is_middle.emplace (node, false);
    search.nearestK (points.positions[rough[r]], k, found, squared);
    for (const int node : found)
      is_middle[node] = true;
  }
  RoughPieces pieces;
  for (const auto &[node, middle] : is_middle)
  {
    if (middle)
      pieces.middle.push_back (pieces.points.size ());
    pieces.points.positions.push_back (points.positions[static_cast<std::size_t> (node)]);
    pieces.points.normals.push_back (points.normals[static_cast<std::size_t> (node)]);
  }
  return pieces;
}

/** \brief The median of how far the normals of points in pieces lean to the other faces of their edges.
 * \return false where few are at edges
 */
bool
medianLean (const RoughPieces &pieces, const NormalScale &scale, int threads, double &median)
{
  constexpr std::size_t ENOUGH = 20;
  const NeighborSearch::ConstPtr search = makeGridSearch (pieces.points.positions, threads);
  NormalSharpener sharpener (*search, scale, threads, pieces.points);
  sharpener.run ();
  std::vector<double> leans;
  Neighborhood near;
  for (const std::size_t i : pieces.middle)
  {
    bool is_known = false;
    const double lean = sharpener.leanOf (near, i, is_known);
    if (is_known)
      leans.push_back (lean);
  }
  if (leans.size () < ENOUGH)
    return false;
  const auto middle = leans.begin () + static_cast<std::ptrdiff_t> (leans.size () / 2);
  std::nth_element (leans.begin (), middle, leans.end ());
  median = *middle;
  return true;
}

} // namespace

void
sharpenNormals (const NeighborSearch &search, const NormalScale &scale, int threads, OrientedPoints &points)
{
  NormalSharpener sharpener (search, scale, threads, points);
  points.normals = sharpener.run ();
}

bool
areNormalsSmeared (const NeighborSearch &search, const NormalScale &scale, int threads, const OrientedPoints &points)
{
  constexpr std::size_t FEW = 1500, MANY = 6000;
  constexpr double CLEARLY_NOT = 0.4; // of the limit: then few nodes are enough
  // Of PCA at edges, 0.25 to 0.35 and more with noise; of exact normals 0, but 0.3 where much noise feigns edges.
  const double smeared = std::min (0.38, 0.2 + 0.6 * scale.noise / scale.spacing);
  const std::vector<std::size_t> rough = findRough (search, scale, threads, points);
  if (rough.empty () || !areBlended (search, scale, threads, points, rough))
    return false;
  double lean = 0.0;
  if (medianLean (gatherPieces (search, points, rough, scale.k, FEW), scale, threads, lean) &&
      lean < CLEARLY_NOT * smeared)
    return false;
  return medianLean (gatherPieces (search, points, rough, scale.k, MANY), scale, threads, lean) && lean > smeared;
}

} // namespace erkpa
