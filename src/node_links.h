// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "threads.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief A list of other nodes for each node, in few pieces of memory. */
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

  /** \brief Lists what append (worker, node, list) appends for each of \a count nodes; see parallelFor. */
  template <typename MakeWorkerT, typename AppendT>
  void
  fill (std::size_t count, int threads, MakeWorkerT make_worker, AppendT append)
  {
    ends_.assign (count, 0);
    parts_.assign ((count + STRETCH - 1) / STRETCH, {});
    refill (threads, make_worker,
            [&] (auto &worker, std::size_t i, const List &, std::vector<int> &list) { append (worker, i, list); });
  }

  /** \brief Replaces the lists by what append (worker, node, list so far, list) appends. */
  template <typename MakeWorkerT, typename AppendT>
  void
  refill (int threads, MakeWorkerT make_worker, AppendT append)
  {
    using Worker = decltype (make_worker ());
    parallelFor (
        parts_.size (), threads, [&] { return std::pair<Worker, std::vector<int>> (make_worker (), {}); },
        [&] (auto &worker, std::size_t part)
        {
          std::vector<int> &lists = worker.second;
          lists.clear ();
          std::array<std::uint32_t, STRETCH> ends{};
          const std::size_t first = part * STRETCH, last = std::min (size (), first + STRETCH);
          for (std::size_t i = first; i < last; ++i)
          {
            append (worker.first, i, (*this)[i], lists);
            ends[i - first] = static_cast<std::uint32_t> (lists.size ());
          }
          std::copy_n (ends.begin (), last - first, ends_.begin () + static_cast<std::ptrdiff_t> (first));
          parts_[part] = lists; // just as much memory as it takes
        });
  }

  List
  operator[] (std::size_t node) const
  {
    const int *part = parts_[node / STRETCH].data ();
    return {part + (node % STRETCH == 0 ? 0 : ends_[node - 1]), part + ends_[node]};
  }

  std::size_t
  size () const
  {
    return ends_.size ();
  }

private:
  static constexpr std::size_t STRETCH = 256; // nodes

  std::vector<std::vector<int>> parts_;
  std::vector<std::uint32_t> ends_; // of each node's list in its part
};

} // namespace erkpa
