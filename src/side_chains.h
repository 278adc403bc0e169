// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/large_pages.h>

#include <array>
#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief The sides of triangles by the smaller vertex of each, chained up in arrays of the caller's.
 *
 * Side 3 t + i runs along triangle t from its vertex i to the next one.
 */
class SideChains
{
public:
  /** \param[in,out] heads of as many numbers as there are vertices: becomes each one's first side, -1 for none
   * \param[in,out] nexts of as many as there are sides: becomes the one after each, -1 for none
   */
  SideChains (const LargeVector<std::array<int, 3>> &triangles, int threads, LargeVector<int> &heads,
              LargeVector<int> &nexts);

  /** \brief The sides whose smaller vertex is \a v, in their order. */
  void
  list (std::size_t v, std::vector<int> &sides) const
  {
    sides.clear ();
    for (int side = heads_[v]; side >= 0; side = nexts_[static_cast<std::size_t> (side)])
      sides.push_back (side);
  }

private:
  const LargeVector<int> &heads_, &nexts_;
};

} // namespace erkpa
