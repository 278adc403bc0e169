// SPDX-License-Identifier: BSD-3-Clause
#include "face_segmentation.h"

#include "mesh_graph.h"
#include "parallel_collect.h"
#include "threads.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

namespace erkpa
{

namespace
{

using NodeLists = std::vector<std::vector<int>>; // per node

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

/** \brief Tells what fits to one smooth surface. */
class SmoothnessTest
{
public:
  SmoothnessTest (const OrientedPoints &points, const SegmentationOptions &options)
      : points_ (points), chord_ (options.chord), cosine_ (std::cos (options.angle)),
        far_cosine_ (std::cos (BRIDGE_ANGLE * options.angle)), link_reach_ (options.link_reach * options.spacing)
  {
  }

  /** \brief Whether two nodes fit to one smooth surface. */
  bool
  areSmooth (int i, int j) const
  {
    const Eigen::Vector3d way = positionOf (points_, j) - positionOf (points_, i);
    return areSmooth (i, j, way, way.norm (), cosine_, BEND);
  }

  /** \brief Whether to link two nodes. Those farther apart must agree better: they bridge gaps in narrow faces. */
  bool
  areLinked (int i, int j, double &distance) const
  {
    const Eigen::Vector3d way = positionOf (points_, j) - positionOf (points_, i);
    distance = way.norm ();
    return distance <= link_reach_ ? areSmooth (i, j, way, distance, cosine_, BEND)
                                   : areSmooth (i, j, way, distance, far_cosine_, BRIDGE_BEND);
  }

private:
  static constexpr double BEND = 0.2, BRIDGE_BEND = 0.08, BRIDGE_ANGLE = 0.7;

  /** \brief Similar normals, and across them no step.
   * \param[in] bend how large a step may be as a share of the distance; that of a circular arc is zero
   */
  bool
  areSmooth (int i, int j, const Eigen::Vector3d &way, double distance, double least_cosine, double bend) const
  {
    const Eigen::Vector3d n = normalOf (points_, i), m = normalOf (points_, j);
    return n.dot (m) >= least_cosine && 0.5 * std::abs (way.dot (n + m)) <= std::max (bend * distance, chord_);
  }

  const OrientedPoints &points_;
  double chord_, cosine_, far_cosine_, link_reach_;
};

/** \brief Links nodes with the neighbours that fit to them, and tells which nodes have others, too. */
class NeighborLinker
{
public:
  NeighborLinker (const OrientedPoints &points, const NeighborSearch &search, const SegmentationOptions &options,
                  int threads)
      : points_ (points), search_ (search), options_ (options), threads_ (threads), test_ (points, options),
        near_ (std::max (options.separation_reach, options.link_reach * options.spacing)),
        far_ (options.bridge_reach * options.spacing)
  {
  }

  /** \brief Far links bridge gaps, and tell faces apart in the balls of suspects: elsewhere near ones do. */
  NodeLists
  link (std::vector<char> &is_suspect) const
  {
    NodeLists links (points_.size ());
    is_suspect.assign (points_.size (), 0);
    forEachNode ([&] (Found &found, std::size_t i) { is_suspect[i] = linkWithin (near_, i, found, links[i]) ? 1 : 0; });
    if (!(far_ > near_))
      return links;
    const std::vector<char> is_wanted = markFar (is_suspect, links);
    forEachNode (
        [&] (Found &found, std::size_t i)
        {
          links[i].shrink_to_fit ();
          if (is_wanted[i])
            linkWithin (far_, i, found, links[i]);
        });
    return links;
  }

private:
  struct Found
  {
    std::vector<int> nodes;
    std::vector<float> squared;
  };

  template <typename WorkT>
  void
  forEachNode (WorkT work) const
  {
    parallelFor (
        points_.size (), threads_, [] { return Found (); }, work);
  }

  /** \brief Link a node with those within a reach; true where there are others close by. */
  bool
  linkWithin (double reach, std::size_t i, Found &found, std::vector<int> &links) const
  {
    search_.withinRadius (points_.positions[i], reach, found.nodes, found.squared);
    links.clear ();
    bool has_others = false;
    for (const int j : found.nodes)
    {
      const int node = static_cast<int> (i);
      double distance = 0.0;
      if (j == node)
        continue;
      if (test_.areLinked (node, j, distance) && distance <= far_)
        links.push_back (j);
      else
        has_others = has_others || distance <= near_;
    }
    return has_others;
  }

  /** \brief The nodes in the balls of suspects, and those with few neighbours. */
  std::vector<char>
  markFar (const std::vector<char> &is_suspect, const NodeLists &links) const
  {
    constexpr std::size_t FEW = 6;
    const double ball = 1.3 * options_.spacing * std::sqrt (options_.ball / M_PI);
    std::vector<std::atomic<char>> marks (points_.size ());
    forEachNode (
        [&] (Found &found, std::size_t i)
        {
          if (links[i].size () < FEW)
            marks[i].store (1, std::memory_order_relaxed);
          if (!is_suspect[i])
            return;
          search_.withinRadius (points_.positions[i], ball, found.nodes, found.squared);
          for (const int j : found.nodes)
            marks[static_cast<std::size_t> (j)].store (1, std::memory_order_relaxed);
        });
    return {marks.begin (), marks.end ()};
  }

