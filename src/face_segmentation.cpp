// SPDX-License-Identifier: BSD-3-Clause
#include "face_segmentation.h"

#include "mesh_graph.h"
#include "threads.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

namespace erkpa
{

namespace
{

using NodeLists = std::vector<std::vector<int>>; // per node, sorted

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

double
angleBetween (const Eigen::Vector3d &a, const Eigen::Vector3d &b)
{
  return std::atan2 (a.cross (b).norm (), a.dot (b));
}

/** \brief Whether two nodes fit to one smooth surface: similar normals, and across them no step.
 * \param[in] bend how large a step may be as a share of the distance; that of a circular arc is zero
 */
bool
areSmooth (const OrientedPoints &points, const SegmentationOptions &options, int i, int j, double angle, double bend)
{
  const Eigen::Vector3d n = normalOf (points, i), m = normalOf (points, j);
  if (n.dot (m) < std::cos (angle))
    return false;
  const Eigen::Vector3d way = positionOf (points, j) - positionOf (points, i);
  return 0.5 * std::abs (way.dot (n + m)) <= std::max (bend * way.norm (), options.chord);
}

bool
areSmooth (const OrientedPoints &points, const SegmentationOptions &options, int i, int j)
{
  return areSmooth (points, options, i, j, options.angle, 0.2);
}

/** \brief Whether to link two nodes. Those farther apart must agree better: they bridge gaps in narrow faces. */
bool
areLinked (const OrientedPoints &points, const SegmentationOptions &options, int i, int j)
{
  constexpr double BRIDGE_ANGLE = 0.7, BRIDGE_BEND = 0.08;
  const double distance = (positionOf (points, j) - positionOf (points, i)).norm ();
  const bool is_near = distance <= options.link_reach * options.spacing;
  return is_near ? areSmooth (points, options, i, j)
                 : areSmooth (points, options, i, j, BRIDGE_ANGLE * options.angle, BRIDGE_BEND);
}

/** \brief Links every node with the neighbours it is smooth with, and tells which nodes have others, too. */
NodeLists
linkNeighbors (const OrientedPoints &points, const NeighborSearch &search, const SegmentationOptions &options,
               int threads, std::vector<char> &is_suspect)
{
  NodeLists links (points.size ());
  is_suspect.assign (points.size (), 0);
  struct Found
  {
    std::vector<int> nodes;
    std::vector<float> squared;
  };
  const double reach = options.bridge_reach * options.spacing;
  const double far = std::max (reach, options.separation_reach);
  parallelFor (
      points.size (), threads, [] { return Found (); },
      [&] (Found &found, std::size_t i)
      {
        search.withinRadius (points.positions[i], far, found.nodes, found.squared);
        std::sort (found.nodes.begin (), found.nodes.end ());
        for (const int j : found.nodes)
        {
          const int node = static_cast<int> (i);
          if (j == node)
            continue;
          const double distance = (positionOf (points, j) - positionOf (points, node)).norm ();
          if (distance <= reach && areLinked (points, options, node, j))
            links[i].push_back (j);
          else if (distance <= std::max (options.separation_reach, options.link_reach * options.spacing))
            is_suspect[i] = 1;
        }
      });
  return links;
}

/** \brief Finds the groups of linked nodes in the ball around a node, and the nodes that are apart from it. */
class LocalGroups
{
public:
  LocalGroups (const OrientedPoints &points, const NeighborSearch &search, const SegmentationOptions &options,
               const NodeLists &links)
      : points_ (points), search_ (search), options_ (options), links_ (links), slots_ (points.size (), -1)
  {
  }

