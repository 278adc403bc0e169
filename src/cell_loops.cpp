// SPDX-License-Identifier: BSD-3-Clause
#include "cell_loops.h"

#include <cstddef>

namespace erkpa
{

namespace
{

using Index = std::size_t;

/** \brief Corners and edges of a face, counter-clockwise seen from outside the cell. */
struct Face
{
  std::array<int, 4> corners;
  std::array<int, 4> edges; // edges[i] joins corners[i] and corners[i + 1]
};

struct CellTables
{
  std::array<CellEdge, 12> edges{};
  std::array<Face, 6> faces{};
  std::array<std::array<int, 12>, 12> common_faces{};

  CellTables ()
  {
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < 4; ++i)
      {
        const int b = 1 << ((axis + 1) % 3), c = 1 << ((axis + 2) % 3);
        edges[4 * Index (axis) + Index (i)] = {(i & 1 ? b : 0) | (i & 2 ? c : 0), axis};
      }
    for (int axis = 0; axis < 3; ++axis)
      for (int high = 0; high < 2; ++high)
        faces[2 * Index (axis) + Index (high)] = makeFace (axis, high != 0);
    for (auto &row : common_faces)
      row.fill (-1);
    for (Index face = 0; face < faces.size (); ++face)
      for (const int e : faces[face].edges)
        for (const int other : faces[face].edges)
          common_faces[Index (e)][Index (other)] = static_cast<int> (face);
  }

private:
  Face
  makeFace (int axis, bool high) const
  {
    const int a = high ? 1 << axis : 0;
    const int b = 1 << ((axis + 1) % 3), c = 1 << ((axis + 2) % 3);
    Face face{{a, high ? a | b : a | c, a | b | c, high ? a | c : a | b}, {}};
    for (Index i = 0; i < 4; ++i)
      face.edges[i] = edgeBetween (face.corners[i], face.corners[(i + 1) % 4]);
    return face;
  }

  int
  edgeBetween (int corner, int other) const
  {
    for (int e = 0; e < 12; ++e)
      if (edges[Index (e)].corner == (corner & other) && (1 << edges[Index (e)].axis) == (corner ^ other))
        return e;
    return -1;
  }
};

const CellTables &
tables ()
{
  static const CellTables cell_tables;
  return cell_tables;
}

/** \brief Link the crossings of one face: next[edge where the way round leaves the outside] = edge where it enters. */
void
linkFace (const Face &face, const std::array<double, 8> &values, std::array<int, 12> &next)
{
  std::array<int, 2> entries{}, exits{};
  Index entry_count = 0, exit_count = 0;
  for (Index i = 0; i < 4; ++i)
  {
    const bool here = values[Index (face.corners[i])] < 0.0;
    const bool there = values[Index (face.corners[(i + 1) % 4])] < 0.0;
    if (here && !there)
      entries[entry_count++] = face.edges[i];
    else if (!here && there)
      exits[exit_count++] = face.edges[i];
  }
  if (exit_count == 1)
    next[Index (exits[0])] = entries[0];
  if (exit_count != 2)
    return;
  // Corner 0 and 2 have one sign, 1 and 3 the other; the saddle's sign is that of the product difference.
  const double even = values[Index (face.corners[0])] * values[Index (face.corners[2])];
  const double odd = values[Index (face.corners[1])] * values[Index (face.corners[3])];
  const bool even_inside = values[Index (face.corners[0])] < 0.0;
  const bool outside_joined = even_inside ? odd > even : even > odd;
  // Going round, exits[i] follows entries[i] if the first corner is inside, else it comes before it.
  const Index own = even_inside ? 0 : 1;
  const Index partner = outside_joined ? 1 - own : own;
  next[Index (exits[0])] = entries[partner];
  next[Index (exits[1])] = entries[1 - partner];
}

} // namespace

CellEdge
cellEdge (int edge)
{
  return tables ().edges[Index (edge)];
}

int
commonFace (int edge, int other)
{
  return tables ().common_faces[Index (edge)][Index (other)];
}

namespace
{

CellLoops
followFaces (const std::array<double, 8> &values)
{
  std::array<int, 12> next;
  next.fill (-1);
  for (const Face &face : tables ().faces)
    linkFace (face, values, next);
  CellLoops loops;
  for (int start = 0; start < 12; ++start)
  {
    if (next[Index (start)] < 0)
      continue;
    const auto loop = Index (loops.count++);
    for (int edge = start; next[Index (edge)] >= 0;)
    {
      loops.edges[loop][Index (loops.lengths[loop]++)] = static_cast<std::uint8_t> (edge);
      const int following = next[Index (edge)];
      next[Index (edge)] = -1;
      edge = following;
    }
  }
  return loops;
}

/** \brief The loops by the corners inside, as bits, where the signs alone tell them. */
struct LoopTable
{
  std::array<CellLoops, 256> loops;
  std::array<bool, 256> is_ambiguous{};

  LoopTable ()
  {
    for (Index inside = 0; inside < 256; ++inside)
    {
      std::array<double, 8> values;
      for (Index corner = 0; corner < 8; ++corner)
        values[corner] = inside >> corner & 1 ? -1.0 : 1.0;
      loops[inside] = followFaces (values);
      const auto is_inside = [&values] (int corner) { return values[Index (corner)] < 0.0; };
      for (const Face &face : tables ().faces)
        is_ambiguous[inside] = is_ambiguous[inside] || (is_inside (face.corners[0]) == is_inside (face.corners[2]) &&
                                                        is_inside (face.corners[1]) == is_inside (face.corners[3]) &&
                                                        is_inside (face.corners[0]) != is_inside (face.corners[1]));
    }
  }
};

} // namespace

const CellLoops *
loopsOfSigns (std::size_t inside)
{
  static const LoopTable table;
  return table.is_ambiguous[inside] ? nullptr : &table.loops[inside];
}

CellLoops
traceLoops (const std::array<double, 8> &values)
{
  Index inside = 0;
  for (Index corner = 0; corner < 8; ++corner)
    inside |= values[corner] < 0.0 ? Index (1) << corner : 0;
  const CellLoops *const loops = loopsOfSigns (inside);
  return loops != nullptr ? *loops : followFaces (values);
}

} // namespace erkpa
