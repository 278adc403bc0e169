// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_packing.h"
#include "lane_vector.h"
#include "lanes.h"

namespace erkpa::lanes
{

/** \brief SmoothnessTest::areLinked () with a neighbour in each lane; see Engine::linkSmooth. */
template <typename B>
class LaneLinks
{
public:
  LaneLinks (const Smoothness &smoothness, const float *node) : smoothness_ (smoothness)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      position_[a] = B (node[a]);
      normal_[a] = B (node[3 + a]);
    }
  }

  std::size_t
  link (const Table &nodes, std::size_t count, float most, float close, std::uint32_t *linked, bool &has_others) const
  {
    const B yes (0.0f), no (-1.0f);
    std::size_t kept = 0, others = 0;
    for (std::size_t first = 0; first < count; first += B::size)
    {
      const std::size_t left = count - first;
      B squared;
      const auto do_fit = fit (nodes, first, left, squared);
      const Packing<B> links (xsimd::select (do_fit && squared <= B (most), yes, no), left);
      links.packNumbers (first, linked + kept);
      kept += links.size ();
      const B not_linked = xsimd::select (do_fit, no, yes);
      others += Packing<B> (xsimd::select (squared <= B (close), not_linked, no), left).size ();
    }
    has_others = others > 0;
    return kept;
  }

private:
  auto
  fit (const Table &nodes, std::size_t first, std::size_t left, B &squared) const
  {
    B way[3], normal[3], sum[3];
    for (std::size_t a = 0; a < 3; ++a)
    {
      way[a] = Packing<B>::load (nodes.columns[a] + first, left) - position_[a];
      normal[a] = Packing<B>::load (nodes.columns[3 + a] + first, left);
      sum[a] = normal[a] + normal_[a];
    }
    squared = dot (way, way);
    const B step = B (0.5f) * xsimd::abs (dot (way, sum));
    const auto is_near = squared <= B (smoothness_.squared_reach);
    const B bend = xsimd::select (is_near, B (smoothness_.bend), B (smoothness_.far_bend));
    const B cosine = xsimd::select (is_near, B (smoothness_.cosine), B (smoothness_.far_cosine));
    return dot (normal_, normal) >= cosine && (step <= B (smoothness_.chord) || step * step <= bend * bend * squared);
  }

  const Smoothness &smoothness_;
  B position_[3], normal_[3];
};

/** \brief See Engine::linkSmooth. */
template <typename ArchT>
std::size_t
linkSmooth (const Smoothness &smoothness, const Table &nodes, std::size_t count, const float *node, float most,
            float close, std::uint32_t *linked, bool &has_others)
{
  using B = xsimd::batch<float, ArchT>;
  return LaneLinks<B> (smoothness, node).link (nodes, count, most, close, linked, has_others);
}

} // namespace erkpa::lanes
