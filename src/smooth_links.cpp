// SPDX-License-Identifier: BSD-3-Clause
#include "smooth_links.h"

#include "nearby_nodes.h"
#include "threads.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief Links nodes with the neighbours that fit to them, and tells which nodes have others, too. */
class NeighborLinker
{
public:
  NeighborLinker (const OrientedPoints &points, const PointGrid &grid, const SegmentationOptions &options, int threads)
      : points_ (points), grid_ (grid), options_ (options), threads_ (threads), test_ (options),
        near_ (std::max (options.separation_reach, options.link_reach * options.spacing)),
        far_ (options.bridge_reach * options.spacing)
  {
  }

  NodeLinks
  link (std::vector<char> &is_suspect) const
  {
    is_suspect.assign (points_.size (), 0);
    NodeLinks links (grid_);
    links.fill (
        threads_, [this] { return Worker (*this); },
        [&] (Worker &worker, std::size_t first, std::size_t last, NodeLinks::Lists &lists)
        {
          worker.near.visitRuns (
              first, last, [&] (std::size_t from, std::size_t to) { linkNear (worker, from, to, is_suspect, lists); });
        });
    if (!(far_ > near_))
      return links;
    const std::vector<char> is_wanted = markFar (is_suspect, links);
    links.fill (
        threads_, [this] { return Worker (*this); },
        [&] (Worker &worker, std::size_t first, std::size_t last, NodeLinks::Lists &lists)
        {
          worker.near.visitRuns (first, last,
                                 [&] (std::size_t from, std::size_t to)
                                 { linkFar (worker, from, to, is_wanted, links, lists); });
        });
    return links;
  }

private:
  struct Worker
  {
    explicit Worker (const NeighborLinker &linker) : near (linker.points_, linker.grid_) {}

    NearbyNodes near;
    std::vector<std::uint32_t> linked; // of them
  };

  void
  linkNear (Worker &worker, std::size_t first, std::size_t last, std::vector<char> &is_suspect,
            NodeLinks::Lists &lists) const
  {
    worker.near.gather (first, last, near_); // links end at far_, if that is less: others may be farther
    for (std::size_t place = first; place < last; ++place)
    {
      const int node = worker.near.nodeAt (place);
      is_suspect[static_cast<std::size_t> (node)] =
          appendLinks (worker, node, std::min (near_, far_), lists.nodes) ? 1 : 0;
      lists.close ();
    }
  }

  /** \brief Links of the wanted nodes, as far as they go; the others keep theirs. */
  void
  linkFar (Worker &worker, std::size_t first, std::size_t last, const std::vector<char> &is_wanted,
           const NodeLinks &links, NodeLinks::Lists &lists) const
  {
    bool is_gathered = false;
    for (std::size_t place = first; place < last; ++place)
    {
      const int node = worker.near.nodeAt (place);
      if (!is_wanted[static_cast<std::size_t> (node)])
      {
        const NodeLinks::List near = links[static_cast<std::size_t> (node)];
        lists.nodes.insert (lists.nodes.end (), near.begin (), near.end ());
      }
      else
      {
        if (!std::exchange (is_gathered, true))
          worker.near.gather (first, last, far_);
        appendLinks (worker, node, far_, lists.nodes);
      }
      lists.close ();
    }
  }

  /** \brief Append the links of a node with those within a reach; true where there are others close by. */
  bool
  appendLinks (Worker &worker, int node, double reach, std::vector<int> &links) const
  {
    const NearbyNodes &near = worker.near;
    worker.linked.resize (near.size () + lanes::MAX_WIDTH);
    const auto i = static_cast<std::size_t> (node);
    const Eigen::Vector3f &p = points_.positions[i], &n = points_.normals[i];
    const std::array<float, 6> own{p[0], p[1], p[2], n[0], n[1], n[2]};
    bool has_others = false;
    const std::size_t count = lanes::bestEngine ().linkSmooth (
        test_.limits (), near.table (), near.size (), own.data (), static_cast<float> (reach * reach),
        static_cast<float> (near_ * near_), worker.linked.data (), has_others);
    for (std::size_t l = 0; l < count; ++l)
      if (const int other = near.node (worker.linked[l]); other != node)
        links.push_back (other);
    return has_others;
  }

  /** \brief The nodes in the balls of suspects, and those with few neighbours. */
  std::vector<char>
  markFar (const std::vector<char> &is_suspect, const NodeLinks &links) const
  {
    std::vector<std::atomic<char>> marks (points_.size ());
    constexpr std::size_t STRETCH = 1024; // places
    parallelRanges (
        points_.size (), threads_,
        [&] (std::size_t first, std::size_t last)
        {
          Worker worker (*this);
          worker.near.visitRuns (first, last,
                                 [&] (std::size_t from, std::size_t to)
                                 { mark (worker, from, to, is_suspect, links, marks); });
        },
        STRETCH);
    return {marks.begin (), marks.end ()};
  }

  void
  mark (Worker &worker, std::size_t first, std::size_t last, const std::vector<char> &is_suspect,
        const NodeLinks &links, std::vector<std::atomic<char>> &marks) const
  {
    constexpr std::size_t FEW = 6;
    const double ball = 1.3 * options_.spacing * std::sqrt (options_.ball / M_PI);
    const auto squared_ball = static_cast<float> (ball * ball);
    bool is_gathered = false;
    for (std::size_t place = first; place < last; ++place)
    {
      const auto node = static_cast<std::size_t> (worker.near.nodeAt (place));
      if (links[node].size () < FEW)
        marks[node].store (1, std::memory_order_relaxed);
      if (!is_suspect[node])
        continue;
      if (!std::exchange (is_gathered, true))
        worker.near.gather (first, last, ball);
      for (std::size_t i = 0; i < worker.near.size (); ++i)
      {
        const auto other = static_cast<std::size_t> (worker.near.node (i));
        if ((points_.positions[other] - points_.positions[node]).squaredNorm () <= squared_ball)
          marks[other].store (1, std::memory_order_relaxed);
      }
    }
  }

  const OrientedPoints &points_;
  const PointGrid &grid_;
  const SegmentationOptions &options_;
  int threads_;
  const SmoothnessTest test_;
  double near_, far_;
};

} // namespace

NodeLinks
linkNeighbors (const OrientedPoints &points, const PointGrid &grid, const SegmentationOptions &options, int threads,
               std::vector<char> &is_suspect)
{
  return NeighborLinker (points, grid, options, threads).link (is_suspect);
}

} // namespace erkpa
