// SPDX-License-Identifier: BSD-3-Clause
#include "orientation_graph.h"

#include "parallel_collect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief Two sets of nodes that may become one; outdated once what is known of them has changed. */
struct Candidate
{
  float sureness;
  int low, high;

  bool
  operator<(const Candidate &other) const
  {
    return std::make_tuple (sureness, -low, -high) < std::make_tuple (other.sureness, -other.low, -other.high);
  }
};

/** \brief Sets of nodes, each named by one of them, and what they say about each other. */
class Contraction
{
public:
  Contraction (int count, const std::vector<SignedLink> &links)
      : parents_ (static_cast<std::size_t> (count)), flips_ (parents_.size (), 0), links_ (parents_.size ())
  {
    std::iota (parents_.begin (), parents_.end (), 0);
    for (const SignedLink &link : links)
      if (link.from != link.to)
      {
        of (link.from)[link.to] += link.weight;
        of (link.to)[link.from] += link.weight;
      }
    std::vector<Candidate> candidates;
    for (int i = 0; i < count; ++i)
      for (const auto &[j, weight] : of (i))
        if (i < j)
          candidates.push_back ({std::abs (weight), i, j});
    queue_ = std::priority_queue<Candidate> (std::less<Candidate> (), std::move (candidates));
  }

  void
  run ()
  {
    while (!queue_.empty ())
    {
      const Candidate next = queue_.top ();
      queue_.pop ();
      if (parents_[at (next.low)] != next.low || parents_[at (next.high)] != next.high)
        continue;
      const auto link = of (next.low).find (next.high);
      if (link == of (next.low).end () || std::abs (link->second) != next.sureness)
        continue; // outdated
      contract (next.low, next.high, link->second < 0.0f);
    }
  }

  /** \brief After run(): per node, whether it is opposite to its set. */
  std::vector<char>
  flips () const
  {
    std::vector<char> flips = flips_;
    for (auto moved = moves_.rbegin (); moved != moves_.rend (); ++moved)
      flips[at (*moved)] ^= flips[at (parents_[at (*moved)])];
    return flips;
  }

private:
  using Links = std::unordered_map<int, float>;

  static std::size_t
  at (int i)
  {
    return static_cast<std::size_t> (i);
  }

  Links &
  of (int i)
  {
    return links_[at (i)];
  }

  /** \brief Makes one set of two; the one with fewer links is moved. */
  void
  contract (int a, int b, bool flips)
  {
    if (of (a).size () < of (b).size ())
      std::swap (a, b);
    parents_[at (b)] = a;
    flips_[at (b)] = flips ? 1 : 0;
    moves_.push_back (b);
    of (a).erase (b);
    for (const auto &[other, weight] : of (b))
    {
      if (other == a)
        continue;
      of (other).erase (b);
      float &sum = of (a)[other];
      sum += flips ? -weight : weight;
      of (other)[a] = sum;
      queue_.push ({std::abs (sum), std::min (a, other), std::max (a, other)});
    }
    Links ().swap (of (b));
  }

  std::vector<int> parents_;
  std::vector<char> flips_;  // against the parent
  std::vector<int> moves_;   // that have a parent, in the order they got it
  std::vector<Links> links_; // of the roots, among roots; the same in both directions
  std::priority_queue<Candidate> queue_;
};

/** \brief Finds the links between neighbours that are sure by themselves, and that no third node contradicts. */
class SureLinks
{
public:
  static constexpr float SURE = 0.6f; // two neighbours in a plane, a spacing apart: 0.78

  /** \param[in] count of the nodes
   * \param[in] links sorted by the nodes that they lead from; \a size of them are between neighbours
   */
  SureLinks (int count, const std::vector<SignedLink> &links, std::size_t size)
      : links_ (links), size_ (size), firsts_ (static_cast<std::size_t> (count) + 1, size)
  {
    for (std::size_t i = size; i-- > 0;)
      firsts_[static_cast<std::size_t> (links[i].from)] = i;
    for (std::size_t node = firsts_.size () - 1; node-- > 0;)
      firsts_[node] = std::min (firsts_[node], firsts_[node + 1]);
  }

  std::vector<SignedLink>
  find (int threads) const
  {
    return parallelCollect<std::vector<SignedLink>> (
        size_, threads,
        [this] (std::size_t first, std::size_t last, std::vector<SignedLink> &found)
        {
          for (std::size_t i = first; i < last; ++i)
            if (std::abs (links_[i].weight) >= SURE && !isContradicted (links_[i]))
              found.push_back (links_[i]);
        });
  }

private:
  /** \brief Whether a common neighbour sees the one node of a link so and the other so that the link would be wrong. */
  bool
  isContradicted (const SignedLink &link) const
  {
    constexpr float AUDIBLE = 0.03f; // votes for less do not count
    for (const SignedLink *ours = begin (link.from); ours != begin (link.from + 1); ++ours)
      for (const SignedLink *theirs = begin (link.to); theirs != begin (link.to + 1); ++theirs)
        if (ours->to == theirs->to && ours->weight * theirs->weight * link.weight < 0.0f &&
            std::min (std::abs (ours->weight), std::abs (theirs->weight)) > AUDIBLE)
          return true;
    return false;
  }

