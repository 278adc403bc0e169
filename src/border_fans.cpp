// SPDX-License-Identifier: BSD-3-Clause
#include "border.h"

#include "parallel_collect.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

namespace erkpa
{

namespace
{

using Triangle = std::array<int, 3>;

/** \brief A corner of a triangle. */
struct Corner
{
  std::size_t triangle;
  std::size_t corner;
};

/** \brief The corners of triangles at each vertex of the border. */
class CornersAtBorder
{
public:
  CornersAtBorder (const LargeVector<int> &border, std::size_t vertex_count, int threads,
                   const LargeVector<Triangle> &triangles)
  {
    std::vector<char> on_border (vertex_count, 0);
    for (const int v : border)
      on_border[static_cast<std::size_t> (v)] = 1;
    LargeVector<int> numbers (vertex_count);
    for (std::size_t v = 0; v < vertex_count; ++v)
      if (on_border[v] != 0)
      {
        numbers[v] = static_cast<int> (vertices_.size ());
        vertices_.push_back (static_cast<int> (v));
      }
    const LargeVector<std::size_t> touching = findTouching (on_border, threads, triangles);
    const auto visit = [&] (auto take)
    {
      for (const std::size_t t : touching)
        for (std::size_t c = 0; c < 3; ++c)
          if (const auto v = static_cast<std::size_t> (triangles[t][c]); on_border[v] != 0)
            take (static_cast<std::size_t> (numbers[v]), Corner{t, c});
    };
    firsts_.assign (vertices_.size () + 1, 0);
    visit ([&] (std::size_t number, Corner) { ++firsts_[number + 1]; });
    std::partial_sum (firsts_.begin (), firsts_.end (), firsts_.begin ());
    corners_.resize (firsts_.back ());
    std::vector<std::size_t> next (firsts_.begin (), firsts_.end () - 1);
    visit ([&] (std::size_t number, Corner corner) { corners_[next[number]++] = corner; });
  }

  std::size_t
  vertexCount () const
  {
    return vertices_.size ();
  }

  int
  vertex (std::size_t i) const
  {
    return vertices_[i];
  }

  const Corner *
  begin (std::size_t i) const
  {
    return corners_.data () + firsts_[i];
  }

  const Corner *
  end (std::size_t i) const
  {
    return corners_.data () + firsts_[i + 1];
  }

private:
  std::vector<int> vertices_;
  std::vector<std::size_t> firsts_;
  std::vector<Corner> corners_;
};

/** \brief A corner of another fan than the one that keeps a vertex. */
struct ExtraFan
{
  int vertex, fan;
  std::size_t triangle, corner;
};

/** \brief Tell the fans at a vertex apart: triangles that share edges there. The first corner's keeps the vertex. */
void
findExtraFans (const CornersAtBorder &corners, std::size_t i, const LargeVector<Triangle> &triangles,
               std::vector<int> &fans, LargeVector<ExtraFan> &found)
{
  const Corner *const begin = corners.begin (i);
  const int count = static_cast<int> (corners.end (i) - begin);
  const auto vertexBeside = [&] (int c, std::size_t step)
  { return triangles[begin[c].triangle][(begin[c].corner + step) % 3]; };
  fans.resize (static_cast<std::size_t> (count));
  std::iota (fans.begin (), fans.end (), 0);
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < a; ++b)
      if (vertexBeside (a, 1) == vertexBeside (b, 2) || vertexBeside (a, 2) == vertexBeside (b, 1))
      {
        const int one = std::min (fans[a], fans[b]), other = std::max (fans[a], fans[b]);
        std::replace (fans.begin (), fans.end (), other, one);
      }
  for (int fan = 1; fan < count; ++fan)
    for (int c = 0; c < count; ++c)
      if (fans[c] == fan)
        found.push_back ({corners.vertex (i), fan, begin[c].triangle, begin[c].corner});
}

} // namespace

void
splitFans (const LargeVector<int> &border, int threads, LargeVector<Triangle> &triangles, SurfaceVertices &vertices)
{
  if (border.empty ())
    return;
  const CornersAtBorder corners (border, vertices.positions.size (), threads, triangles);
  const auto extra =
      parallelCollect<LargeVector<ExtraFan>> (corners.vertexCount (), threads,
                                              [&] (std::size_t first, std::size_t last, LargeVector<ExtraFan> &found)
                                              {
                                                std::vector<int> fans;
                                                for (std::size_t i = first; i < last; ++i)
                                                  findExtraFans (corners, i, triangles, fans, found);
                                              });
  std::size_t copy = 0;
  for (std::size_t e = 0; e < extra.size (); ++e)
  {
    const bool is_new = e == 0 || extra[e].vertex != extra[e - 1].vertex || extra[e].fan != extra[e - 1].fan;
    if (is_new)
    {
      copy = vertices.positions.size ();
      vertices.append (static_cast<std::size_t> (extra[e].vertex));
    }
    triangles[extra[e].triangle][extra[e].corner] = static_cast<int> (copy);
  }
}

} // namespace erkpa
