// SPDX-License-Identifier: BSD-3-Clause
#include "orientation_graph.h"

#include <algorithm>
#include <cmath>
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
    for (int i = 0; i < count; ++i)
      for (const auto &[j, weight] : of (i))
        if (i < j)
          queue_.push ({std::abs (weight), i, j});
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

} // namespace

std::vector<char>
agreeOnSigns (int count, const std::vector<SignedLink> &links)
{
  Contraction contraction (count, links);
  contraction.run ();
  return contraction.flips ();
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
