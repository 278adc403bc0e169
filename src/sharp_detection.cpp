// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/face_of_points.h>
#include <erkpa/sharp_detection.h>

#include "face_segmentation.h"
#include "found_nodes.h"
#include "mesh_graph.h"
#include "nearby_nodes.h"
#include "node_table.h"
#include "noise.h"
#include "normal_smoothing.h"
#include "point_grid.h"
#include "separation_chains.h"
#include "text.h"
#include "threads.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace erkpa
{

namespace
{

constexpr double DEGREES = M_PI / 180.0;

/** \brief What noise asks for: the larger it is, the more nodes it takes to tell faces apart. */
SegmentationOptions
optionsFor (const OrientedPoints &points, const PointLayout &layout, double angle, int threads)
{
  SegmentationOptions options;
  const int k = layout.k;
  options.spacing = layout.spacing;
  options.angle = angle * DEGREES;
  options.separation_reach = options.spacing * std::sqrt (k / M_PI);
  if (k <= CLEAN_SUPPORT)
    return options;
  constexpr double SIGMAS = 3.0, NODES_PER_SUPPORT = 2.7;
  options.chord =
      std::min (SIGMAS * positionNoise (*layout.search, options.spacing, threads, points), 1.2 * options.spacing);
  options.ball = static_cast<int> (NODES_PER_SUPPORT * k);
  options.smallest = 8;
  options.fewest = CLEAN_SUPPORT; // fewer cannot average the noise of their normals out
  return options;
}

/** \brief The faces as sharp surfaces know them; null for those of too few nodes. */
std::vector<SharpSurface::ConstPtr>
makeFaces (const OrientedPoints &points, const FaceSegmentation &found, const std::vector<char> &is_near, int k)
{
  std::vector<std::vector<Eigen::Vector3f>> positions (static_cast<std::size_t> (found.count)), normals = positions;
  for (std::size_t i = 0; i < points.size (); ++i)
    if (found.faces[i] >= 0 && is_near[i])
    {
      positions[static_cast<std::size_t> (found.faces[i])].push_back (points.positions[i]);
      normals[static_cast<std::size_t> (found.faces[i])].push_back (points.normals[i]);
    }
  std::vector<SharpSurface::ConstPtr> faces;
  for (std::size_t f = 0; f < positions.size (); ++f)
    faces.push_back (makeFaceOfPoints (std::move (positions[f]), std::move (normals[f]), points.origin, k));
  return faces;
}

/** \brief One stretch along which two faces meet. */
struct Stretch
{
  int face, other;
  std::vector<Eigen::Vector3d> places; // in the frame of the cloud
  double reach = 0.0;
};

/** \brief Tells sharp edges from tight folds of a smooth surface.
 *
 * At an edge the normals of a face are those they were a little further off; in a fold they turn towards the other face
 * already.
 */
class FoldTest
{
public:
  FoldTest (const OrientedPoints &points, const NeighborSearch &search, const std::vector<int> &faces, double spacing)
      : points_ (points), search_ (search), faces_ (faces), spacing_ (spacing)
  {
  }

  bool
  isFold (const Stretch &stretch)
  {
    constexpr double MOST = 0.22; // share of the turn between the faces, by which each turns near the edge
    double turns = 0.0, of = 0.0;
    for (const Eigen::Vector3d &place : stretch.places)
      visit ((place - points_.origin).cast<float> (), stretch, turns, of);
    return turns > MOST * of;
  }

private:
  void
  visit (const Eigen::Vector3f &place, const Stretch &stretch, double &turns, double &of)
  {
    constexpr double NEAR = 1.5, FAR = 3.0; // spacings
    search_.withinRadius (place, FAR * spacing_, found_.nodes, found_.squared);
    std::array<Eigen::Vector3f, 2> normals{Eigen::Vector3f::Zero (), Eigen::Vector3f::Zero ()};
    const auto side_of = [&] (std::size_t i)
    {
      const int face = faces_[static_cast<std::size_t> (found_.nodes[i])];
      return face == stretch.face ? 0 : face == stretch.other ? 1 : -1;
    };
    const auto normal = [&] (std::size_t i) { return points_.normals[static_cast<std::size_t> (found_.nodes[i])]; };
    const auto is_near = [&] (std::size_t i) { return found_.squared[i] < NEAR * NEAR * spacing_ * spacing_; };
    for (std::size_t i = 0; i < found_.nodes.size (); ++i)
      if (side_of (i) >= 0 && !is_near (i))
        normals[static_cast<std::size_t> (side_of (i))] += normal (i);
    if (normals[0].isZero () || normals[1].isZero ())
      return;
    const double turn = angleBetween (normals[0], normals[1]);
    for (std::size_t i = 0; i < found_.nodes.size (); ++i)
      if (side_of (i) >= 0 && is_near (i))
      {
        turns += angleBetween (normal (i), normals[static_cast<std::size_t> (side_of (i))]);
        of += turn;
      }
  }

  static double
  angleBetween (const Eigen::Vector3f &a, const Eigen::Vector3f &b)
  {
    return std::atan2 (a.cross (b).norm (), a.dot (b));
  }

  const OrientedPoints &points_;
  const NeighborSearch &search_;
  const std::vector<int> &faces_;
  double spacing_;
  FoundNodes found_;
};

std::vector<Stretch>
withoutFolds (std::vector<Stretch> stretches, const FoldTest &test, int threads)
{
  std::vector<char> are_folds (stretches.size ());
  parallelFor (
      stretches.size (), threads, [&test] { return test; },
      [&] (FoldTest &worker, std::size_t i) { are_folds[i] = worker.isFold (stretches[i]) ? 1 : 0; });
  std::vector<Stretch> kept;
  for (std::size_t i = 0; i < stretches.size (); ++i)
    if (!are_folds[i])
      kept.push_back (std::move (stretches[i]));
  return kept;
}

/** \brief How far the k-th node is from each separation. */
std::vector<double>
radiiAt (const std::vector<Separation> &separations, const NeighborSearch &search, int k, int threads)
{
  std::vector<double> radii (separations.size ());
  parallelFor (
      separations.size (), threads, [] { return FoundNodes (); },
      [&] (FoundNodes &found, std::size_t i)
      {
        search.nearestK (separations[i].position, k, found.nodes, found.squared);
        radii[i] = std::sqrt (static_cast<double> (*std::max_element (found.squared.begin (), found.squared.end ())));
      });
  return radii;
}

/** \brief Gathers separations into stretches; those too short to be an edge and folds are dropped. */
std::vector<Stretch>
gatherStretches (const OrientedPoints &points, const NeighborSearch &search, const FaceSegmentation &found,
                 const SegmentationOptions &options, int k, int threads)
{
  constexpr double STEP = 0.5, REACH = 1.1; // spacings; support radii
  const double shortest = (k > CLEAN_SUPPORT ? 4.0 : 2.0) * options.spacing;
  const std::vector<Separation> separations = thinOut (found.separations, STEP * options.spacing);
  DisjointSets chains = chainSeparations (separations, options.link_reach * options.spacing);
  const std::map<int, float> lengths = lengthsOf (separations, chains);
  std::map<int, std::size_t> numbers;
  const std::vector<double> radii = radiiAt (separations, search, k, threads);
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < separations.size (); ++i)
  {
    const int chain = chains.find (static_cast<int> (i));
    if (lengths.at (chain) < shortest)
      continue;
    const auto [number, is_new] = numbers.try_emplace (chain, stretches.size ());
    if (is_new)
      stretches.push_back ({separations[i].face, separations[i].other, {}, 0.0});
    Stretch &stretch = stretches[number->second];
    stretch.places.emplace_back (separations[i].position.cast<double> () + points.origin);
    stretch.reach = std::max (stretch.reach, REACH * radii[i]);
  }
  return withoutFolds (std::move (stretches), FoldTest (points, search, found.faces, options.spacing), threads);
}

/** \brief Marks the nodes that fits near the stretches can reach: the others need no face. */
std::vector<char>
markNear (const OrientedPoints &points, const PointGrid &nodes, const std::vector<Stretch> &stretches, int threads)
{
  constexpr double FITS = 3.5; // in reaches, which are about a support radius each
  std::vector<Eigen::Vector3f> places;
  double reach = 0.0;
  for (const Stretch &stretch : stretches)
  {
    reach = std::max (reach, FITS * stretch.reach);
    for (const Eigen::Vector3d &place : stretch.places)
      places.emplace_back ((place - points.origin).cast<float> ());
  }
  std::vector<char> is_near (points.size (), 0);
  if (places.empty ())
    return is_near;
  const PointGrid grid (places, reach, threads);
  const NearbyNodes near (points, nodes);
  const auto mark = [&] (std::size_t first, std::size_t last)
  {
    Eigen::Vector3d center;
    double radius = 0.0;
    near.findBall (first, last, center, radius);
    // Most runs are near as a whole, or not at all.
    const bool some_may_be = grid.hasWithin (center, reach + radius);
    const bool all_are = some_may_be && radius < reach && grid.hasWithin (center, reach - radius);
    for (std::size_t place = first; place < last; ++place)
    {
      const auto node = static_cast<std::size_t> (near.nodeAt (place));
      const auto is_it = [&] { return all_are || grid.hasWithin (points.positions[node].cast<double> (), reach); };
      is_near[node] = some_may_be && is_it () ? 1 : 0;
    }
  };
  parallelRanges (points.size (), threads,
                  [&] (std::size_t first, std::size_t last) { near.visitRuns (first, last, mark); });
  return is_near;
}

} // namespace