  /** \brief The nodes near \a node on other faces, sorted; empty where the node's own group is too small. */
  std::vector<int>
  nodesApartFrom (int node)
  {
    const auto i = static_cast<std::size_t> (node);
    search_.nearestK (points_.positions[i], options_.ball, ball_, squared_);
    for (std::size_t slot = 0; slot < ball_.size (); ++slot)
      slots_[static_cast<std::size_t> (ball_[slot])] = static_cast<int> (slot);
    DisjointSets groups (ball_.size ());
    for (std::size_t slot = 0; slot < ball_.size (); ++slot)
      for (const int j : links_[static_cast<std::size_t> (ball_[slot])])
        if (slots_[static_cast<std::size_t> (j)] > static_cast<int> (slot))
          groups.unite (static_cast<int> (slot), slots_[static_cast<std::size_t> (j)]);
    std::vector<int> sizes (ball_.size (), 0), apart;
    for (std::size_t slot = 0; slot < ball_.size (); ++slot)
      ++sizes[static_cast<std::size_t> (groups.find (static_cast<int> (slot)))];
    const int own = slots_[i] < 0 ? -1 : groups.find (slots_[i]);
    const double reach = options_.separation_reach * options_.separation_reach;
    for (std::size_t slot = 0; slot < ball_.size (); ++slot)
    {
      const int group = groups.find (static_cast<int> (slot));
      if (own >= 0 && group != own && sizes[static_cast<std::size_t> (own)] >= options_.smallest &&
          sizes[static_cast<std::size_t> (group)] >= options_.smallest &&
          static_cast<double> (squared_[slot]) <= reach && !areSmooth (points_, options_, node, ball_[slot]))
        apart.push_back (ball_[slot]);
    }
    for (const int j : ball_)
      slots_[static_cast<std::size_t> (j)] = -1;
    std::sort (apart.begin (), apart.end ());
    return apart;
  }

private:
  const OrientedPoints &points_;
  const NeighborSearch &search_;
  const SegmentationOptions &options_;
  const NodeLists &links_;
  std::vector<int> slots_; // place in the ball, -1 outside
  std::vector<int> ball_;
  std::vector<float> squared_;
};

/** \brief For every node the nodes that must not be on its face; both see it so. */
NodeLists
findNodesApart (const OrientedPoints &points, const NeighborSearch &search, const SegmentationOptions &options,
                const NodeLists &links, const std::vector<char> &is_suspect, int threads)
{
  NodeLists seen (points.size ()), apart (points.size ());
  parallelFor (
      points.size (), threads, [&] { return LocalGroups (points, search, options, links); },
      [&] (LocalGroups &groups, std::size_t i)
      {
        if (is_suspect[i])
          seen[i] = groups.nodesApartFrom (static_cast<int> (i));
      });
  for (std::size_t i = 0; i < seen.size (); ++i)
    for (const int j : seen[i])
    {
      const auto &other = seen[static_cast<std::size_t> (j)];
      if (std::binary_search (other.begin (), other.end (), static_cast<int> (i)))
        apart[i].push_back (j);
    }
  return apart;
}

/** \brief Grows faces along the links, the smoothest first, without ever joining nodes that are apart. */
class FaceGrower
{
public:
  FaceGrower (const OrientedPoints &points, const SegmentationOptions &options, const NodeLists &links, NodeLists apart)
      : sets_ (points.size ()), apart_ (std::move (apart))
  {
    for (std::size_t i = 0; i < links.size (); ++i)
      for (const int j : links[i])
        if (static_cast<int> (i) < j)
        {
          const int node = static_cast<int> (i);
          const double turn = angleBetween (normalOf (points, node), normalOf (points, j));
          const double way = (positionOf (points, j) - positionOf (points, node)).norm () / options.spacing;
          constexpr double PER_SPACING = 0.05; // radians that weigh as much as a spacing
          order_.emplace_back (static_cast<float> (turn + PER_SPACING * way), node, j);
        }
    std::sort (order_.begin (), order_.end ());
  }

  /** \brief The faces' representatives, per node. */
  DisjointSets &
  grow ()
  {
    for (const auto &[cost, i, j] : order_)
    {
      const int a = sets_.find (i), b = sets_.find (j);
      if (a == b || refused_.count ({std::min (a, b), std::max (a, b)}) > 0)
        continue;
      if (areApart (a, b))
        refused_.emplace (std::min (a, b), std::max (a, b));
      else
        join (a, b);
    }
    return sets_;
  }

private:
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
  std::vector<std::tuple<float, int, int>> order_;
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
  const NodeLists links = linkNeighbors (points, search, options, threads, is_suspect);
  const NodeLists apart = findNodesApart (points, search, options, links, is_suspect, threads);
  DisjointSets sets = FaceGrower (points, options, links, apart).grow ();

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
  for (int i = 0; i < n; ++i)
    for (const int j : apart[static_cast<std::size_t> (i)])
    {
      const int face = result.faces[static_cast<std::size_t> (i)], other = result.faces[static_cast<std::size_t> (j)];
      if (i > j || face < 0 || other < 0)
        continue;
      result.separations.push_back (separationOf (points, i, j));
      result.separations.back ().face = std::min (face, other);
      result.separations.back ().other = std::max (face, other);
    }
  return result;
}

} // namespace erkpa
