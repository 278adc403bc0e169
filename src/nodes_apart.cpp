// SPDX-License-Identifier: BSD-3-Clause
#include "nodes_apart.h"

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
    for (std::size_t next = 0; next < front_.size (); ++next) // NOLINT(modernize-loop-convert): it grows meanwhile
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

} // namespace

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

} // namespace erkpa
