// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/large_pages.h>

#include <array>
#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief The triangles of an oriented mesh with what lies across their sides.
 *
 * Half-edge 3 t + i runs along the side of triangle t from its vertex i to the next one; its twin is that of the
 * neighbouring triangle, -1 on the border.
 */
class HalfEdges
{
public:
  enum class Place : char
  {
    INSIDE,
    BORDER,
    TANGLED ///< several borders meet in the vertex
  };

  HalfEdges (LargeVector<std::array<int, 3>> &&triangles, std::size_t vertex_count, int threads);

  HalfEdges (const HalfEdges &) = delete;
  HalfEdges &
  operator= (const HalfEdges &) = delete;

  static int
  next (int h)
  {
    return h % 3 == 2 ? h - 2 : h + 1;
  }

  static int
  previous (int h)
  {
    return h % 3 == 0 ? h + 2 : h - 1;
  }

  int
  start (int h) const
  {
    return corners_[h];
  }

  int
  end (int h) const
  {
    return start (next (h));
  }

  int
  twin (int h) const
  {
    return twins_[static_cast<std::size_t> (h)];
  }

  bool
  isAlive (int h) const
  {
    return start (h) >= 0;
  }

  Place
  place (int v) const
  {
    return places_[static_cast<std::size_t> (v)];
  }

  bool
  onCrease (int h) const
  {
    return !creases_.empty () && creases_[static_cast<std::size_t> (h)] != 0;
  }

  void
  setCrease (int h, bool crease);

  /** \brief The half-edge between two vertices, in either direction; -1 where there is none. */
  int
  between (int a, int b) const;

  /** \brief Visit the half-edges that start at a vertex, counter-clockwise. */
  template <typename VisitT>
  void
  around (int v, VisitT visit) const
  {
    const int first = outgoing (v);
    int h = first;
    while (h >= 0)
    {
      visit (h);
      h = twin (previous (h));
      if (h == first)
        break;
    }
  }

  /** \brief Visit a vertex and its neighbours. */
  template <typename VisitT>
  void
  visitNeighbors (int v, VisitT visit) const
  {
    visit (v);
    around (v,
            [&] (int h)
            {
              visit (end (h));
              if (twin (previous (h)) < 0)
                visit (start (previous (h)));
            });
  }

  /** \brief Whether the mesh stays a manifold of the same topology, and its border the same, by collapse (h). */
  bool
  canCollapse (int h) const;

  /** \brief Move the start of a half-edge into its end: two triangles vanish. */
  void
  collapse (int h);

  /** \brief Join the vertices across an edge instead of its own. */
  void
  flip (int h);

  std::size_t
  triangleCount () const
  {
    return triangles_.size ();
  }

  /** \brief Give up the triangles that are left, in the order of their half-edges. */
  LargeVector<std::array<int, 3>>
  release ();

private:
  void
  setStart (int h, int v)
  {
    corners_[h] = v;
  }

  int
  outgoing (int v) const
  {
    return outgoing_[static_cast<std::size_t> (v)];
  }

  void
  setOutgoing (int v, int h)
  {
    outgoing_[static_cast<std::size_t> (v)] = h;
  }

  void
  pair (int h, int other, bool crease);

  void
  findTwins (int threads);

  void
  pairSides (int v, const std::vector<int> &sides);

  void
  findOutgoing (int threads);

  LargeVector<std::array<int, 3>> triangles_; // vertices -1 where a triangle has vanished
  int *corners_;                              // of the triangles, one after the other
  LargeVector<int> twins_;
  LargeVector<char> creases_; // per half-edge; empty where there are none
  LargeVector<int> outgoing_; // per vertex a half-edge that starts there: on the border the first one; -1 if none does
  LargeVector<Place> places_;
};

} // namespace erkpa
