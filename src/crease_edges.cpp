// SPDX-License-Identifier: BSD-3-Clause
#include "crease_edges.h"

#include "crease_folds.h"
#include "crease_geometry.h"
#include "crease_links.h"
#include "mesh_intersections.h"
#include "parallel_collect.h"
#include "threads.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <set>
#include <utility>

namespace erkpa
{

namespace
{

using Triangle = std::array<int, 3>;

/** \brief Decides which loops keep their crease vertex and which crossings become crease edges. */
class CreaseBuilder
{
public:
  CreaseBuilder (double voxel, const LargeVector<CellLoop> &loops, const std::vector<MeshedLoop> &meshed, int threads,
                 LargeVector<Triangle> &triangles, SurfaceVertices &vertices)
      : voxel_ (voxel), threads_ (threads), loops_ (loops), meshed_ (meshed), triangles_ (triangles),
        vertices_ (vertices), before_loops_ (triangles.size ()), links_ (loops.size ()),
        folds_ (loops, links_, vertices)
  {
  }

  std::vector<VertexPair>
  build ()
  {
    for (std::size_t i = 0; i < loops_.size (); ++i)
      if (meshed_[i].has_center)
        links_.add (i, appendVertex (meshed_[i]), meshed_[i].crossings);
    links_.join ();
    sortVertices ();
    do
    {
      while (dropFolded ())
        continue;
      meshLoops ();
    } while (untangle ());
    makeMiddles ();
    return {links_.edges ().begin (), links_.edges ().end ()};
  }

private:
  int
  appendVertex (const MeshedLoop &loop)
  {
    const int center = static_cast<int> (vertices_.positions.size ());
    vertices_.positions.push_back (loop.position);
    vertices_.normals.push_back (loop.normal);
    vertices_.border_offsets.push_back (loop.border_offset);
    vertices_.faces.push_back (loop.face);
    vertices_.side_keys.push_back (0);
    vertices_.attributes.insert (vertices_.attributes.end (), loop.attributes.begin (), loop.attributes.end ());
    return center;
  }

  /** \brief Exchanges neighbours whose vertices stand along their crease the other way round than their loops do. */
  void
  sortVertices ()
  {
    constexpr int ROUNDS = 3; // few stand farther off than one place
    bool changed = true;
    for (int round = 0; round < ROUNDS && changed; ++round)
    {
      changed = false;
      for (const auto &[pair, of] : links_.joined ())
        if (isAlong (of.first) && isAlong (of.second) && folds_.isReversed (pair, of.first))
        {
          const auto one = static_cast<std::size_t> (links_.center (of.first));
          const auto other = static_cast<std::size_t> (links_.center (of.second));
          std::swap (vertices_.positions[one], vertices_.positions[other]);
          std::swap (vertices_.normals[one], vertices_.normals[other]);
          changed = true;
        }
    }
  }

  /** \brief Whether a single crease runs through a loop, so that its vertex may stand anywhere along it. */
  bool
  isAlong (std::size_t loop) const
  {
    return meshed_[loop].crossings.size () == 2;
  }

  const Eigen::Vector3d &
  normal (int v) const
  {
    return vertices_.normals[static_cast<std::size_t> (v)];
  }

  /** \brief The loops for which \a is_listed holds, in their order. */
  template <typename IsListedT>
  std::vector<std::size_t>
  listLoops (IsListedT is_listed) const
  {
    constexpr std::size_t STRETCH = 256;
    return parallelCollect<std::vector<std::size_t>> (
        loops_.size (), threads_,
        [&] (std::size_t first, std::size_t last, std::vector<std::size_t> &listed)
        {
          for (std::size_t loop = first; loop < last; ++loop)
            if (is_listed (loop))
              listed.push_back (loop);
        },
        STRETCH);
  }

  /** \brief Gives up the crease vertices of loops that fold over; false where none does. */
  bool
  dropFolded ()
  {
    links_.join ();
    const std::vector<std::size_t> folded =
        listLoops ([this] (std::size_t loop) { return links_.has (loop) && folds_.isFolded (loop); });
    for (const std::size_t loop : folded)
      links_.giveUp (loop);
    return !folded.empty ();
  }

