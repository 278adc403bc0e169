// SPDX-License-Identifier: BSD-3-Clause
#include "smooth_links.h"

#include "threads.h"

#include <atomic>

namespace erkpa
{

namespace
{

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

  NodeLinks
  link (std::vector<char> &is_suspect) const
  {
    is_suspect.assign (points_.size (), 0);
    NodeLinks links;
    links.fill (
        points_.size (), threads_, [] { return Found (); },
        [&] (Found &found, std::size_t i, std::vector<int> &of_node)
        { is_suspect[i] = linkWithin (near_, i, found, of_node) ? 1 : 0; });
    if (!(far_ > near_))
      return links;
    const std::vector<char> is_wanted = markFar (is_suspect, links);
    links.refill (
        threads_, [] { return Found (); },
        [&] (Found &found, std::size_t i, const NodeLinks::List &near, std::vector<int> &of_node)
        {
          if (is_wanted[i])
            linkWithin (far_, i, found, of_node);
          else
            of_node.insert (of_node.end (), near.begin (), near.end ());
        });
    return links;
  }

private:
  struct Found
  {
    std::vector<int> nodes;
    std::vector<float> squared;
  };

  /** \brief Append the links of a node with those within a reach; true where there are others close by. */
  bool
  linkWithin (double reach, std::size_t i, Found &found, std::vector<int> &links) const
  {
    search_.withinRadius (points_.positions[i], reach, found.nodes, found.squared);
    const int node = static_cast<int> (i);
    const auto near = static_cast<float> (near_ * near_), far = static_cast<float> (far_ * far_);
    bool has_others = false;
    for (std::size_t n = 0; n < found.nodes.size (); ++n)
    {
      const int j = found.nodes[n];
      const float squared = found.squared[n];
      if (j == node)
        continue;
      if (squared <= far && test_.areLinked (node, j, squared))
        links.push_back (j);
      else
        has_others = has_others || squared <= near;
    }
    return has_others;
  }

  /** \brief The nodes in the balls of suspects, and those with few neighbours. */
  std::vector<char>
  markFar (const std::vector<char> &is_suspect, const NodeLinks &links) const
  {
    constexpr std::size_t FEW = 6;
    const double ball = 1.3 * options_.spacing * std::sqrt (options_.ball / M_PI);
    std::vector<std::atomic<char>> marks (points_.size ());
    parallelFor (
        points_.size (), threads_, [] { return Found (); },
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

} // namespace

NodeLinks
linkNeighbors (const OrientedPoints &points, const NeighborSearch &search, const SegmentationOptions &options,
               int threads, std::vector<char> &is_suspect)
{
  return NeighborLinker (points, search, options, threads).link (is_suspect);
}

} // namespace erkpa
