// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "threads.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
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
    ends_.resize (count);
    parts_.assign ((count + STRETCH - 1) / STRETCH, {});
    parallelFor (parts_.size (), threads, make_worker,
                 [&] (auto &worker, std::size_t part)
                 {
                   for (std::size_t i = part * STRETCH; i < std::min (count, (part + 1) * STRETCH); ++i)
                   {
                     append (worker, i, parts_[part]);
                     ends_[i] = static_cast<std::uint32_t> (parts_[part].size ());
                   }
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
