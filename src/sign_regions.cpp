// SPDX-License-Identifier: BSD-3-Clause
#include "sign_regions.h"

#include <algorithm>
#include <numeric>
#include <queue>
#include <utility>

namespace erkpa
{

namespace
{

class RegionTurner
{
public:
  RegionTurner (const std::vector<SignedLink> &links, std::size_t between_neighbors, std::vector<char> &flips)
      : links_ (links), between_ (between_neighbors), flips_ (flips), firsts_ (flips.size () + 1, between_neighbors),
        outside_ (flips.size (), 0.0f), attached_ (flips.size (), 0.0f), region_of_ (flips.size (), 0)
  {
    for (std::size_t i = between_; i-- > 0;)
      firsts_[at (links[i].from)] = i;
    for (std::size_t node = firsts_.size () - 1; node-- > 0;)
      firsts_[node] = std::min (firsts_[node], firsts_[node + 1]);
    for (std::size_t i = between_; i < links.size (); ++i)
      outside_[at (links[i].from)] += agreement (links[i]);
  }

  void
  run ()
  {
    constexpr int PASSES = 3; // some regions are seen as a whole only once what they touch is right
    std::vector<int> seeds (flips_.size ());
    std::iota (seeds.begin (), seeds.end (), 0);
    for (int pass = 0; pass < PASSES && !seeds.empty (); ++pass)
      seeds = growAll (seeds, region_);
  }

private:
  static std::size_t
  at (int i)
  {
    return static_cast<std::size_t> (i);
  }

  /** \brief Grow regions from the links of nodes that are not heeded, but from where a region of this pass has been.
   * \return the nodes of those that were turned, and beside them
   */
  std::vector<int>
  growAll (const std::vector<int> &seeds, int before)
  {
    constexpr float STRONG = 0.3f; // two neighbours in a plane, a spacing apart: 0.78
    std::vector<int> again;
    for (const int seed : seeds)
      for (std::size_t i = firsts_[at (seed)]; i < firsts_[at (seed) + 1]; ++i)
        if (agreement (links_[i]) < -STRONG)
          for (const int end : {seed, links_[i].to})
            if (region_of_[at (end)] <= before && growFrom (end))
              again.insert (again.end (), touched_.begin (), touched_.end ());
    std::sort (again.begin (), again.end ());
    again.erase (std::unique (again.begin (), again.end ()), again.end ());
    return again;
  }

  /** \brief A link's weight, negative where the signs are not as it says. */
  float
  agreement (const SignedLink &link) const
  {
    return flips_[at (link.from)] == flips_[at (link.to)] ? link.weight : -link.weight;
  }

  /** \brief Agreement of a node with those outside of the growing region. */
  float
  withOthers (int node) const
  {
    float sum = outside_[at (node)];
    for (std::size_t i = firsts_[at (node)]; i < firsts_[at (node) + 1]; ++i)
      if (region_of_[at (links_[i].to)] != region_)
        sum += agreement (links_[i]);
    return sum;
  }

  bool
  growFrom (int seed)
  {
    constexpr std::size_t MOST = 300; // nodes of a region
    constexpr float CLEARLY = -0.3f;  // of its agreement with the surroundings
    ++region_;
    nodes_.clear ();
    touched_.clear ();
    queue_ = {};
    float sum = 0.0f, least = 0.0f;
    std::size_t best = 0;
    queue_.push ({0.0f, seed});
    while (!queue_.empty () && nodes_.size () < MOST)
    {
      const int node = queue_.top ().second;
      queue_.pop ();
      if (region_of_[at (node)] == region_)
        continue;
      sum -= attached_[at (node)];
      take (node);
      sum += withOthers (node);
      if (sum < least)
      {
        least = sum;
        best = nodes_.size ();
      }
    }
    for (const int node : touched_)
      attached_[at (node)] = 0.0f;
    if (least < CLEARLY)
      turn (best);
    return least < CLEARLY;
  }

  void
  take (int node)
  {
    region_of_[at (node)] = region_;
    nodes_.push_back (node);
    for (std::size_t i = firsts_[at (node)]; i < firsts_[at (node) + 1]; ++i)
    {
      const int other = links_[i].to;
      if (region_of_[at (other)] == region_)
        continue;
      if (attached_[at (other)] == 0.0f)
        touched_.push_back (other);
      attached_[at (other)] += agreement (links_[i]);
      queue_.push ({2.0f * attached_[at (other)] - withOthers (other), other});
    }
  }

  void
  turn (std::size_t count)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      flips_[at (nodes_[i])] ^= 1;
      outside_[at (nodes_[i])] = -outside_[at (nodes_[i])];
    }
  }

  const std::vector<SignedLink> &links_;
  std::size_t between_;
  std::vector<char> &flips_;
  std::vector<std::size_t> firsts_; // links of each node
  std::vector<float> outside_;      // agreement with the outside
  std::vector<float> attached_;     // agreement of the region with a node beside it
  std::vector<int> region_of_;      // the last region that a node was in
  int region_ = 0;
  std::vector<int> nodes_, touched_;
  std::priority_queue<std::pair<float, int>> queue_;
};

} // namespace

void
turnRegions (const std::vector<SignedLink> &links, std::size_t between_neighbors, std::vector<char> &flips)
{
  RegionTurner (links, between_neighbors, flips).run ();
}

} // namespace erkpa