  /** \brief Undoes what brought triangles to pass through each other: vertices outside the cells they were found for.
   * False where none do, which vertices inside their cells cannot; else the loops are to be meshed again. */
  bool
  untangle ()
  {
    if (loops_.empty () && vertices_.found.empty ())
      return false;
    const auto owner_of = [&] (std::size_t t) { return t < before_loops_ ? -1 : owners_[t - before_loops_]; };
    const std::vector<int> suspects = findSuspects ();
    if (suspects.empty ())
      return false;
    std::set<int> touched; // one change in a place at a time: it may be enough
    const auto is_touched = [&touched] (int v) { return touched.count (v) > 0; };
    for (const auto &[one, other] : findIntersections (vertices_.positions, triangles_, suspects, voxel_, threads_))
    {
      const auto t = static_cast<std::size_t> (one), u = static_cast<std::size_t> (other);
      const Triangle &first = triangles_[t], &second = triangles_[u];
      if (std::any_of (first.begin (), first.end (), is_touched) ||
          std::any_of (second.begin (), second.end (), is_touched))
        continue;
      if (!giveUpCrease (owner_of (t), owner_of (u)) && !putBackFarthest (first, second, vertices_))
        continue;
      touched.insert (first.begin (), first.end ());
      touched.insert (second.begin (), second.end ());
    }
    return !touched.empty ();
  }

  /** \brief Triangles with vertices outside of the cells they were found for. */
  std::vector<int>
  findSuspects () const
  {
    std::vector<char> is_outside (vertices_.positions.size (), 0);
    for (std::size_t v = 0; v < vertices_.found.size (); ++v)
      is_outside[v] = vertices_.found[v] != vertices_.positions[v] ? 1 : 0;
    for (const std::size_t loop :
         listLoops ([this] (std::size_t i)
                    { return links_.has (i) && !isInsideCell (links_.center (i), loops_[i], voxel_, vertices_); }))
      is_outside[static_cast<std::size_t> (links_.center (loop))] = 1;
    const std::size_t start = vertices_.found.empty () ? before_loops_ : 0;
    return parallelCollect<std::vector<int>> (
        triangles_.size () - start, threads_,
        [&] (std::size_t first, std::size_t last, std::vector<int> &suspects)
        {
          for (std::size_t t = start + first; t < start + last; ++t)
            if (std::any_of (triangles_[t].begin (), triangles_[t].end (),
                             [&] (int v) { return is_outside[static_cast<std::size_t> (v)] != 0; }))
              suspects.push_back (static_cast<int> (t));
        });
  }

  /** \brief Appends the triangles of all loops, and for now no more than the positions of vertices in their middles. */
  void
  meshLoops ()
  {
    triangles_.resize (before_loops_);
    vertices_.positions.resize (vertices_.normals.size ());
    owners_.clear ();
    with_middle_.clear ();
    constexpr std::size_t STRETCH = 256;
    std::vector<std::size_t> counts (loops_.size (), 0);
    std::vector<LargeVector<Triangle>> parts ((loops_.size () + STRETCH - 1) / STRETCH);
    parallelFor (
        parts.size (), threads_, [] { return 0; },
        [&] (int, std::size_t p)
        {
          for (std::size_t i = p * STRETCH; i < std::min (loops_.size (), (p + 1) * STRETCH); ++i)
          {
            const std::size_t before = parts[p].size ();
            if (links_.has (i))
              addCreaseFan (i, parts[p]);
            else
              triangulateCell (loops_[i], vertices_, parts[p]);
            counts[i] = parts[p].size () - before;
          }
        });
    for (const LargeVector<Triangle> &part : parts)
      triangles_.insert (triangles_.end (), part.begin (), part.end ());
    for (std::size_t i = 0; i < loops_.size (); ++i)
    {
      owners_.resize (owners_.size () + counts[i], links_.has (i) ? static_cast<int> (i) : -1);
      if (counts[i] == 0)
        with_middle_.push_back (i);
    }
    for (const std::size_t i : with_middle_)
    {
      addFan (loops_[i].ring, static_cast<int> (vertices_.positions.size ()), triangles_);
      vertices_.positions.push_back (middleOf (loops_[i].ring));
    }
    owners_.resize (triangles_.size () - before_loops_, -1);
  }

