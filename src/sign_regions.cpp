// SPDX-License-Identifier: BSD-3-Clause
#include "sign_regions.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <queue>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief The links of each node, whichever end they were found at. */
class LinksOfNodes
{
public:
  struct Link
  {
    int to;
    float weight;
  };

  LinksOfNodes (std::size_t count, const std::vector<SignedLink> &links)
      : firsts_ (count + 1, 0), all_ (2 * links.size ())
  {
    for (const SignedLink &link : links)
      for (const int end : {link.from, link.to})
        ++firsts_[static_cast<std::size_t> (end) + 1];
    std::partial_sum (firsts_.begin (), firsts_.end (), firsts_.begin ());
    std::vector<std::size_t> next (firsts_.begin (), firsts_.end () - 1);
    for (const SignedLink &link : links)
    {
      all_[next[static_cast<std::size_t> (link.from)]++] = {link.to, link.weight};
      all_[next[static_cast<std::size_t> (link.to)]++] = {link.from, link.weight};
    }
  }

  const Link *
  begin (int node) const
  {
    return all_.data () + firsts_[static_cast<std::size_t> (node)];
  }

  const Link *
  end (int node) const
  {
    return begin (node + 1);
  }

private:
  std::vector<std::size_t> firsts_;
  std::vector<Link> all_;
};

class RegionTurner
{
public:
  RegionTurner (const std::vector<SignedLink> &links, std::vector<char> &flips)
      : links_ (flips.size (), links), flips_ (flips), nodes_of_ (flips.size (), 0), beside_ (flips.size (), 0),
        attached_ (flips.size (), 0.0f)
  {
  }

  void
  run ()
  {
    constexpr int PASSES = 3; // some regions are seen as a whole only once what they touch is right
    std::vector<int> seeds (flips_.size () - 1);
    std::iota (seeds.begin (), seeds.end (), 0);
    for (int pass = 0; pass < PASSES && !seeds.empty (); ++pass)
      seeds = growAll (seeds);
  }

private:
  using Link = LinksOfNodes::Link;

  static std::size_t
  at (int i)
  {
    return static_cast<std::size_t> (i);
  }

  int
  outside () const
  {
    return static_cast<int> (flips_.size ()) - 1;
  }

  /** \brief A link's weight, negative where the signs are not as it says. */
  float
  agreement (int node, const Link &link) const
  {
    return flips_[at (node)] == flips_[at (link.to)] ? link.weight : -link.weight;
  }

  /** \brief Grow regions from the links of nodes that are not heeded, but from where a region of this pass has been.
   * \return the nodes of those that were turned, and beside them
   */
  std::vector<int>
  growAll (const std::vector<int> &seeds)
  {
    constexpr float STRONG = 0.3f; // two neighbours in a plane, a spacing apart: 0.78
    const int before = region_;
    std::vector<int> again;
    for (const int seed : seeds)
      for (const Link *link = links_.begin (seed); link != links_.end (seed); ++link)
        if (nodes_of_[at (seed)] <= before && agreement (seed, *link) < -STRONG && growFrom (seed))
          again.insert (again.end (), touched_.begin (), touched_.end ());
    std::sort (again.begin (), again.end ());
    again.erase (std::unique (again.begin (), again.end ()), again.end ());
    return again;
  }

  /** \brief Grow a region, and turn it as it was when it agreed least with the nodes around. */
  bool
  growFrom (int seed)
  {
    constexpr std::size_t MOST = 300; // nodes of a region
    constexpr float CLEARLY = -0.5f;  // of its agreement with the surroundings
    ++region_;
    nodes_.clear ();
    touched_.clear ();
    queue_ = {};
    touch (seed);
    queue_.push ({0.0f, seed});
    float sum = 0.0f, least = 0.0f;
    std::size_t best = 0;
    while (!queue_.empty () && nodes_.size () < MOST)
    {
      const auto [attached, node] = queue_.top ();
      queue_.pop ();
      if (nodes_of_[at (node)] == region_ || attached != attached_[at (node)])
        continue; // outdated
      sum += take (node) - attached;
      if (sum < least)
      {
        least = sum;
        best = nodes_.size ();
      }
    }
    if (!(least < CLEARLY))
      return false;
    for (std::size_t i = 0; i < best; ++i)
      flips_[at (nodes_[i])] ^= 1;
    return true;
  }

  /** \brief Take a node into the region. \return its agreement with those outside of it */
  float
  take (int node)
  {
    nodes_of_[at (node)] = region_;
    nodes_.push_back (node);
    float with_others = 0.0f;
    for (const Link *link = links_.begin (node); link != links_.end (node); ++link)
    {
      if (nodes_of_[at (link->to)] == region_)
        continue;
      with_others += agreement (node, *link);
      if (link->to == outside ())
        continue;
      touch (link->to);
      attached_[at (link->to)] += agreement (node, *link);
      queue_.push ({attached_[at (link->to)], link->to});
    }
    return with_others;
  }

  void
  touch (int node)
  {
    if (beside_[at (node)] == region_)
      return;
    beside_[at (node)] = region_;
    attached_[at (node)] = 0.0f;
    touched_.push_back (node);
  }

  LinksOfNodes links_;
  std::vector<char> &flips_;
  std::vector<int> nodes_of_, beside_; // the last region that a node was in, and was touched by
  std::vector<float> attached_;        // agreement of a node with the region that it is beside
  int region_ = 0;
  std::vector<int> nodes_, touched_; // of the region: in the order in which they came; with those beside it
  std::priority_queue<std::pair<float, int>> queue_;
};

} // namespace

void
turnRegions (const std::vector<SignedLink> &links, std::vector<char> &flips)
{
  RegionTurner (links, flips).run ();
}

} // namespace erkpa
