// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

namespace erkpa
{

/** \brief Sets of numbers that grow together. */
class DisjointSets
{
public:
  explicit DisjointSets (std::size_t size) : parents_ (size)
  {
    std::iota (parents_.begin (), parents_.end (), 0);
  }

  int
  find (int i)
  {
    while (parent (i) != i)
    {
      parent (i) = parent (parent (i));
      i = parent (i);
    }
    return i;
  }

  /** \brief The same; shortens no ways, so that several threads may ask. */
  int
  findFrom (int i) const
  {
    while (parents_[static_cast<std::size_t> (i)] != i)
      i = parents_[static_cast<std::size_t> (i)];
    return i;
  }

  /** \brief The smaller representative stays, so that the result does not depend on the order. */
  void
  unite (int a, int b)
  {
    a = find (a);
    b = find (b);
    parent (a < b ? b : a) = a < b ? a : b;
  }

private:
  int &
  parent (int i)
  {
    return parents_[static_cast<std::size_t> (i)];
  }

  std::vector<int> parents_;
};

} // namespace erkpa
