// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sparse_grid.h"

#include <array>
#include <cstdint>

namespace erkpa
{

/** \brief An edge of a cell: edge 4 a + i runs along axis a from its lower corner. */
struct CellEdge
{
  int corner; ///< lower end
  int axis;
};

CellEdge
cellEdge (int edge);

/** \brief The face of a cell that holds two of its edges: 2 a is the lower one across axis a, 2 a + 1 the upper one;
 * -1 where none does. */
int
commonFace (int edge, int other);

/** \brief Edges of a cell along a loop. */
using LoopEdges = std::array<std::uint8_t, 12>;

/** \brief The closed polygons in which a surface crosses the cell: edges in order, counter-clockwise from outside. */
struct CellLoops
{
  std::uint8_t count = 0;
  std::array<std::uint8_t, 4> lengths{}; ///< edges per loop
  std::array<LoopEdges, 4> edges{};      ///< the edges of each loop
};

/** \brief The loops of a cell with some corners inside, as bits; null where their values have to tell them. */
const CellLoops *
loopsOfSigns (std::size_t inside);

/** \brief Trace the loops through the faces of a cell.
 *
 * On a face with two opposite corners inside, the saddle of the bilinear interpolant decides which corners are
 * joined. It depends on the face's four values only, so that the two cells of a face agree and the surface has no
 * cracks.
 * \param[in] values f - iso at the corners, none NaN; negative is inside
 */
CellLoops
traceLoops (const std::array<double, 8> &values);

} // namespace erkpa
