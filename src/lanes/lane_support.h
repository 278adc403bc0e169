// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_search.h"

namespace erkpa::lanes
{

/** \brief One evaluation point in each lane, and the nodes within its support. See Support. */
template <typename B>
class LaneSupport
{
public:
  static constexpr std::size_t WIDTH = B::size;

  LaneSupport (const Settings &settings, const Nodes &nodes, const Points &points, std::size_t first,
               const Scratch &scratch)
      : nodes_ (nodes), list_ (scratch.list), rows_ (scratch.rows), k_ (static_cast<float> (settings.k)),
        is_limited_ (settings.limited), x_{B::load_unaligned (points.x + first), B::load_unaligned (points.y + first),
                                           B::load_unaligned (points.z + first)},
        radius_ (B::load_unaligned (points.radius + first))
  {
    kth_ = radius_ * radius_;
    if (settings.k > 0)
      findNearest (B::load_unaligned (points.guess + first));
    else
    {
      listWithin (nodes.count);
      is_listed_ = true;
    }
    inverse_ = B (1.0f) / radius_;
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
    return is_listed_ ? listed_ : nodes_.count;
  }

  std::size_t
  node (std::size_t i) const
  {
    return is_listed_ ? list_[i] : i;
  }

  /** \brief x_i - x and its square. */
  B
  offset (std::size_t node, B *d) const
  {
    d[0] = B (nodes_.x[node]) - x_[0];
    d[1] = B (nodes_.y[node]) - x_[1];
    d[2] = B (nodes_.z[node]) - x_[2];
    return xsimd::fma (d[2], d[2], xsimd::fma (d[1], d[1], d[0] * d[0]));
  }

  /** \brief ∇ε where it is the distance to the k-th node.
   * \param[in,out] gradient stays where ε is the limit
   */
  void
  radiusGradient (B *gradient) const
  {
    for (int a = 0; a < 3; ++a)
      gradient[a] = xsimd::select (at_limit_ > B (0.5f), gradient[a], B (0.0f));
    auto is_found = at_limit_ > B (0.5f);
    for (std::size_t i = 0; i < listed_; ++i)
    {
      B d[3];
      const B squared = offset (list_[i], d);
      const auto is_kth = (squared >= kth_) && !is_found && B (list_[i] < nodes_.on_surface ? 1.0f : 0.0f) > B (0.5f) &&
                          squared <= kth_;
      for (int a = 0; a < 3; ++a)
        gradient[a] = xsimd::select (is_kth, -d[a] * inverse_, gradient[a]);
      is_found = is_found || is_kth;
    }
  }

private:
  /** \brief Lists those of the first \a count value points that may lie within the bounds of some lane.
   *
   * Those within a ball around all of them: for once the lanes are nodes, for there are many more of these.
   */
  void
  listWithin (std::size_t count)
  {
    float middle[3], reach = 0.0f;
    findBall (middle, reach);
    const B limit (reach * reach);
    listed_ = 0;
    for (std::size_t first = 0; first < count; first += WIDTH)
    {
      const B dx = B::load_unaligned (nodes_.x + first) - B (middle[0]);
      const B dy = B::load_unaligned (nodes_.y + first) - B (middle[1]);
      const B dz = B::load_unaligned (nodes_.z + first) - B (middle[2]);
      const B margin = limit - xsimd::fma (dz, dz, xsimd::fma (dy, dy, dx * dx));
      listed_ += appendWhere (margin, first, count - first, list_ + listed_);
    }
  }

  /** \brief The squared distances of the listed nodes, a row for each. */
  void
  measureDistances ()
  {
    for (std::size_t i = 0; i < listed_; ++i)
    {
      B d[3];
      offset (list_[i], d).store_unaligned (rows_ + WIDTH * i);
    }
  }

  /** \brief A ball that holds those around the points with the bounds as radii. */
  void
  findBall (float *middle, float &reach) const
  {
    float points[3][WIDTH], bounds[WIDTH];
    radius_.store_unaligned (bounds);
    for (int a = 0; a < 3; ++a)
    {
      x_[a].store_unaligned (points[a]);
      float low = points[a][0], high = low;
      for (std::size_t i = 1; i < WIDTH; ++i)
      {
        low = points[a][i] < low ? points[a][i] : low;
        high = points[a][i] > high ? points[a][i] : high;
      }
      middle[a] = 0.5f * (low + high);
    }
    for (std::size_t i = 0; i < WIDTH; ++i)
    {
      float squared = 0.0f;
      for (int a = 0; a < 3; ++a)
        squared += (points[a][i] - middle[a]) * (points[a][i] - middle[a]);
      const float needed = (bounds[i] + __builtin_sqrtf (squared)) * (1.0f + 1e-5f);
      reach = needed > reach ? needed : reach;
    }
  }

