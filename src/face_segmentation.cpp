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
#include <numeric>
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

/** \brief The growths from a stretch of nodes, in bands of rising cost. */
struct Growths
{
  static constexpr std::size_t BANDS = 32;

  std::vector<Growth> growths;
  std::array<std::size_t, BANDS + 1> firsts{}; ///< of each band
};

/** \brief Lists the links once: the turn between the normals, by its chord, and a little for the way. */
class GrowthLister
{
public:
  GrowthLister (const OrientedPoints &points, const SegmentationOptions &options, const NodeLinks &links)
      : points_ (points), links_ (links), per_length_ (static_cast<float> (PER_SPACING / options.spacing)),
        per_cost_ (static_cast<float> (Growths::BANDS / (options.angle + PER_SPACING * options.bridge_reach)))
  {
  }

  std::vector<Growths>
  list (int threads) const
  {
    constexpr std::size_t STRETCH = 512;
    std::vector<Growths> parts ((points_.size () + STRETCH - 1) / STRETCH);
    parallelFor (
        parts.size (), threads, [] { return std::vector<Growth> (); },
        [&] (std::vector<Growth> &growths, std::size_t i)
        {
          growths.clear ();
          for (std::size_t node = i * STRETCH; node < std::min (points_.size (), (i + 1) * STRETCH); ++node)
            append (static_cast<int> (node), growths);
          sortIntoBands (growths, parts[i]);
        });
    return parts;
  }

private:
  static constexpr double PER_SPACING = 0.05; // radians that weigh as much as a spacing

  void
  append (int node, std::vector<Growth> &growths) const
  {
    for (const int j : links_[static_cast<std::size_t> (node)])
    {
      if (j < node)
        continue;
      const auto from = static_cast<std::size_t> (node), to = static_cast<std::size_t> (j);
      const float turn = (points_.normals[from] - points_.normals[to]).norm ();
      const float way = (points_.positions[to] - points_.positions[from]).norm ();
      growths.push_back ({turn + per_length_ * way, node, j});
    }
  }

  void
  sortIntoBands (const std::vector<Growth> &growths, Growths &sorted) const
  {
    const auto band_of = [this] (const Growth &growth)
    { return std::min (Growths::BANDS - 1, static_cast<std::size_t> (growth.cost * per_cost_)); };
    for (const Growth &growth : growths)
      ++sorted.firsts[band_of (growth) + 1];
    std::partial_sum (sorted.firsts.begin (), sorted.firsts.end (), sorted.firsts.begin ());
    auto places = sorted.firsts;
    sorted.growths.resize (growths.size ());
    for (const Growth &growth : growths)
      sorted.growths[places[band_of (growth)]++] = growth;
  }

  const OrientedPoints &points_;
  const NodeLinks &links_;
  float per_length_, per_cost_;
};

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
  grow (const std::vector<Growths> &parts, int threads)
  {
    constexpr std::size_t FEW = 64;
    for (std::size_t band = 0; band < Growths::BANDS; ++band)
    {
      std::vector<Growth> open = listOpen (parts, band, threads);
      std::sort (open.begin (), open.end ());
      for (const Growth &growth : open)
        grow (growth);
      if (FEW * open.size () > apart_.size ())
        for (int i = 0; i < static_cast<int> (apart_.size ()); ++i)
          sets_.find (i); // shortens the ways that listOpen () takes
    }
    return sets_;
  }

private:
  /** \brief Those of a band that do not lie within a face yet. */
  std::vector<Growth>
  listOpen (const std::vector<Growths> &parts, std::size_t band, int threads) const
  {
    constexpr std::size_t STRETCH = 8; // parts
    return parallelCollect<std::vector<Growth>> (
        parts.size (), threads,
        [&] (std::size_t first, std::size_t last, std::vector<Growth> &open)
        {
          for (std::size_t p = first; p < last; ++p)
            for (std::size_t i = parts[p].firsts[band]; i < parts[p].firsts[band + 1]; ++i)
              if (sets_.findFrom (parts[p].growths[i].from) != sets_.findFrom (parts[p].growths[i].to))
                open.push_back (parts[p].growths[i]);
        },
        STRETCH);
  }

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

Eigen::Vector3d
positionOf (const OrientedPoints &points, int node)
{
  return points.positions[static_cast<std::size_t> (node)].cast<double> ();
}

Eigen::Vector3d
normalOf (const OrientedPoints &points, int node)
{
  return points.normals[static_cast<std::size_t> (node)].cast<double> ();
}

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
segmentFaces (const OrientedPoints &points, const PointLayout &layout, const SegmentationOptions &options, int threads)
{
  std::vector<char> is_suspect;
  const NodeLinks links = linkNeighbors (points, *layout.grid, options, threads, is_suspect);
  const NodeLists apart = findNodesApart (points, *layout.search, options, links, is_suspect, threads);
  FaceGrower grower (points.size (), apart);
  DisjointSets &sets = grower.grow (GrowthLister (points, options, links).list (threads), threads);

  FaceSegmentation result;
  const auto n = static_cast<int> (points.size ());
  std::vector<int> sizes (points.size (), 0), numbers (points.size (), -1);
  for (int i = 0; i < n; ++i)
    ++sizes[static_cast<std::size_t> (sets.find (i))];
  for (int i = 0; i < n; ++i)
  {
    const auto root = static_cast<std::size_t> (sets.find (i));
    if (numbers[root] < 0 && sizes[root] >= options.fewest)
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
  result.separations = parallelCollect<std::vector<Separation>> (points.size (), threads, list_separations, STRETCH);
  return result;
}

} // namespace erkpa
