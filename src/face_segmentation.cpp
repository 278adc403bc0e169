// SPDX-License-Identifier: BSD-3-Clause
#include "face_segmentation.h"

#include "mesh_graph.h"
#include "nodes_apart.h"
#include "parallel_collect.h"
#include "smooth_links.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief A link and what it costs to grow a face along it. */
struct Growth
{
  float cost;
  int from, to;

  bool
  operator<(const Growth &other) const
  {
    return std::tie (cost, from, to) < std::tie (other.cost, other.from, other.to);
  }
};

/** \brief All links once: the turn between the normals, by its chord, and a little for the way. */
std::vector<Growth>
listGrowths (const OrientedPoints &points, const SegmentationOptions &options, const NodeLinks &links, int threads)
{
  constexpr double PER_SPACING = 0.05; // radians that weigh as much as a spacing
  constexpr std::size_t STRETCH = 512;
  const auto list = [&] (std::size_t first, std::size_t last, std::vector<Growth> &growths)
  {
    std::size_t count = 0;
    for (std::size_t i = first; i < last; ++i)
      count += links[i].size ();
    growths.reserve (count);
    for (std::size_t i = first; i < last; ++i)
      for (const int j : links[i])
      {
        const int node = static_cast<int> (i);
        if (j < node)
          continue;
        const double turn = (normalOf (points, node) - normalOf (points, j)).norm ();
        const double way = (positionOf (points, j) - positionOf (points, node)).norm () / options.spacing;
        growths.push_back ({static_cast<float> (turn + PER_SPACING * way), node, j});
      }
  };
  return parallelCollect<Growth> (points.size (), threads, list, STRETCH);
}

/** \brief Grows faces along the links, the smoothest first, without ever joining nodes that are apart. */
class FaceGrower
{
public:
  /** \param[in] nodes number of them
   * \param[in] apart of each node those that must not be on its face
   */
  FaceGrower (std::size_t nodes, NodeLists apart) : sets_ (nodes), apart_ (std::move (apart)) {}

  /** \brief The faces' representatives, per node.
   *
   * Cheap links make most of the faces: the others are taken up in bands of cost, and those within a face need no
   * order (Filter-Kruskal, Osipov, Sanders, Singler 2009).
   */
  DisjointSets &
  grow (const std::vector<Growth> &growths)
  {
    constexpr std::size_t BANDS = 32;
    float most = 1e-12f;
    for (const Growth &growth : growths)
      most = std::max (most, growth.cost);
    const auto band_of = [most] (const Growth &growth)
    { return std::min (BANDS - 1, static_cast<std::size_t> (growth.cost / most * BANDS)); };
    std::array<std::size_t, BANDS> sizes{};
    for (const Growth &growth : growths)
      ++sizes[band_of (growth)];
    std::array<std::vector<Growth>, BANDS> bands;
    for (std::size_t b = 0; b < BANDS; ++b)
      bands[b].reserve (sizes[b]);
    for (const Growth &growth : growths)
      bands[band_of (growth)].push_back (growth);
    for (std::vector<Growth> &band : bands)
    {
      band.erase (std::remove_if (band.begin (), band.end (),
                                  [this] (const Growth &growth)
                                  { return sets_.find (growth.from) == sets_.find (growth.to); }),
                  band.end ());
      std::sort (band.begin (), band.end ());
      for (const Growth &growth : band)
        grow (growth);
    }
    return sets_;
  }

private:
  void
  grow (const Growth &growth)
  {
    const int a = sets_.find (growth.from), b = sets_.find (growth.to);
    if (a == b || refused_.count ({std::min (a, b), std::max (a, b)}) > 0)
      return;
    if (areApart (a, b))
      refused_.emplace (std::min (a, b), std::max (a, b));
    else
      join (a, b);
  }

  bool
  areApart (int a, int b)
  {
    if (apart_[static_cast<std::size_t> (b)].size () < apart_[static_cast<std::size_t> (a)].size ())
      std::swap (a, b);
    const auto &nodes = apart_[static_cast<std::size_t> (a)];
    return std::any_of (nodes.begin (), nodes.end (), [&] (int node) { return sets_.find (node) == b; });
  }

  void
  join (int a, int b)
  {
    sets_.unite (a, b);
    const auto root = static_cast<std::size_t> (sets_.find (a));
    auto &kept = apart_[root],
         &other =
             apart_[root == static_cast<std::size_t> (a) ? static_cast<std::size_t> (b) : static_cast<std::size_t> (a)];
    if (kept.size () < other.size ())
      kept.swap (other);
    kept.insert (kept.end (), other.begin (), other.end ());
    other = {};
  }

  DisjointSets sets_;
  NodeLists apart_; // of each set
  std::set<std::pair<int, int>> refused_;
};

/** \brief Where the tangent planes of two nodes meet, nearest to the middle between them. */
Separation
separationOf (const OrientedPoints &points, int i, int j)
{
  const Eigen::Vector3d p = positionOf (points, i), q = positionOf (points, j), middle = 0.5 * (p + q);
  const Eigen::Vector3d n = normalOf (points, i), m = normalOf (points, j), line = n.cross (m);
  Separation separation{middle.cast<float> (), 0, 0, false};
  constexpr double PARALLEL = 0.2; // sine of the angle
  if (line.norm () < PARALLEL)
    return separation;
  Eigen::Matrix3d system;
  system << n.transpose (), m.transpose (), line.transpose ();
  const Eigen::Vector3d place = system.inverse () * Eigen::Vector3d (n.dot (p), m.dot (q), line.dot (middle));
  if ((place - middle).norm () > (q - p).norm ())
    return separation;
  separation.position = place.cast<float> ();
  separation.is_crease = true;
  return separation;
}

} // namespace

FaceSegmentation
segmentFaces (const OrientedPoints &points, const NeighborSearch &search, const SegmentationOptions &options,
              int threads)
{
  std::vector<char> is_suspect;
  const NodeLinks links = linkNeighbors (points, search, options, threads, is_suspect);
  const NodeLists apart = findNodesApart (points, search, options, links, is_suspect, threads);
  FaceGrower grower (points.size (), apart);
  DisjointSets &sets = grower.grow (listGrowths (points, options, links, threads));

  FaceSegmentation result;
  const auto n = static_cast<int> (points.size ());
  std::vector<int> sizes (points.size (), 0), numbers (points.size (), -1);
  for (int i = 0; i < n; ++i)
    ++sizes[static_cast<std::size_t> (sets.find (i))];
  for (int i = 0; i < n; ++i)
  {
    const auto root = static_cast<std::size_t> (sets.find (i));
    if (numbers[root] < 0 && sizes[root] >= options.smallest)
      numbers[root] = result.count++;
    result.faces.push_back (numbers[root]);
  }
  const auto list_separations = [&] (std::size_t first, std::size_t last, std::vector<Separation> &separations)
  {
    for (std::size_t i = first; i < last; ++i)
      for (const int j : apart[i])
      {
        const int node = static_cast<int> (i), face = result.faces[i],
                  other = result.faces[static_cast<std::size_t> (j)];
        if (node > j || face < 0 || other < 0)
          continue;
        separations.push_back (separationOf (points, node, j));
        separations.back ().face = std::min (face, other);
        separations.back ().other = std::max (face, other);
      }
  };
  constexpr std::size_t STRETCH = 512;
  result.separations = parallelCollect<Separation> (points.size (), threads, list_separations, STRETCH);
  return result;
}

} // namespace erkpa