  const SignedLink *
  begin (int node) const
  {
    return links_.data () + firsts_[static_cast<std::size_t> (node)];
  }

  const std::vector<SignedLink> &links_;
  std::size_t size_;
  std::vector<std::size_t> firsts_; // links of each node
};

/** \brief Sets of nodes that know their signs relative to each other. */
class SureSets
{
public:
  explicit SureSets (int count) : parents_ (static_cast<std::size_t> (count)), flips_ (parents_.size (), 0)
  {
    std::iota (parents_.begin (), parents_.end (), 0);
  }

  /** \brief Join what links join, the surest first. */
  void
  join (const std::vector<SignedLink> &links)
  {
    constexpr std::array<float, 4> BANDS{0.9f, 0.8f, 0.7f, 0.0f};
    for (const float least : BANDS)
      for (const SignedLink &link : links)
        if (std::abs (link.weight) >= least)
          unite (link);
  }

  /** \brief Per node the set that it is in, named by one of its nodes, and whether it is opposite to that. */
  void
  results (std::vector<int> &sets, std::vector<char> &flips)
  {
    for (std::size_t i = 0; i < parents_.size (); ++i)
      find (static_cast<int> (i));
    sets = parents_;
    flips = flips_;
  }

private:
  /** \brief The root of a node, which becomes its parent. */
  int
  find (int node)
  {
    path_.clear ();
    for (; parents_[static_cast<std::size_t> (node)] != node; node = parents_[static_cast<std::size_t> (node)])
      path_.push_back (static_cast<std::size_t> (node));
    char flip = 0;
    for (auto below = path_.rbegin (); below != path_.rend (); ++below)
    {
      flip = flips_[*below] ^= flip;
      parents_[*below] = node;
    }
    return node;
  }

  void
  unite (const SignedLink &link)
  {
    const int a = find (link.from), b = find (link.to);
    const char flip = flips_[static_cast<std::size_t> (link.from)] ^ flips_[static_cast<std::size_t> (link.to)] ^
                      (link.weight < 0.0f ? 1 : 0);
    if (a == b)
      return;
    parents_[static_cast<std::size_t> (std::max (a, b))] = std::min (a, b);
    flips_[static_cast<std::size_t> (std::max (a, b))] = flip;
  }

  std::vector<int> parents_;
  std::vector<char> flips_; // against the parent; none of a root
  std::vector<std::size_t> path_;
};

/** \brief What the sets say about each other. */
std::vector<SignedLink>
linksOfSets (const std::vector<SignedLink> &links, const std::vector<int> &sets, const std::vector<char> &flips)
{
  std::vector<SignedLink> between;
  for (const SignedLink &link : links)
  {
    const auto from = static_cast<std::size_t> (link.from), to = static_cast<std::size_t> (link.to);
    if (sets[from] != sets[to])
      between.push_back ({sets[from], sets[to], flips[from] != flips[to] ? -link.weight : link.weight});
  }
  return between;
}

} // namespace

std::vector<char>
agreeOnSigns (int count, const std::vector<SignedLink> &links, std::size_t between_neighbors, int threads)
{
  SureSets sure (count);
  sure.join (SureLinks (count, links, between_neighbors).find (threads));
  std::vector<int> sets;
  std::vector<char> flips;
  sure.results (sets, flips);
  Contraction contraction (count, linksOfSets (links, sets, flips));
  contraction.run ();
  const std::vector<char> flips_of_sets = contraction.flips ();
  for (std::size_t i = 0; i < flips.size (); ++i)
    flips[i] ^= flips_of_sets[static_cast<std::size_t> (sets[i])];
  return flips;
}

std::vector<int>
piecesOf (int count, const std::vector<SignedLink> &links)
{
  std::vector<int> parents (static_cast<std::size_t> (count));
  std::iota (parents.begin (), parents.end (), 0);
  const auto root = [&] (int node)
  {
    while (parents[static_cast<std::size_t> (node)] != node)
    {
      int &parent = parents[static_cast<std::size_t> (node)];
      parent = parents[static_cast<std::size_t> (parent)];
      node = parent;
    }
    return node;
  };
  for (const SignedLink &link : links)
  {
    const int a = root (link.from), b = root (link.to);
    parents[static_cast<std::size_t> (std::max (a, b))] = std::min (a, b);
  }
  std::vector<int> pieces;
  pieces.reserve (parents.size ());
  for (int i = 0; i < count; ++i)
    pieces.push_back (root (i));
  return pieces;
}

} // namespace erkpa
