// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "feature_loops.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief The crease vertices of loops, and which of them creases join: those on either side of a crossing. */
class CreaseLinks
{
public:
  explicit CreaseLinks (std::size_t loops) : centers_ (loops, -1), on_crease_ (loops, 0) {}

  /** \brief Take up the crease vertex of a loop. */
  void
  add (std::size_t loop, int center, const std::vector<VertexPair> &crossings)
  {
    on_crease_[loop] = 1;
    centers_[loop] = center;
    for (const VertexPair &pair : crossings)
      crossings_[pair].push_back (loop);
  }

  void
  giveUp (std::size_t loop)
  {
    on_crease_[loop] = 0;
  }

  /** \brief Whether a loop has its crease vertex still. */
  bool
  has (std::size_t loop) const
  {
    return on_crease_[loop] != 0;
  }

  int
  center (std::size_t loop) const
  {
    return centers_[loop];
  }

  /** \brief Find for each crossing the two loops whose vertices the crease joins; each two are joined once. */
  void
  join ()
  {
    joined_.clear ();
    edges_.clear ();
    for (const auto &[pair, of] : crossings_)
      if (of.size () == 2 && has (of[0]) && has (of[1]))
      {
        const VertexPair edge = orderedPair (center (of[0]), center (of[1]));
        if (edge.first != edge.second && edges_.insert (edge).second)
          joined_.push_back ({pair, {of[0], of[1]}});
      }
  }

  /** \brief The vertex that the crease through the side a, b of a loop goes on to; -1 where none runs through it. */
  int
  next (std::size_t loop, int a, int b) const
  {
    const VertexPair pair = orderedPair (a, b);
    const auto found = std::lower_bound (joined_.begin (), joined_.end (), pair,
                                         [] (const Joined &joined, const VertexPair &p) { return joined.first < p; });
    if (found == joined_.end () || found->first != pair)
      return -1;
    const auto &[one, other] = found->second;
    return loop == one ? center (other) : center (one);
  }

  /** \brief A crossing and the two loops that it joins. */
  using Joined = std::pair<VertexPair, std::pair<std::size_t, std::size_t>>;

  /** \brief All of them, by their crossings. */
  const std::vector<Joined> &
  joined () const
  {
    return joined_;
  }

  /** \brief The edges between joined vertices. */
  const std::set<VertexPair> &
  edges () const
  {
    return edges_;
  }

private:
  std::vector<int> centers_; // crease vertices of the loops
  std::vector<char> on_crease_;
  std::map<VertexPair, std::vector<std::size_t>> crossings_; // the loops that a crossing is of
  std::vector<Joined> joined_;
  std::set<VertexPair> edges_;
};

} // namespace erkpa