  const OrientedPoints &points_;
  const NeighborSearch &search_;
  const SegmentationOptions &options_;
  int threads_;
  const SmoothnessTest test_;
  double near_, far_;
};

/** \brief Finds the groups of linked nodes in the ball around a node, and the nodes that are apart from it. */
class LocalGroups
{
public:
  LocalGroups (const OrientedPoints &points, const NeighborSearch &search, const SegmentationOptions &options,
               const NodeLists &links)
      : points_ (points), search_ (search), options_ (options), test_ (points, options), links_ (links),
        slots_ (points.size (), options.ball)
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
    std::vector<int> apart;
    if (slots_[i] < options_.ball)
    {
      listStrangers (node);
      for (const int slot : groupsOfStrangers (slots_[i]))
        apart.push_back (ball_[static_cast<std::size_t> (slot)]);
    }
    for (const int j : ball_)
      slots_[static_cast<std::size_t> (j)] = options_.ball;
    std::sort (apart.begin (), apart.end ());
    return apart;
  }

private:
  static constexpr int UNKNOWN = -1, STRANGER = -2; // groups

  /** \brief The slots of those close to a node that do not fit to it. */
  void
  listStrangers (int node)
  {
    const double reach = options_.separation_reach * options_.separation_reach;
    strangers_.clear ();
    for (std::size_t slot = 0; slot < ball_.size (); ++slot)
      if (static_cast<double> (squared_[slot]) <= reach && !test_.areSmooth (node, ball_[slot]))
        strangers_.push_back (static_cast<int> (slot));
  }

  /** \brief Of the strangers those that are of other groups than \a own; all groups must be large enough.
   *
   * Groups are followed from their ends only as far as it takes.
   */
  std::vector<int>
  groupsOfStrangers (int own)
  {
    std::vector<int> others;
    groups_.assign (static_cast<std::size_t> (options_.ball) + 1, UNKNOWN);
    groups_.back () = 0; // nothing outside is ever taken up
    auto unknown = strangers_.size ();
    for (const int stranger : strangers_)
      groups_[static_cast<std::size_t> (stranger)] = STRANGER;
    const auto has_found_all = [&] (int, bool is_stranger) { return (unknown -= is_stranger ? 1 : 0) == 0; };
    const int size = follow (own, 0, has_found_all);
    if (unknown == 0 || size < options_.smallest)
      return others;
    const auto is_large = [&] (int count, bool) { return count >= options_.smallest; };
    std::vector<char> counts{1}; // per group whether it is large enough
    for (const int stranger : strangers_)
    {
      int group = groups_[static_cast<std::size_t> (stranger)];
      if (group < 0)
      {
        group = static_cast<int> (counts.size ());
        const int members = follow (stranger, group, is_large);
        // A group that was left as large enough may be met again from another end.
        counts.push_back (members >= options_.smallest || meets_other_ ? 1 : 0);
      }
      if (group > 0 && counts[static_cast<std::size_t> (group)])
        others.push_back (stranger);
    }
    return others;
  }

  /** \brief Follow the links from a slot, and give all that are reached to a group.
   * \param[in] is_enough told the number of slots reached and whether the last one was a stranger; true: stop
   * \return number of slots reached
   */
  template <typename IsEnoughT>
  int
  follow (int start, int group, IsEnoughT is_enough)
  {
    int count = 0;
    meets_other_ = false;
    front_.clear ();
    const auto take = [&] (int slot)
    {
      const bool is_stranger = std::exchange (groups_[static_cast<std::size_t> (slot)], group) == STRANGER;
      front_.push_back (slot);
      return is_enough (++count, is_stranger);
    };
    if (take (start))
      return count;
    for (std::size_t next = 0; next < front_.size (); ++next)
    {
      listUnknown (links_[static_cast<std::size_t> (ball_[static_cast<std::size_t> (front_[next])])], group);
      for (const int slot : linked_)
        if (take (slot))
          return count;
    }
    return count;
  }

  /** \brief Those of the links that lead to slots of no group yet; without branches, which none could foretell. */
  void
  listUnknown (const std::vector<int> &links, int group)
  {
    linked_.resize (links.size ());
    std::size_t kept = 0;
    int others = 0;
    for (const int j : links)
    {
      const int slot = slots_[static_cast<std::size_t> (j)], known = groups_[static_cast<std::size_t> (slot)];
      linked_[kept] = slot;
      kept += known < 0 ? 1 : 0;
      others |= static_cast<int> (known > 0) & static_cast<int> (known != group);
    }
    linked_.resize (kept);
    meets_other_ = meets_other_ || others != 0;
  }

  const OrientedPoints &points_;
  const NeighborSearch &search_;
  const SegmentationOptions &options_;
  const SmoothnessTest test_;
  const NodeLists &links_;
  std::vector<int> slots_; // place in the ball; that after the last outside
  std::vector<int> ball_;
  std::vector<float> squared_;
  std::vector<int> strangers_, front_, linked_; // slots
  std::vector<int> groups_;                     // of the slots, and of what is outside; 0 is the node's own
  bool meets_other_ = false;                    // whether the group last followed is part of one that was left before
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
  parallelFor (
      points.size (), threads, [] { return 0; },
      [&] (int, std::size_t i)
      {
        for (const int j : seen[i])
        {
          const auto &other = seen[static_cast<std::size_t> (j)];
          if (std::binary_search (other.begin (), other.end (), static_cast<int> (i)))
            apart[i].push_back (j);
        }
      });
  return apart;
}

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

/** \brief All links once: the turn between the normals, and a little for the way. */
std::vector<Growth>
listGrowths (const OrientedPoints &points, const SegmentationOptions &options, const NodeLists &links, int threads)
{
  constexpr double PER_SPACING = 0.05; // radians that weigh as much as a spacing
  constexpr std::size_t STRETCH = 512;
  const auto list = [&] (std::size_t first, std::size_t last, std::vector<Growth> &growths)
  {
    for (std::size_t i = first; i < last; ++i)
      for (const int j : links[i])
      {
        const int node = static_cast<int> (i);
        if (j < node)
          continue;
        const double turn = angleBetween (normalOf (points, node), normalOf (points, j));
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
  const NodeLists links = NeighborLinker (points, search, options, threads).link (is_suspect);
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
