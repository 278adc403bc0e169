// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_list.h"
#include "lane_nearest.h"

#include <algorithm>
#include <cmath>

namespace erkpa::lanes
{

/** \brief One evaluation point in each lane, and the nodes within its support. See Support. */
template <typename B>
class LaneSupport
{
public:
  static constexpr std::size_t WIDTH = B::size;
  static constexpr std::size_t NORMAL = 3, LAMBDA = 6, CONFIDENCE = 7; // columns

  /** \brief Take up the points of some lanes. Where ε is the distance to the k-th node, one support takes up vector
   * after vector, and knows from those before what to expect. \param[in] first place of the evaluation point in the
   * first lane
   */
  void
  moveTo (const Settings &settings, const Nodes &nodes, const Points &points, std::size_t first, const Scratch &scratch)
  {
    nodes_ = &nodes;
    list_.setUp (nodes, scratch);
    rows_ = scratch.rows;
    k_ = static_cast<float> (settings.k);
    is_limited_ = settings.limited;
    const float *const positions[] = {points.x, points.y, points.z};
    for (int a = 0; a < 3; ++a)
      x_[a] = B::load_unaligned (positions[a] + first);
    radius_ = B::load_unaligned (points.radius + first);
    kth_ = radius_ * radius_;
    at_limit_ = short_ = B (0.0f);
    if (settings.k > 0)
      findNearest (B::load_unaligned (points.guess + first));
    inverse_ = B (1.0f) / radius_;
  }

  /** \brief List the nodes that may lie in the support of a lane, the same for all of some supports; for one at a time
   * where ε is the distance to the k-th node. */
  static void
  listNodes (LaneSupport *supports, std::size_t count)
  {
    if (supports[0].lists_all_)
      supports[0].keepSupporting ();
    else
      supports[0].template listWithin<Scratch::COLUMNS> (supports, count, supports[0].nodes_->count);
    for (std::size_t s = 1; s < count; ++s)
      supports[s].list_ = supports[0].list_;
  }

  /** \brief ε. */
  B
  radius () const
  {
    return radius_;
  }

  /** \brief Where ε is beyond Points::radius. */
  auto
  isShort () const
  {
    return short_ > B (0.5f);
  }

  /** \brief ε², as the distances of nodes are compared with. */
  B
  squaredRadius () const
  {
    return kth_;
  }

  /** \brief 1/ε. */
  B
  inverse () const
  {
    return inverse_;
  }

  /** \brief Number of nodes to visit: with those in the supports of some lanes others, of no weight. */
  std::size_t
  size () const
  {
    return list_.size ();
  }

  std::size_t
  node (std::size_t i) const
  {
    return list_.node (i);
  }

  /** \brief An array of what the nodes to visit have: see Scratch; null where none has it. */
  const float *
  near (std::size_t column) const
  {
    return list_.near (column);
  }

  /** \brief x_i - x of the i-th node to visit, and its square. */
  [[gnu::always_inline]] B
  offset (std::size_t i, B *d) const
  {
    for (std::size_t a = 0; a < 3; ++a)
      d[a] = B (list_.near (a)[i]) - x_[a];
    return squaredLength (d);
  }

  B
  x (int axis) const
  {
    return x_[axis];
  }

  /** \brief |x_i - x|² of N nodes from the i-th to visit on. */
  template <std::size_t N>
  [[gnu::always_inline]] void
  distances (std::size_t i, B *squared) const
  {
    for (std::size_t n = 0; n < N; ++n)
    {
      B d[3];
      squared[n] = offset (i + n, d);
    }
  }

  /** \brief How many of the nodes to visit, the first ones, lie on the surface. */
  std::size_t
  onSurface () const
  {
    return list_.onSurface ();
  }

  /** \brief The first node at a squared distance; zero where there is none. */
  B
  nodeAt (B squared) const
  {
    B node (0.0f);
    for (std::size_t i = onSurface (); i-- > 0;)
    {
      B found;
      distances<1> (i, &found);
      node = xsimd::select (found == squared, B (static_cast<float> (list_.node (i))), node);
    }
    return node;
  }

  /** \brief ∇ε where it is the distance to the k-th node.
   * \param[in,out] gradient stays where ε is the limit
   */
  void
  radiusGradient (B *gradient) const
  {
    float nodes[WIDTH], places[WIDTH];
    nodeAt (kth_).store_unaligned (nodes);
    const float *const positions[] = {nodes_->x, nodes_->y, nodes_->z};
    for (int a = 0; a < 3; ++a)
    {
      for (std::size_t lane = 0; lane < WIDTH; ++lane)
        places[lane] = positions[a][static_cast<std::size_t> (nodes[lane])];
      const B towards = (x_[a] - B::load_unaligned (places)) * inverse_;
      gradient[a] = xsimd::select (at_limit_ > B (0.5f), gradient[a], towards);
    }
  }

private:
  /** \brief More than zero, so that 1/√ of it is finite. */
  static B
  squaredLength (const B *d)
  {
    constexpr float LEAST = 1e-30f;
    return xsimd::fma (d[2], d[2], xsimd::fma (d[1], d[1], xsimd::fma (d[0], d[0], B (LEAST))));
  }