Outcome
findSharpSurfaces (const OrientedPoints &points, const PointLayout &layout, const SharpOptions &options, int threads,
                   std::vector<SharpSurface::ConstPtr> &surfaces)
{
  surfaces.clear ();
  if (!(options.angle >= 5.0 && options.angle <= 90.0))
    return {Status::INVALID_SETTING,
            "the angle of sharp edges is " + toText (options.angle) + " degrees: use one of 5 to 90"};
  const NeighborSearch &search = *layout.search;
  const int k = layout.k;
  const SegmentationOptions segmentation = optionsFor (points, layout, options.angle, threads);
  const FaceSegmentation found = segmentFaces (points, layout, segmentation, threads);
  const std::vector<Stretch> stretches = gatherStretches (points, search, found, segmentation, k, threads);
  const std::vector<SharpSurface::ConstPtr> faces =
      makeFaces (points, found, markNear (points, *layout.grid, stretches, threads), k);
  for (const Stretch &stretch : stretches)
  {
    const auto &face = faces[static_cast<std::size_t> (stretch.face)];
    const auto &other = faces[static_cast<std::size_t> (stretch.other)];
    Extent::ConstPtr extent;
    if (face && other && makePointsExtent (stretch.places, stretch.reach, extent).ok ())
      surfaces.push_back (makeLimited (makeSharpBetween (face, other), extent));
  }
  return {};
}

} // namespace erkpa