  /** \brief Of two loops (< 0: none), the one whose crease vertex lies farther off loses it; false where one has
   * already, or there is none. */
  bool
  giveUpCrease (int one, int other)
  {
    const auto is_given_up = [this] (int loop) { return loop >= 0 && !links_.has (static_cast<std::size_t> (loop)); };
    if (is_given_up (one) || is_given_up (other) || std::max (one, other) < 0)
      return false;
    const bool is_first = other < 0 || (one >= 0 && offsetOf (one) > offsetOf (other));
    links_.giveUp (static_cast<std::size_t> (is_first ? one : other));
    return true;
  }

  /** \brief How far the crease vertex of a loop is from its middle. */
  double
  offsetOf (int loop) const
  {
    const auto place = static_cast<std::size_t> (loop);
    const Eigen::Vector3d &position = vertices_.positions[static_cast<std::size_t> (links_.center (place))];
    return (position - middleOf (loops_[place].ring)).norm ();
  }

  void
  addCreaseFan (std::size_t loop, LargeVector<Triangle> &triangles) const
  {
    const std::vector<int> &ring = loops_[loop].ring;
    const int c = links_.center (loop);
    for (std::size_t i = 0; i < ring.size (); ++i)
    {
      const int a = ring[i], b = ring[(i + 1) % ring.size ()];
      const int d = links_.next (loop, a, b);
      if (d < 0)
        triangles.push_back ({a, b, c});
      else // the other loop sees b, a and adds the other half
        triangles.push_back ({a, d, c});
    }
  }

  Eigen::Vector3d
  middleOf (const std::vector<int> &ring) const
  {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero ();
    for (const int v : ring)
      middle += vertices_.positions[static_cast<std::size_t> (v)] / static_cast<double> (ring.size ());
    return middle;
  }

  /** \brief What is missing of the vertices in the middle of loops. */
  void
  makeMiddles ()
  {
    vertices_.positions.resize (vertices_.normals.size ());
    for (const std::size_t loop : with_middle_)
      appendMiddle (loop);
  }

  void
  appendMiddle (std::size_t loop)
  {
    const std::vector<int> &ring = loops_[loop].ring;
    MeshedLoop middle = meshed_[loop];
    middle.position = middleOf (ring);
    middle.normal.setZero ();
    for (const int v : ring)
      middle.normal += normal (v);
    middle.normal.normalize ();
    const auto first = static_cast<std::size_t> (ring[0]);
    const std::size_t channels = vertices_.attributes.size () / vertices_.positions.size ();
    const auto from = vertices_.attributes.begin () + static_cast<std::ptrdiff_t> (first * channels);
    middle.attributes.assign (from, from + static_cast<std::ptrdiff_t> (channels));
    middle.border_offset = vertices_.border_offsets[first];
    middle.face = vertices_.faces[first];
    appendVertex (middle);
  }

  double voxel_;
  int threads_;
  const LargeVector<CellLoop> &loops_;
  const std::vector<MeshedLoop> &meshed_;
  LargeVector<Triangle> &triangles_;
  SurfaceVertices &vertices_;
  const std::size_t before_loops_; // triangles
  std::vector<int> owners_;        // per triangle of loops the one whose crease vertex it has; -1 for none
  std::vector<std::size_t> with_middle_;
  CreaseLinks links_;
  const CreaseFolds folds_;
};

} // namespace

std::vector<VertexPair>
addCreases (double voxel, const LargeVector<CellLoop> &loops, const std::vector<MeshedLoop> &meshed, int threads,
            LargeVector<Triangle> &triangles, SurfaceVertices &vertices)
{
  return CreaseBuilder (voxel, loops, meshed, threads, triangles, vertices).build ();
}

} // namespace erkpa
