// SPDX-License-Identifier: BSD-3-Clause
#include "border.h"

#include "mesh_graph.h"
#include "parallel_collect.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace erkpa
{

namespace
{

using Triangle = std::array<int, 3>;

/** \brief The vertices to cut away: beyond the limit, and connected to the border through such vertices. */
std::vector<char>
findBeyondBorder (double limit, int threads, const LargeVector<int> &border, const LargeVector<Triangle> &triangles,
                  const LargeVector<double> &offsets)
{
  std::vector<char> beyond (offsets.size (), 0);
  parallelRanges (offsets.size (), threads,
                  [&] (std::size_t first, std::size_t last)
                  {
                    for (std::size_t v = first; v < last; ++v)
                      beyond[v] = offsets[v] <= limit ? 0 : 1;
                  });
  const auto is_beyond = [&beyond] (int v) { return beyond[static_cast<std::size_t> (v)] != 0; };
  if (std::none_of (border.begin (), border.end (), is_beyond))
    return {};
  DisjointSets regions (offsets.size ());
  for (const std::size_t index : findTouching (beyond, threads, triangles))
    for (std::size_t i = 0; i < 3; ++i)
    {
      const int a = triangles[index][i], b = triangles[index][(i + 1) % 3];
      if (is_beyond (a) && is_beyond (b))
        regions.unite (a, b);
    }
  std::vector<char> is_open (offsets.size (), 0);
  for (const int v : border)
    if (is_beyond (v))
      is_open[static_cast<std::size_t> (regions.find (v))] = 1;
  for (std::size_t v = 0; v < offsets.size (); ++v)
    beyond[v] = beyond[v] && is_open[static_cast<std::size_t> (regions.find (static_cast<int> (v)))];
  return beyond;
}

/** \brief Clips triangles along the line where the border offset has the limit. */
class Clipper
{
public:
  Clipper (const std::vector<char> &beyond, const LargeVector<Triangle> &triangles)
      : beyond_ (beyond), triangles_ (triangles)
  {
  }

  /** \brief Put a vertex on each edge that the line crosses, where two of these triangles have it or one. */
  void
  cutEdges (double limit, const LargeVector<std::size_t> &touching, int threads, SurfaceVertices &vertices)
  {
    cuts_ = parallelCollect<LargeVector<std::uint64_t>> (
        touching.size (), threads,
        [&] (std::size_t first, std::size_t last, LargeVector<std::uint64_t> &found)
        {
          for (std::size_t t = first; t < last; ++t)
            for (std::size_t i = 0; i < 3; ++i)
            {
              const int here = triangles_[touching[t]][i], next = triangles_[touching[t]][(i + 1) % 3];
              if (isBeyond (here) != isBeyond (next))
                found.push_back (isBeyond (here) ? keyOf (next, here) : keyOf (here, next));
            }
        });
    std::sort (cuts_.begin (), cuts_.end ());
    cuts_.erase (std::unique (cuts_.begin (), cuts_.end ()), cuts_.end ());
    first_new_ = vertices.positions.size ();
    for (const std::uint64_t cut : cuts_)
      vertices.positions.push_back (positionOn (limit, cut, vertices));
  }

  /** \brief What is left of the triangles whose edges were cut. */
  LargeVector<Triangle>
  clipAll (const LargeVector<std::size_t> &touching, int threads, const SurfaceVertices &vertices) const
  {
    return parallelCollect<LargeVector<Triangle>> (
        touching.size (), threads,
        [&] (std::size_t first, std::size_t last, LargeVector<Triangle> &kept)
        {
          for (std::size_t t = first; t < last; ++t)
            clip (triangles_[touching[t]], vertices, kept);
        });
  }

private:
  void
  clip (const Triangle &triangle, const SurfaceVertices &vertices, LargeVector<Triangle> &kept) const
  {
    std::array<int, 4> polygon{};
    std::size_t size = 0;
    for (std::size_t i = 0; i < 3; ++i)
    {
      const int here = triangle[i], next = triangle[(i + 1) % 3];
      if (!isBeyond (here))
        polygon[size++] = here;
      if (isBeyond (here) != isBeyond (next))
        polygon[size++] = vertexOn (isBeyond (here) ? keyOf (next, here) : keyOf (here, next));
    }
    const auto length = [&] (std::size_t a, std::size_t b)
    {
      return (vertices.positions[static_cast<std::size_t> (polygon[a])] -
              vertices.positions[static_cast<std::size_t> (polygon[b])])
          .squaredNorm ();
    };
    if (size == 3)
      kept.push_back ({polygon[0], polygon[1], polygon[2]});
    if (size != 4)
      return;
    if (length (0, 2) <= length (1, 3))
      kept.insert (kept.end (), {{polygon[0], polygon[1], polygon[2]}, {polygon[0], polygon[2], polygon[3]}});
    else
      kept.insert (kept.end (), {{polygon[1], polygon[2], polygon[3]}, {polygon[1], polygon[3], polygon[0]}});
  }

  bool
  isBeyond (int v) const
  {
    return beyond_[static_cast<std::size_t> (v)] != 0;
  }

  static std::uint64_t
  keyOf (int inner, int outer)
  {
    return static_cast<std::uint64_t> (inner) << 32 | static_cast<std::uint32_t> (outer);
  }

  int
  vertexOn (std::uint64_t cut) const
  {
    const auto place = std::lower_bound (cuts_.begin (), cuts_.end (), cut) - cuts_.begin ();
    return static_cast<int> (first_new_ + static_cast<std::size_t> (place));
  }

  static Eigen::Vector3d
  positionOn (double limit, std::uint64_t cut, const SurfaceVertices &vertices)
  {
    const auto inner = static_cast<std::size_t> (cut >> 32), outer = static_cast<std::size_t> (cut & 0xffffffffu);
    const double room = limit - vertices.border_offsets[inner],
                 span = vertices.border_offsets[outer] - vertices.border_offsets[inner];
    const double t = std::clamp (span > 0.0 ? room / span : 0.5, 0.05, 0.95); // no slivers
    return (1.0 - t) * vertices.positions[inner] + t * vertices.positions[outer];
  }

  const std::vector<char> &beyond_;
  const LargeVector<Triangle> &triangles_;
  LargeVector<std::uint64_t> cuts_; // edges from inside to beyond, sorted
  std::size_t first_new_ = 0;       // vertex on the first of them
};

} // namespace

LargeVector<std::size_t>
findTouching (const std::vector<char> &marks, int threads, const LargeVector<Triangle> &triangles)
{
  const auto is_marked = [&marks] (int v) { return marks[static_cast<std::size_t> (v)] != 0; };
  return parallelCollect<LargeVector<std::size_t>> (
      triangles.size (), threads,
      [&] (std::size_t first, std::size_t last, LargeVector<std::size_t> &found)
      {
        for (std::size_t i = first; i < last; ++i)
          if (std::any_of (triangles[i].begin (), triangles[i].end (), is_marked))
            found.push_back (i);
      });
}

void
trimBorder (double limit, int threads, LargeVector<int> &border, LargeVector<Triangle> &triangles,
            SurfaceVertices &vertices)
{
  if (border.empty ())
    return;
  const std::vector<char> beyond = findBeyondBorder (limit, threads, border, triangles, vertices.border_offsets);
  if (beyond.empty ())
    return;
  const std::size_t first_new = vertices.positions.size ();
  const LargeVector<std::size_t> touching = findTouching (beyond, threads, triangles);
  Clipper clipper (beyond, triangles);
  clipper.cutEdges (limit, touching, threads, vertices);
  const LargeVector<Triangle> clipped = clipper.clipAll (touching, threads, vertices);
  std::size_t kept = touching.front ();
  for (std::size_t t = 0; t < touching.size (); ++t)
  {
    const std::size_t end = t + 1 < touching.size () ? touching[t + 1] : triangles.size ();
    for (std::size_t i = touching[t] + 1; i < end; ++i)
      triangles[kept++] = triangles[i];
  }
  triangles.resize (kept);
  triangles.insert (triangles.end (), clipped.begin (), clipped.end ());
  border.erase (std::remove_if (border.begin (), border.end (),
                                [&beyond] (int v) { return beyond[static_cast<std::size_t> (v)] != 0; }),
                border.end ());
  for (std::size_t v = first_new; v < vertices.positions.size (); ++v)
    border.push_back (static_cast<int> (v));
}

} // namespace erkpa