  /** \brief Lists those of the first \a value_points that may lie within the bounds of some lane of some supports. */
  template <std::size_t COLUMNS>
  void
  listWithin (const LaneSupport *supports, std::size_t count, std::size_t value_points)
  {
    float middle[3], reach = 0.0f;
    findBall (supports, count, middle, reach);
    list_.template take<COLUMNS> (middle, reach, value_points);
  }

  /** \brief The squared distances of the listed nodes, a row for each; those beyond a bound in all lanes drop out. */
  void
  measureDistances (B bound)
  {
    // The compiler cannot know that the rows do not lie where these are.
    float *const rows = rows_;
    const float *const near[] = {list_.near (0), list_.near (1), list_.near (2)};
    const B x[] = {x_[0], x_[1], x_[2]};
    list_.keep (
        [&] (std::size_t i, std::size_t kept)
        {
          const B d[] = {B (near[0][i]) - x[0], B (near[1][i]) - x[1], B (near[2][i]) - x[2]};
          const B squared = squaredLength (d);
          squared.store_unaligned (rows + WIDTH * kept);
          return xsimd::any (squared <= bound);
        });
  }

  /** \brief A ball that holds those around the points with the bounds as radii. */
  static void
  findBall (const LaneSupport *supports, std::size_t count, float *middle, float &reach)
  {
    // The middle of the first and the last one, which are far apart where lanes are nodes of a block.
    for (int a = 0; a < 3; ++a)
    {
      float first[WIDTH], last[WIDTH];
      supports[0].x_[a].store_unaligned (first);
      supports[count - 1].x_[a].store_unaligned (last);
      middle[a] = 0.5f * (first[0] + last[WIDTH - 1]);
    }
    B needed (0.0f);
    for (std::size_t i = 0; i < count; ++i)
    {
      const B *const x = supports[i].x_, from[] = {x[0] - B (middle[0]), x[1] - B (middle[1]), x[2] - B (middle[2])};
      needed = xsimd::max (needed, supports[i].radius_ + xsimd::sqrt (squaredLength (from)));
    }
    float reaches[WIDTH];
    (needed * B (1.0f + 1e-5f)).store_unaligned (reaches);
    for (const float one : reaches)
      reach = one > reach ? one : reach;
  }

  /** \brief ε = distance to the k-th node, from a bound of it and a guess.
   *
   * The bound holds anywhere; mostly, what the points before were found to need and a little more does as well.
   */
  void
  findNearest (B guess)
  {
    constexpr float MORE = 1.1f, MORE_THAN_GUESS = 1.25f, ROUNDING = 1e-5f;
    lists_all_ = nodes_->on_surface == nodes_->count;
    const B limit = radius_, k (k_);
    const bool is_first = !(largest_ > 0.0f);
    radius_ = xsimd::min (limit, is_first ? guess * B (MORE_THAN_GUESS) : B (MORE * largest_));
    for (;;)
    {
      const B bound = radius_ * radius_ * B (1.0f + ROUNDING);
      listWithin<3> (this, 1, nodes_->on_surface);
      measureDistances (bound);
      LaneNearest<B> nearest (rows_, size (), k_);
      const B in_bound = nearest.countWithin (bound);
      if (xsimd::any (in_bound < k && radius_ < limit))
      {
        radius_ = limit;
        continue;
      }
      nearest.find (bound, in_bound);
      take (nearest, limit);
      return;
    }
  }

  void
  take (const LaneNearest<B> &nearest, B limit)
  {
    kth_ = nearest.squared ();
    const auto has_fewer = nearest.found () < B (k_);
    if (!is_limited_)
      short_ = xsimd::select (has_fewer, B (1.0f), B (0.0f));
    else
    {
      at_limit_ = xsimd::select (has_fewer, B (1.0f), B (0.0f));
      kth_ = xsimd::select (has_fewer, limit * limit, kth_);
    }
    radius_ = xsimd::sqrt (kth_);
    float squares[WIDTH], largest = 0.0f;
    kth_.store_unaligned (squares);
    for (const float square : squares)
      largest = std::max (largest, square);
    largest_ = std::sqrt (largest);
  }

  /** \brief Of the nodes listed to find the k-th, only those in the support of some lane stay, and the k-th. */
  void
  keepSupporting ()
  {
    const float *const rows = rows_;
    const B kth = kth_;
    list_.keep ([&] (std::size_t i, std::size_t) { return xsimd::any (B::load_unaligned (rows + WIDTH * i) <= kth); });
    list_.fetch ();
  }

  const Nodes *nodes_;
  LaneList<B> list_;
  float *rows_;
  float k_;
  bool is_limited_;
  B x_[3];
  B radius_, inverse_, kth_;
  B at_limit_;             // 1 where ε is Points::radius
  B short_;                // 1 where it is beyond
  bool lists_all_ = false; // the list that was made for the k-th node holds those in the support
  float largest_ = 0.0f;   // ε of the points before, at most
};

} // namespace erkpa::lanes
