// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cell_loops.h"
#include "crease_geometry.h"
#include "crease_links.h"

#include <algorithm>
#include <cstddef>

namespace erkpa
{

/** \brief Tells where triangles between the crease vertices of loops would fold over: they look away from the normals
 * at their corners. */
class CreaseFolds
{
public:
  CreaseFolds (const LargeVector<CellLoop> &loops, const CreaseLinks &links, const SurfaceVertices &vertices)
      : loops_ (loops), links_ (links), vertices_ (vertices)
  {
  }

  /** \brief Whether both triangles at the crease edge through the side \a pair of a loop look away. */
  bool
  isReversed (const VertexPair &pair, std::size_t loop) const
  {
    const std::vector<int> &ring = loops_[loop].ring;
    const auto first = std::find (ring.begin (), ring.end (), pair.first) - ring.begin ();
    const bool is_forward = ring[static_cast<std::size_t> (first + 1) % ring.size ()] == pair.second;
    const auto [a, b] = is_forward ? pair : VertexPair (pair.second, pair.first);
    const int c = links_.center (loop), d = links_.next (loop, a, b);
    return looksAway (a, d, c, normal (a)) && looksAway (b, c, d, normal (b));
  }

  /** \brief Whether a triangle of a loop looks away. */
  bool
  isFolded (std::size_t loop) const
  {
    const std::vector<int> &ring = loops_[loop].ring;
    const int c = links_.center (loop);
    for (std::size_t i = 0; i < ring.size (); ++i)
    {
      const int a = ring[i], b = ring[(i + 1) % ring.size ()];
      const int d = links_.next (loop, a, b);
      const bool folded = d < 0 ? looksAway (a, b, c, normal (a) + normal (b))
                                : looksAway (a, d, c, normal (a)) || looksAway (b, c, d, normal (b));
      if (folded)
        return true;
    }
    return false;
  }

private:
  bool
  looksAway (int a, int b, int c, const Eigen::Vector3d &normal) const
  {
    return erkpa::looksAway ({a, b, c}, normal, vertices_);
  }

  const Eigen::Vector3d &
  normal (int v) const
  {
    return vertices_.normals[static_cast<std::size_t> (v)];
  }

  const LargeVector<CellLoop> &loops_;
  const CreaseLinks &links_;
  const SurfaceVertices &vertices_;
};

} // namespace erkpa
