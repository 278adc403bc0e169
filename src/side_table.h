// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/large_pages.h>

#include <array>
#include <cstddef>

namespace erkpa
{

/** \brief The sides of triangles by the smaller vertex of each.
 *
 * Side 3 t + i runs along triangle t from its vertex i to the next one.
 */
class SideTable
{
public:
  SideTable (const LargeVector<std::array<int, 3>> &triangles, std::size_t vertex_count, int threads);

  /** \brief The sides whose smaller vertex is \a v, in their order. */
  const int *
  begin (std::size_t v) const
  {
    return sides_.data () + firsts_[v];
  }

  const int *
  end (std::size_t v) const
  {
    return sides_.data () + firsts_[v + 1];
  }

private:
  LargeVector<int> firsts_; // per vertex: where its sides begin
  LargeVector<int> sides_;
};

} // namespace erkpa
