// SPDX-License-Identifier: BSD-3-Clause
#include "point_grid.h"

#include "threads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace erkpa
{

PointGrid::PointGrid (const std::vector<Eigen::Vector3f> &positions, double cell, int threads)
    : cell_ (cell > 0.0 && std::isfinite (cell) ? cell : 1.0)
{
  spanBulk (positions);
  sortIntoCells (positions, threads);
}

/** \brief The box of nearly all points, with room around it; cells as asked for, or as few as there are points. */
void
PointGrid::spanBulk (const std::vector<Eigen::Vector3f> &positions)
{
  constexpr std::size_t SAMPLE = 4096, STRAY = 64; // one in so many may lie outside, on either side
  constexpr double ROOM = 0.5, MAX_SIDE = 1e6;
  const std::size_t step = std::max<std::size_t> (1, positions.size () / SAMPLE);
  Eigen::Array3d high;
  std::vector<float> values;
  for (int a = 0; a < 3; ++a)
  {
    values.clear ();
    for (std::size_t i = 0; i < positions.size (); i += step)
      values.push_back (positions[i][a]);
    const auto at = [&values] (std::size_t i)
    {
      std::nth_element (values.begin (), values.begin () + static_cast<std::ptrdiff_t> (i), values.end ());
      return static_cast<double> (values[i]);
    };
    const std::size_t stray = values.size () / STRAY;
    const double from = at (stray), to = at (values.size () - 1 - stray), room = ROOM * (to - from) + cell_;
    const auto [lowest, highest] = std::minmax_element (values.begin (), values.end ());
    low_[a] = std::max (from - room, static_cast<double> (*lowest) - cell_);
    high[a] = std::min (to + room, static_cast<double> (*highest) + cell_);
  }
  const auto bricks = [&] { return ((high - low_) / (8.0 * cell_)).floor () + 1.0; };
  const double most = std::max (4096.0, 0.25 * static_cast<double> (positions.size ()));
  while (bricks ().prod () > most || bricks ().maxCoeff () > MAX_SIDE)
    cell_ *= 1.25;
  inverse_ = 1.0 / cell_;
  for (std::size_t a = 0; a < 3; ++a)
  {
    bricks_[a] = static_cast<int> (bricks ()[static_cast<Eigen::Index> (a)]);
    cells_[a] = 8 * bricks_[a];
  }
}

void
PointGrid::sortIntoCells (const std::vector<Eigen::Vector3f> &positions, int threads)
{
  const std::size_t n = positions.size ();
  CellsOfPoints of_points{LargeVector<std::uint32_t> (n), LargeVector<std::uint16_t> (n)};
  parallelRanges (n, threads,
                  [&] (std::size_t first, std::size_t last)
                  {
                    for (std::size_t i = first; i < last; ++i)
                    {
                      const Cell c = cellOf (positions[i].cast<double> ().array ());
                      of_points.bricks[i] = static_cast<std::uint32_t> (brickIndex ({c[0] >> 3, c[1] >> 3, c[2] >> 3}));
                      of_points.cells[i] = static_cast<std::uint16_t> ((c[0] & 7) + 8 * ((c[1] & 7) + 8 * (c[2] & 7)));
                    }
                  });
  slots_.assign (brickIndex ({0, 0, bricks_[2]}), NONE);
  for (const std::uint32_t brick : of_points.bricks)
    slots_[brick] = 0;
  std::uint32_t used = 0;
  for (std::uint32_t &slot : slots_)
    if (slot != NONE)
      slot = used++;
  starts_.resize (std::size_t (512) * used + 1);
  starts_.back () = static_cast<std::uint32_t> (n);
  index_.resize (n);
  sortByBricks (of_points, used, threads);
  for (LargeVector<float> &coordinates : coordinates_)
    coordinates.resize (n);
  parallelRanges (n, threads,
                  [&] (std::size_t first, std::size_t last)
                  {
                    for (std::size_t place = first; place < last; ++place)
                      for (int a = 0; a < 3; ++a)
                        coordinates_[static_cast<std::size_t> (a)][place] = positions[index_[place]][a];
                  });
}

/** \brief Counting sort in two passes: into runs of bricks, which threads then sort one by one, each within a cache.
 *
 * Points of one cell stay in their order.
 */
void
PointGrid::sortByBricks (const CellsOfPoints &of_points, std::size_t used, int threads)
{
  constexpr std::size_t RUNS = 64, STRETCH = 16384;
  const std::size_t n = of_points.bricks.size (), stretches = (n + STRETCH - 1) / STRETCH;
  const std::size_t per_run = used / RUNS + 1;
  std::vector<std::array<std::uint32_t, RUNS>> places (stretches); // how many, then where they go
  const auto visit_stretches = [&] (auto visit)
  {
    parallelRanges (
        n, threads,
        [&] (std::size_t first, std::size_t last)
        {
          auto &of_stretch = places[first / STRETCH];
          for (std::size_t i = first; i < last; ++i)
            visit (i, of_stretch[slots_[of_points.bricks[i]] / per_run]);
        },
        STRETCH);
  };
  for (auto &of_stretch : places)
    of_stretch.fill (0);
  visit_stretches ([] (std::size_t, std::uint32_t &count) { ++count; });
  std::array<std::uint32_t, RUNS + 1> firsts{};
  std::uint32_t sum = 0;
  for (std::size_t run = 0; run < RUNS; ++run)
  {
    for (auto &of_stretch : places)
      sum += std::exchange (of_stretch[run], sum);
    firsts[run + 1] = sum;
  }
  LargeVector<std::uint32_t> order (n);
  visit_stretches ([&order] (std::size_t i, std::uint32_t &place) { order[place++] = static_cast<std::uint32_t> (i); });
  parallelFor (
      RUNS, threads, [] { return 0; },
      [&] (int, std::size_t run)
      {
        const std::size_t first_cell = 512 * std::min (used, run * per_run);
        const std::size_t last_cell = 512 * std::min (used, (run + 1) * per_run);
        sortRun (of_points, order.data () + firsts[run], order.data () + firsts[run + 1], firsts[run],
                 starts_.data () + first_cell, starts_.data () + last_cell);
      });
}

/** \brief Sorts the points of a run of bricks into their cells. \param[in] place of the first of them */
void
PointGrid::sortRun (const CellsOfPoints &of_points, const std::uint32_t *first, const std::uint32_t *last,
                    std::uint32_t place, std::uint32_t *first_cell, std::uint32_t *last_cell)
{
  const auto start_of = [&] (std::uint32_t i) -> std::uint32_t &
  { return starts_[std::size_t (512) * slots_[of_points.bricks[i]] + of_points.cells[i]]; };
  std::fill (first_cell, last_cell, 0);
  for (const std::uint32_t *i = first; i != last; ++i)
    ++start_of (*i);
  std::uint32_t sum = place;
  for (std::uint32_t *start = first_cell; start != last_cell; ++start)
    sum += std::exchange (*start, sum);
  for (const std::uint32_t *i = first; i != last; ++i)
    index_[start_of (*i)++] = *i;
  if (first_cell == last_cell)
    return;
  std::copy_backward (first_cell, last_cell - 1, last_cell); // each start has moved to the next one
  *first_cell = place;
}

bool
PointGrid::hasWithin (const Eigen::Vector3d &x, double radius) const
{
  int within = 0;
  const Eigen::Vector3f center = x.cast<float> ();
  const auto limit = static_cast<float> (radius * radius);
  const float *const px = coordinates_[0].data (), *const py = coordinates_[1].data (),
                     *const pz = coordinates_[2].data ();
  visitNear (x, radius,
             [&] (std::size_t first, std::size_t last)
             {
               if (within != 0)
                 return;
               for (std::size_t i = first; i < last; ++i) // no way out, so that several are looked at at once
               {
                 const float dx = px[i] - center[0], dy = py[i] - center[1], dz = pz[i] - center[2];
                 within |= static_cast<int> (dx * dx + dy * dy + dz * dz <= limit);
               }
             });
  return within != 0;
}

std::size_t
PointGrid::nearest (const Eigen::Vector3d &x) const
{
  const Eigen::Vector3f center = x.cast<float> ();
  std::size_t nearest = 0;
  float least = HUGE_VALF;
  const auto look = [&] (std::size_t first, std::size_t last)
  {
    for (std::size_t i = first; i < last; ++i)
    {
      const Eigen::Vector3f p (coordinates_[0][i], coordinates_[1][i], coordinates_[2][i]);
      if (const float squared = (p - center).squaredNorm (); squared < least)
      {
        least = squared;
        nearest = i;
      }
    }
  };
  double looked_within = 0.0;
  for (double reach = 0.5 * cell_; !(std::sqrt (least) <= looked_within); reach *= 2.0)
  {
    visitNear (x, reach, look);
    looked_within = reach;
  }
  return nearest;
}

void
PointGrid::findWithin (const Eigen::Vector3d &center, double radius, Places &found) const
{
  found.stretches.clear ();
  std::size_t most = lanes::MAX_WIDTH;
  visitNear (center, radius,
             [&] (std::size_t first, std::size_t last)
             {
               found.stretches.push_back ({static_cast<std::uint32_t> (first), static_cast<std::uint32_t> (last)});
               most += last - first;
             });
  found.places.resize (std::max (found.places.size (), most));
  found.squared.resize (found.places.size ());
  const lanes::Cloud cloud{coordinates_[0].data (), coordinates_[1].data (), coordinates_[2].data ()};
  const Eigen::Vector3f middle = center.cast<float> ();
  found.count = lanes::bestEngine ().search->findWithin (cloud, found.stretches.data (), found.stretches.size (),
                                                         middle.data (), static_cast<float> (radius * radius),
                                                         {found.places.data (), found.squared.data ()});
}

/** \brief Kept, for there are many small queries. */
PointGrid::Places &
PointGrid::placesOfThread ()
{
  thread_local Places places;
  return places;
}

void
PointGrid::withinRadius (const Eigen::Vector3d &x, double radius, std::vector<int> &indices,
                         std::vector<float> &squared_distances) const
{
  Places &found = placesOfThread ();
  findWithin (x, radius, found);
  indices.resize (found.count);
  for (std::size_t i = 0; i < found.count; ++i)
    indices[i] = static_cast<int> (index_[found.places[i]]);
  squared_distances.assign (found.squared.begin (), found.squared.begin () + static_cast<std::ptrdiff_t> (found.count));
}

} // namespace erkpa
