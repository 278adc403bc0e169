// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sparse_grid.h"

#include <array>

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

/** \brief Whether two edges of a cell lie in one of its faces. */
bool
shareFace (int edge, int other);

/** \brief The closed polygons in which a surface crosses the cell: edges in order, counter-clockwise from outside. */
struct CellLoops
{
  int count = 0;
  std::array<int, 4> lengths{};               ///< edges per loop
  std::array<std::array<int, 12>, 4> edges{}; ///< the edges of each loop
};

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
