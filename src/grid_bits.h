// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sparse_grid.h"

#include <array>
#include <cstdint>

namespace erkpa
{

/** \brief Sets of nodes or cells of a block as bits, moved by one step along an axis. */
namespace grid_bits
{

constexpr int SHIFT[3] = {1, 4, 16};
constexpr std::uint64_t FIRST[3] = {0x1111111111111111u, 0x000f000f000f000fu, 0xffffu}; ///< coordinate 0
constexpr std::uint64_t LAST[3] = {FIRST[0] << 3, FIRST[1] << 12, FIRST[2] << 48};      ///< coordinate 3

/** \brief Those that stay in the block when all move up. */
inline std::uint64_t
up (std::uint64_t bits, int axis)
{
  return (bits & ~LAST[axis]) << SHIFT[axis];
}

/** \brief Those that come into the block above. */
inline std::uint64_t
intoAbove (std::uint64_t bits, int axis)
{
  return (bits & LAST[axis]) >> 3 * SHIFT[axis];
}

inline std::uint64_t
down (std::uint64_t bits, int axis)
{
  return (bits & ~FIRST[axis]) >> SHIFT[axis];
}

inline std::uint64_t
intoBelow (std::uint64_t bits, int axis)
{
  return (bits & FIRST[axis]) << 3 * SHIFT[axis];
}

/** \brief The corners of cells: per block above (itself first) the nodes in it. */
inline std::array<std::uint64_t, 8>
cornersOf (std::uint64_t cells, int axes = 7)
{
  std::array<std::uint64_t, 8> nodes{cells};
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t block = 0; block < (std::size_t (1) << axis) && (axes >> axis & 1) != 0; ++block)
    {
      nodes[block | std::size_t (1) << axis] = intoAbove (nodes[block], axis);
      nodes[block] |= up (nodes[block], axis);
    }
  return nodes;
}

/** \brief What a set of nodes, given in a block and those above, says of each corner of the block's cells. */
inline std::array<std::uint64_t, 8>
atCorners (std::array<std::uint64_t, 8> nodes)
{
  // Axis after axis the blocks' places in the array become places of corners.
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < 8; ++i)
    {
      const std::size_t above = i | std::size_t (1) << axis;
      if (i != above)
        nodes[above] = down (nodes[i], axis) | intoBelow (nodes[above], axis);
    }
  return nodes;
}

/** \brief The octants of a block one after the other, each with one before it that shares a face with it. */
constexpr std::array<std::uint64_t, 8>
octants ()
{
  constexpr std::uint64_t FIRST_OCTANT = 0x330033u;
  std::array<std::uint64_t, 8> octants{};
  for (unsigned i = 0; i < 8; ++i)
  {
    const unsigned place = i ^ i >> 1; // Gray code
    octants[i] =
        FIRST_OCTANT << ((place & 1) * 2 * SHIFT[0] + (place >> 1 & 1) * 2 * SHIFT[1] + (place >> 2) * 2 * SHIFT[2]);
  }
  return octants;
}

constexpr std::array<std::uint64_t, 8> OCTANTS = octants ();

} // namespace grid_bits

} // namespace erkpa
