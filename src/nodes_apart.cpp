// SPDX-License-Identifier: BSD-3-Clause
#include "nodes_apart.h"

#include "concurrent_sets.h"
#include "threads.h"

#include <algorithm>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief Finds the groups of linked nodes in the ball around a node, and the nodes that are apart from it. */
class LocalGroups
{
public:
  LocalGroups (const OrientedPoints &points, const NeighborSearch &search, const SegmentationOptions &options,
               const NodeLinks &links, const std::vector<int> &wholes)
      : points_ (points), search_ (search), options_ (options), test_ (options), links_ (links), wholes_ (wholes),
        groups_ (points.size (), OUTSIDE)
  {
  }

  /** \brief The nodes near \a node on other faces, sorted; empty where the node's own group is too small. */
  std::vector<int>
  nodesApartFrom (int node)
  {
    search_.nearestK (points_.positions[static_cast<std::size_t> (node)], options_.ball, ball_, squared_);
    for (const int j : ball_)
      group (j) = UNKNOWN;
    std::vector<int> apart;
    if (group (node) == UNKNOWN)
    {
      listStrangers (node);
      apart = strangersApartFrom (node);
    }
    for (const int j : ball_)
      group (j) = OUTSIDE;
    std::sort (apart.begin (), apart.end ());
    return apart;
  }

private:
  static constexpr int UNKNOWN = -1, STRANGER = -2, OUTSIDE = 0; // groups; others count from 1, the node's own

  int
  wholeOf (int node) const
  {
    return wholes_[static_cast<std::size_t> (node)];
  }

  int &
  group (int node)
  {
    return groups_[static_cast<std::size_t> (node)];
  }

  /** \brief Those close to a node that do not fit to it. */
  void
  listStrangers (int node)
  {
    const double reach = options_.separation_reach * options_.separation_reach;
    strangers_.clear ();
    for (std::size_t i = 0; i < ball_.size (); ++i)
      if (static_cast<double> (squared_[i]) <= reach && !test_.areSmooth (points_, node, ball_[i], squared_[i]))
        strangers_.push_back (ball_[i]);
  }

  /** \brief Of the strangers those that are of other groups than \a own; all groups must be large enough.
   *
   * Groups are followed from their ends only as far as it takes.
   */
  std::vector<int>
  strangersApartFrom (int own)
  {
    std::vector<int> others;
    auto unknown = strangers_.size ();
    for (const int stranger : strangers_)
      group (stranger) = STRANGER;
    const auto is_elsewhere = [&] (int node) { return wholeOf (node) != wholeOf (own); };
    const bool are_elsewhere = std::all_of (strangers_.begin (), strangers_.end (), is_elsewhere);
    const auto has_found_all = [&] (int, bool is_stranger) { return (unknown -= is_stranger ? 1 : 0) == 0; };
    const auto is_large = [&] (int count, bool) { return count >= options_.smallest; };
    const int size = are_elsewhere ? follow (own, 1, is_large) : follow (own, 1, has_found_all);
    if (unknown == 0 || size < options_.smallest)
      return others;
    std::vector<char> counts{0, 1}; // per group whether it is large enough
    for (const int stranger : strangers_)
    {
      if (group (stranger) < 0)
      {
        const int members = follow (stranger, static_cast<int> (counts.size ()), is_large);
        // A group that was left as large enough may be met again from another end.
        counts.push_back (members >= options_.smallest || meets_other_ ? 1 : 0);
      }
      if (group (stranger) > 1 && counts[static_cast<std::size_t> (group (stranger))])
        others.push_back (stranger);
    }
    return others;
  }

  /** \brief Follow the links from a node, and give all of the ball that are reached to a group.
   * \param[in] is_enough told the number of nodes reached and whether the last one was a stranger; true: stop
   * \return number of nodes reached
   */
  template <typename IsEnoughT>
  int
  follow (int start, int to, IsEnoughT is_enough)
  {
    int count = 0;
    meets_other_ = false;
    front_.clear ();
    const auto take = [&] (int node)
    {
      const bool is_stranger = std::exchange (group (node), to) == STRANGER;
      front_.push_back (node);
      return is_enough (++count, is_stranger);
    };
    if (take (start))
      return count;
    for (std::size_t next = 0; next < front_.size (); ++next) // NOLINT(modernize-loop-convert): it grows meanwhile
    {
      listUnknown (links_[static_cast<std::size_t> (front_[next])], to);
      for (std::size_t i = 0; i < linked_count_; ++i)
        if (take (linked_[i]))
          return count;
    }
    return count;
  }

  /** \brief Those of the links that lead to nodes of no group yet; without branches, which none could foretell. */
  void
  listUnknown (const NodeLinks::List &links, int own)
  {
    linked_.resize (std::max (linked_.size (), links.size ())); // never smaller: room need not be cleared again
    linked_count_ = 0;
    int others = 0;
    for (const int j : links)
    {
      const int known = groups_[static_cast<std::size_t> (j)];
      linked_[linked_count_] = j;
      linked_count_ += known < 0 ? 1 : 0;
      others |= static_cast<int> (known > 1) & static_cast<int> (known != own);
    }
    meets_other_ = meets_other_ || others != 0;
  }

  const OrientedPoints &points_;
  const NeighborSearch &search_;
  const SegmentationOptions &options_;
  const SmoothnessTest test_;
  const NodeLinks &links_;
  const std::vector<int> &wholes_; // what all links together join, per node
  std::vector<int> groups_;        // of all nodes
  std::vector<int> ball_;
  std::vector<float> squared_;
  std::vector<int> strangers_, front_, linked_;
  std::size_t linked_count_ = 0; // of linked_
  bool meets_other_ = false;     // whether the group last followed is part of one that was left before
};

/** \brief What the links join, in the whole cloud: a number for each node. */
std::vector<int>
findWholes (const NodeLinks &links, int threads)
{
  ConcurrentSets sets (links.size (), threads);
  std::vector<int> wholes (links.size ());
  parallelRanges (links.size (), threads,
                  [&] (std::size_t first, std::size_t last)
                  {
                    for (std::size_t i = first; i < last; ++i)
                      for (const int j : links[i])
                        sets.unite (static_cast<int> (i), j);
                  });
  parallelRanges (links.size (), threads,
                  [&] (std::size_t first, std::size_t last)
                  {
                    for (std::size_t i = first; i < last; ++i)
                      wholes[i] = sets.find (static_cast<int> (i));
                  });
  return wholes;
}

} // namespace

NodeLists
findNodesApart (const OrientedPoints &points, const NeighborSearch &search, const SegmentationOptions &options,
                const NodeLinks &links, const std::vector<char> &is_suspect, int threads)
{
  const std::vector<int> wholes = findWholes (links, threads);
  NodeLists seen (points.size ()), apart (points.size ());
  parallelFor (
      points.size (), threads, [&] { return LocalGroups (points, search, options, links, wholes); },
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

} // namespace erkpa
