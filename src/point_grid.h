// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lanes/lanes.h"

#include <erkpa/large_pages.h>
#include <erkpa/neighbor_search.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief Points sorted into the cells of a grid: what lies in a ball is found as stretches of arrays.
 *
 * Two levels, so that memory goes with the points: bricks of 8 x 8 x 8 cells, of which only those with points have
 * cells. The grid spans the bulk of the cloud; stray points beyond belong to its outermost cells.
 */
class PointGrid
{
public:
  PointGrid () = default;

  /** \param[in] positions any; copied
   * \param[in] cell side of a cell, about the radius of the balls that are asked for; it is widened where the grid
   * would outgrow the points
   */
  PointGrid (const std::vector<Eigen::Vector3f> &positions, double cell, int threads);

  double
  cell () const
  {
    return cell_;
  }

  std::size_t
  size () const
  {
    return index_.size ();
  }

  /** \brief The points in the order of the grid: place -> index among those given, and coordinates. */
  const LargeVector<std::uint32_t> &
  index () const
  {
    return index_;
  }

  const LargeVector<float> &
  coordinates (int axis) const
  {
    return coordinates_[static_cast<std::size_t> (axis)];
  }

  /** \brief Calls visit (first, last) for stretches of places, in ascending order, that hold all points within \a reach
   * of \a center. */
  template <typename VisitT>
  void
  visitNear (const Eigen::Vector3d &center, double reach, VisitT visit) const
  {
    const Cell low = cellOf (center.array () - reach), high = cellOf (center.array () + reach);
    Cell brick{};
    for (brick[2] = low[2] >> 3; brick[2] <= high[2] >> 3; ++brick[2])
      for (brick[1] = low[1] >> 3; brick[1] <= high[1] >> 3; ++brick[1])
        for (brick[0] = low[0] >> 3; brick[0] <= high[0] >> 3; ++brick[0])
        {
          const std::uint32_t slot = slots_[brickIndex (brick)];
          if (slot != NONE)
            visitBrick (brick, &starts_[std::size_t (512) * slot], low, high, visit);
        }
  }

  /** \brief Whether there is a point within \a radius of \a x. */
  bool
  hasWithin (const Eigen::Vector3d &x, double radius) const;

  /** \brief The place of the point nearest to \a x; there must be one, and \a x be finite. */
  std::size_t
  nearest (const Eigen::Vector3d &x) const;

  /** \brief The \a k points nearest to \a x with their squared distances, in no order; fewer where there are fewer. */
  void
  nearestK (const Eigen::Vector3d &x, int k, std::vector<std::pair<float, int>> &found) const;

  /** \brief What findWithin () finds, and needs for it; kept from query to query. */
  struct Places
  {
    std::size_t count = 0;
    std::vector<std::uint32_t> places; ///< the first \a count of them
    std::vector<float> squared;        ///< their squared distances from the center
    std::vector<lanes::Stretch> stretches;
    std::vector<float> selection; ///< scratch memory of nearestK (): squared distances
    int last_k = 0;               ///< what it was asked for before
    double last_reach = 0.0;      ///< and how far the k-th was
  };

  /** \brief The places of all points within \a radius of \a center, in ascending order. */
  void
  findWithin (const Eigen::Vector3d &center, double radius, Places &found) const;

  /** \brief All points within \a radius of \a x, in the order of the grid. */
  void
  withinRadius (const Eigen::Vector3d &x, double radius, std::vector<int> &indices,
                std::vector<float> &squared_distances) const;

private:
  using Cell = std::array<int, 3>;
  static constexpr std::uint32_t NONE = 0xffffffffu;

  Cell
  cellOf (const Eigen::Array3d &x) const
  {
    Cell cell;
    for (int a = 0; a < 3; ++a)
    {
      const double c = (x[a] - low_[a]) * inverse_;
      const auto i = static_cast<std::size_t> (a);
      cell[i] = c > 0.0 ? (c < cells_[i] ? static_cast<int> (c) : cells_[i] - 1) : 0;
    }
    return cell;
  }

  std::size_t
  brickIndex (const Cell &brick) const
  {
    return static_cast<std::size_t> (brick[0]) +
           static_cast<std::size_t> (bricks_[0]) *
               (static_cast<std::size_t> (brick[1]) +
                static_cast<std::size_t> (bricks_[1]) * static_cast<std::size_t> (brick[2]));
  }

  template <typename VisitT>
  void
  visitBrick (const Cell &brick, const std::uint32_t *starts, const Cell &low, const Cell &high, VisitT &visit) const
  {
    Cell from{}, to{};
    for (std::size_t a = 0; a < 3; ++a)
    {
      from[a] = std::max (low[a] - 8 * brick[a], 0);
      to[a] = std::min (high[a] - 8 * brick[a], 7);
    }
    for (int z = from[2]; z <= to[2]; ++z)
      for (int y = from[1]; y <= to[1]; ++y)
      {
        const int row = 8 * (y + 8 * z);
        const std::uint32_t first = starts[row + from[0]], last = starts[row + to[0] + 1];
        if (first < last)
          visit (static_cast<std::size_t> (first), static_cast<std::size_t> (last));
      }
  }

  static Places &
  placesOfThread ();

  float
  takeNearest (std::size_t wanted, Places &ball, std::vector<std::pair<float, int>> &found) const;

  void
  spanBulk (const std::vector<Eigen::Vector3f> &positions);

  /** \brief The brick of each point, and its cell there. */
  struct CellsOfPoints
  {
    LargeVector<std::uint32_t> bricks;
    LargeVector<std::uint16_t> cells;
  };

  void
  sortIntoCells (const std::vector<Eigen::Vector3f> &positions, int threads);

  void
  sortByBricks (const CellsOfPoints &of_points, std::size_t used, int threads);

  void
  sortRun (const CellsOfPoints &of_points, const std::uint32_t *first, const std::uint32_t *last, std::uint32_t place,
           std::uint32_t *first_cell, std::uint32_t *last_cell);

  double cell_ = 1.0, inverse_ = 1.0;
  Eigen::Array3d low_ = Eigen::Array3d::Zero ();
  Cell cells_{}, bricks_{};
  LargeVector<std::uint32_t> slots_;  // per brick
  LargeVector<std::uint32_t> starts_; // per cell of the bricks that have points
  LargeVector<std::uint32_t> index_;
  std::array<LargeVector<float>, 3> coordinates_;
};

/** \brief A search by a grid: quick to make and to ask near the points. */
NeighborSearch::ConstPtr
makeGridSearch (std::shared_ptr<const PointGrid> grid);

} // namespace erkpa
