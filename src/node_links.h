// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "point_grid.h"
#include "threads.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace erkpa
{

/** \brief A list of other nodes for each node, in few pieces of memory, and in the order of a grid. */
class NodeLinks
{
public:
  /** \brief The list of one node. */
  struct List
  {
    const int *first, *last;

    const int *
    begin () const
    {
      return first;
    }

    const int *
    end () const
    {
      return last;
    }

    std::size_t
    size () const
    {
      return static_cast<std::size_t> (last - first);
    }
  };

  /** \brief The lists of some places of the grid, as they are made: one after the other. */
  struct Lists
  {
    std::vector<int> nodes;
    std::vector<std::uint32_t> ends;

    /** \brief The list of a place is complete. */
    void
    close ()
    {
      ends.push_back (static_cast<std::uint32_t> (nodes.size ()));
    }
  };

  /** \brief Empty lists. \param[in] grid over the nodes */
  explicit NodeLinks (const PointGrid &grid) : places_ (grid.size ()), ends_ (grid.size (), 0)
  {
    for (std::size_t place = 0; place < grid.size (); ++place)
      places_[grid.index ()[place]] = static_cast<std::uint32_t> (place);
    parts_.resize ((grid.size () + STRETCH - 1) / STRETCH);
  }

  /** \brief Replaces the lists by those that list (worker, first, last, lists) makes for the places first .. last - 1;
   * it may read these places' lists so far. See parallelFor. */
  template <typename MakeWorkerT, typename ListT>
  void
  fill (int threads, MakeWorkerT make_worker, ListT list)
  {
    using Worker = decltype (make_worker ());
    struct Filler
    {
      Worker worker;
      Lists lists;
    };
    parallelFor (
        parts_.size (), threads,
        [&] {
          return Filler{make_worker (), {}};
        },
        [&] (Filler &filler, std::size_t part)
        {
          Lists &lists = filler.lists;
          lists.nodes.clear ();
          lists.ends.clear ();
          const std::size_t first = part * STRETCH, last = std::min (size (), first + STRETCH);
          list (filler.worker, first, last, lists);
          std::copy (lists.ends.begin (), lists.ends.end (), ends_.begin () + static_cast<std::ptrdiff_t> (first));
          parts_[part] = lists.nodes; // just as much memory as it takes
        });
  }

  List
  operator[] (std::size_t node) const
  {
    const std::size_t place = places_[node];
    const int *part = parts_[place / STRETCH].data ();
    return {part + (place % STRETCH == 0 ? 0 : ends_[place - 1]), part + ends_[place]};
  }

  std::size_t
  size () const
  {
    return ends_.size ();
  }

private:
  static constexpr std::size_t STRETCH = 256; // places

  std::vector<std::uint32_t> places_; // of the nodes
  std::vector<std::vector<int>> parts_;
  std::vector<std::uint32_t> ends_; // of each place's list in its part
};

} // namespace erkpa
