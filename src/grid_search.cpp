// SPDX-License-Identifier: BSD-3-Clause
//
// The nearest points of a grid, and the search by it.
#include "point_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

namespace erkpa
{

namespace
{

class GridSearch : public NeighborSearch
{
public:
  explicit GridSearch (std::shared_ptr<const PointGrid> grid) : grid_ (std::move (grid)) {}

  void
  nearestK (const Eigen::Vector3f &x, int k, std::vector<int> &indices,
            std::vector<float> &squared_distances) const override
  {
    thread_local std::vector<std::pair<float, int>> found;
    grid_->nearestK (x.cast<double> (), k, found);
    store (found, indices, squared_distances);
  }

  void
  withinRadius (const Eigen::Vector3f &x, double radius, std::vector<int> &indices,
                std::vector<float> &squared_distances) const override
  {
    grid_->withinRadius (x.cast<double> (), radius, indices, squared_distances);
  }

  bool
  hasOrder () const override
  {
    return true;
  }

private:
  static void
  store (const std::vector<std::pair<float, int>> &found, std::vector<int> &indices, std::vector<float> &squared)
  {
    indices.clear ();
    squared.clear ();
    for (const auto &[distance, index] : found)
    {
      squared.push_back (distance);
      indices.push_back (index);
    }
  }

  std::shared_ptr<const PointGrid> grid_;
};

} // namespace

void
PointGrid::nearestK (const Eigen::Vector3d &x, int k, std::vector<std::pair<float, int>> &found) const
{
  constexpr double EVERYWHERE = 1e18; // its square is still a float
  // Of a cell's side, times √k: a ball of half the points, about, tells how dense they are here. Two searches in small
  // balls were measured to be quicker than one in a ball that is large enough nearly everywhere. The query before was
  // close by, mostly: a ball a little larger than it needed will do.
  constexpr double FIRST = 0.17, MARGIN = 1.2, MORE_THAN_LAST = 1.1, LIKE_LAST = 8.0;
  const auto wanted = std::min (static_cast<std::size_t> (k), size ());
  Places &ball = placesOfThread ();
  const double first = FIRST * cell_ * std::sqrt (static_cast<double> (k)), last = MORE_THAN_LAST * ball.last_reach;
  double reach = ball.last_k == k && last > first / LIKE_LAST && last < first * LIKE_LAST ? last : first;
  for (findWithin (x, reach, ball); ball.count < wanted && reach < EVERYWHERE; findWithin (x, reach, ball))
  {
    const double share = static_cast<double> (wanted) / std::max (1.0, static_cast<double> (ball.count));
    reach *= std::clamp (MARGIN * std::sqrt (share), 1.3, 4.0);
  }
  ball.last_k = k;
  ball.last_reach = std::sqrt (static_cast<double> (takeNearest (wanted, ball, found)));
}

/** \brief Of the points in a ball those that are nearest, in the order of the grid, however large the ball is.
 * \return squared distance of the farthest of them
 */
float
PointGrid::takeNearest (std::size_t wanted, Places &ball, std::vector<std::pair<float, int>> &found) const
{
  found.clear ();
  float farthest = HUGE_VALF;
  if (wanted > 0 && wanted <= ball.count)
  {
    ball.selection.assign (ball.squared.begin (), ball.squared.begin () + static_cast<std::ptrdiff_t> (ball.count));
    const auto kth = ball.selection.begin () + static_cast<std::ptrdiff_t> (wanted - 1);
    std::nth_element (ball.selection.begin (), kth, ball.selection.end ());
    farthest = *kth;
  }
  for (std::size_t i = 0; i < ball.count; ++i)
    if (ball.squared[i] <= farthest)
      found.emplace_back (ball.squared[i], static_cast<int> (index_[ball.places[i]]));
  if (found.size () > wanted) // some are as far as the k-th
  {
    std::nth_element (found.begin (), found.begin () + static_cast<std::ptrdiff_t> (wanted), found.end ());
    found.resize (wanted);
  }
  return farthest;
}

NeighborSearch::ConstPtr
makeGridSearch (std::shared_ptr<const PointGrid> grid)
{
  return std::make_shared<GridSearch> (std::move (grid));
}

} // namespace erkpa