  B
  row (std::size_t i) const
  {
    return B::load_unaligned (rows_ + WIDTH * i);
  }

  /** \brief How many of the rows are at most \a squared.
   *
   * In four sums, since one would wait for itself.
   */
  B
  countWithin (B squared) const
  {
    const B one (1.0f);
    B counts[4] = {B (0.0f), B (0.0f), B (0.0f), B (0.0f)};
    const auto add = [&] (std::size_t i, B &count) { count = xsimd::select (row (i) <= squared, count + one, count); };
    std::size_t i = 0;
    for (; i + 4 <= listed_; i += 4)
      for (std::size_t j = 0; j < 4; ++j)
        add (i + j, counts[j]);
    for (; i < listed_; ++i)
      add (i, counts[0]);
    return (counts[0] + counts[1]) + (counts[2] + counts[3]);
  }

  /** \brief ε = distance to the k-th node, from a bound of it and a guess.
   *
   * The number of nodes within a distance grows about as its square. The bounds close in on a square within which there
   * are just k; where distances are equal there is none, and single steps from node to node find the k-th.
   */
  void
  findNearest (B guess)
  {
    constexpr int STEPS = 10, EVEN = 5;
    B low (0.0f), high = radius_ * radius_ * B (1.0f + 1e-5f);
    listWithin (nodes_.on_surface);
    measureDistances ();
    B in_low (0.0f), in_high = countWithin (high);
    B middle = xsimd::min (guess * guess, high);
    const B k (k_);
    for (int step = 0; step < STEPS && xsimd::any (in_high > k); ++step)
    {
      const B count = countWithin (middle);
      const auto enough = count >= k;
      high = xsimd::select (enough, middle, high);
      in_high = xsimd::select (enough, count, in_high);
      low = xsimd::select (enough, low, middle);
      in_low = xsimd::select (enough, in_low, count);
      const B share = step < EVEN ? (k + B (0.4f) - in_low) / xsimd::max (in_high - in_low, B (1.0f)) : B (0.5f);
      middle = xsimd::fma (share, high - low, low);
      middle = xsimd::select (in_high > k, middle, high);
    }
    kth_ = largestWithin (high);
    if (!is_limited_)
      short_ = xsimd::select (in_high < k, B (1.0f), B (0.0f));
    else
    {
      at_limit_ = xsimd::select (in_high < k, B (1.0f), B (0.0f));
      kth_ = xsimd::select (in_high < k, radius_ * radius_, kth_);
    }
    if (xsimd::any (in_high > k))
      stepToKth (low, in_low, in_high > k);
    radius_ = xsimd::sqrt (kth_);
    shorten ();
  }

  B
  largestWithin (B bound) const
  {
    B largest (0.0f), others (0.0f);
    const auto take = [&] (std::size_t i, B &most)
    { most = xsimd::select (row (i) <= bound, xsimd::max (most, row (i)), most); };
    std::size_t i = 0;
    for (; i + 2 <= listed_; i += 2)
    {
      take (i, largest);
      take (i + 1, others);
    }
    if (i < listed_)
      take (i, largest);
    return xsimd::max (largest, others);
  }

  template <typename MaskT>
  void
  stepToKth (B low, B in_low, MaskT open)
  {
    const B k (k_), far (3e38f);
    auto searching = open;
    low = xsimd::select (in_low > B (0.5f), low, B (-1.0f));
    for (std::size_t step = 0; step <= listed_ && xsimd::any (searching); ++step)
    {
      B next = far;
      for (std::size_t i = 0; i < listed_; ++i)
        next = xsimd::min (next, xsimd::select (row (i) > low, row (i), far));
      const auto reached = countWithin (next) >= k;
      kth_ = xsimd::select (searching && reached, next, kth_);
      searching = searching && !reached;
      low = next;
    }
  }

  /** \brief Keeps in the list what lies in the support of any lane, and adds the off-surface points. */
  void
  shorten ()
  {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < listed_; ++i)
    {
      list_[kept] = list_[i];
      kept += xsimd::any (row (i) <= kth_) ? 1 : 0; // the k-th itself is asked for again
    }
    for (std::size_t i = nodes_.on_surface; i < nodes_.count; ++i)
    {
      B d[3];
      list_[kept] = static_cast<std::uint32_t> (i);
      kept += xsimd::any (offset (i, d) < kth_) ? 1 : 0;
    }
    listed_ = kept;
    is_listed_ = true;
  }

  const Nodes &nodes_;
  std::uint32_t *list_;
  float *rows_;
  std::size_t listed_ = 0;
  bool is_listed_ = false;
  float k_;
  bool is_limited_;
  B x_[3];
  B radius_, inverse_, kth_;
  B at_limit_ = B (0.0f); // 1 where ε is Points::radius
  B short_ = B (0.0f);    // 1 where it is beyond
};

} // namespace erkpa::lanes
