// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "threads.h"

#include <atomic>
#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief Sets of numbers that grow together, from several threads at once.
 *
 * The smallest number stands for its set, so that the result does not depend on the order in which sets are united.
 */
class ConcurrentSets
{
public:
  explicit ConcurrentSets (std::size_t size, int threads) : parents_ (size)
  {
    parallelRanges (size, threads,
                    [this] (std::size_t first, std::size_t last)
                    {
                      for (std::size_t i = first; i < last; ++i)
                        parents_[i].store (static_cast<int> (i), std::memory_order_relaxed);
                    });
  }

  int
  find (int i)
  {
    int above = parent (i);
    while (above != i)
    {
      const int next = parent (above);
      if (next != above)
        set (i, next); // no root: any number above it in its tree will do
      i = above;
      above = next;
    }
    return i;
  }

  void
  unite (int a, int b)
  {
    if (parent (a) == parent (b))
      return;
    for (;;)
    {
      a = find (a);
      b = find (b);
      if (a == b)
        return;
      int high = a > b ? a : b;
      const int low = a > b ? b : a;
      if (parents_[static_cast<std::size_t> (high)].compare_exchange_weak (high, low, std::memory_order_relaxed))
        return;
    }
  }

private:
  int
  parent (int i) const
  {
    return parents_[static_cast<std::size_t> (i)].load (std::memory_order_relaxed);
  }

  void
  set (int i, int above)
  {
    parents_[static_cast<std::size_t> (i)].store (above, std::memory_order_relaxed);
  }

  std::vector<std::atomic<int>> parents_; // none is larger than its place
};

} // namespace erkpa
