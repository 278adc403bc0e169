// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lanes/lanes.h"
#include "point_grid.h"

#include <erkpa/oriented_points.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief The nodes around a few that lie close together, as arrays: quicker than a search for each. */
class NearbyNodes
{
public:
  /** \param[in] grid over the positions of \a points */
  NearbyNodes (const OrientedPoints &points, const PointGrid &grid) : points_ (points), grid_ (grid) {}

  /** \brief The end of a run of places, from \a first on, that lie close together; \a last at most. */
  std::size_t
  endOfRun (std::size_t first, std::size_t last) const;

  /** \brief Calls visit (first, last) for the runs from a place on. */
  template <typename VisitT>
  void
  visitRuns (std::size_t first, std::size_t last, VisitT visit) const
  {
    for (std::size_t end = first; first < last; first = end)
    {
      end = endOfRun (first, last);
      visit (first, end);
    }
  }

  /** \brief A ball that holds a run. */
  void
  findBall (std::size_t first, std::size_t last, Eigen::Vector3d &center, double &radius) const;

  /** \brief Take all nodes within \a reach of any place of a run, in the order of the grid, and some farther ones. */
  void
  gather (std::size_t first, std::size_t last, double reach);

  std::size_t
  size () const
  {
    return found_.count;
  }

  int
  node (std::size_t i) const
  {
    return nodeAt (found_.places[i]);
  }

  /** \brief Their positions and normals. */
  lanes::Table
  table () const
  {
    lanes::Table table{};
    for (std::size_t c = 0; c < columns_.size (); ++c)
      table.columns[c] = columns_[c].data ();
    return table;
  }

  int
  nodeAt (std::size_t place) const
  {
    return static_cast<int> (grid_.index ()[place]);
  }

private:
  void
  copyColumns ();

  Eigen::Vector3f
  positionAt (std::size_t place) const
  {
    return {grid_.coordinates (0)[place], grid_.coordinates (1)[place], grid_.coordinates (2)[place]};
  }

  const OrientedPoints &points_;
  const PointGrid &grid_;
  PointGrid::Places found_;
  std::array<std::vector<float>, lanes::Table::COLUMNS> columns_;
};

} // namespace erkpa
