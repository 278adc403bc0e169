// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "parallel_collect.h"

#include <erkpa/large_pages.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief Runs jobs that change a mesh from several threads, each in a region of space of its own.
 *
 * Every job has its vertices and changes nothing but triangles at these. It runs among those of its region, in their
 * order, if all neighbours of its vertices lie in there: no other thread then reads what it changes. Jobs on the border
 * of regions wait for regions that lie otherwise, and what is left runs at the end. The result does not depend on the
 * number of threads.
 */
class MeshRegions
{
public:
  /** \param[in] side length of a region */
  MeshRegions (double side, const LargeVector<Eigen::Vector3d> &positions, int threads) : threads_ (threads)
  {
    for (std::size_t layout = 0; layout < LAYOUTS; ++layout)
      regions_[layout].resize (positions.size ());
    parallelRanges (positions.size (), threads,
                    [&] (std::size_t first, std::size_t last)
                    {
                      for (std::size_t layout = 0; layout < LAYOUTS; ++layout)
                        for (std::size_t v = first; v < last; ++v)
                          regions_[layout][v] = regionAt (positions[v] / side, static_cast<double> (layout) / LAYOUTS);
                    });
  }

  /** \brief Run jobs 0 .. count - 1.
   * \param[in] first_vertex first_vertex (job) is a vertex of the job; -1 where there is no need of it any more
   * \param[in] reach reach (job, visit) visits the vertices of a job and their neighbours; none where there is no need
   * of it any more
   * \param[in] before before (a, b) tells which of two jobs runs first, where one has to
   * \param[in] make_worker,work,finish as in parallelFor
   */
  template <typename FirstT, typename ReachT, typename BeforeT, typename MakeWorkerT, typename WorkT, typename FinishT>
  void
  run (std::size_t count, FirstT first_vertex, ReachT reach, BeforeT before, MakeWorkerT make_worker, WorkT work,
       FinishT finish) const
  {
    std::vector<std::uint32_t> jobs (count);
    std::iota (jobs.begin (), jobs.end (), 0u);
    for (const Regions &regions : regions_)
      runInside (regions, first_vertex, reach, before, make_worker, work, finish, jobs);
    std::sort (jobs.begin (), jobs.end (), before);
    auto worker = make_worker ();
    for (const std::uint32_t job : jobs)
      if (isNeeded (job, reach))
        work (worker, job);
    finish (worker);
  }

private:
  using Regions = std::vector<std::uint16_t>; // per vertex

  static constexpr std::size_t LAYOUTS = 2;
  static constexpr int BITS = 4; // of a region's number, along each axis
  static constexpr std::size_t COUNT = std::size_t (1) << 3 * BITS;

  /** \brief A number for the region of a place. They repeat far away: those of one number are one region. */
  static std::uint16_t
  regionAt (const Eigen::Vector3d &place, double shift)
  {
    int region = 0;
    for (int axis = 0; axis < 3; ++axis)
      region = region << BITS | (static_cast<int> (std::floor (place[axis] + shift)) & ((1 << BITS) - 1));
    return static_cast<std::uint16_t> (region);
  }

  template <typename ReachT>
  static bool
  isNeeded (std::uint32_t job, ReachT &reach)
  {
    bool any = false;
    reach (job, [&any] (int) { any = true; });
    return any;
  }

  /** \brief Sort the jobs that are needed by the region of their first vertex.
   * \return where the jobs of each region begin, and one more
   */
  template <typename FirstT>
  std::vector<std::uint32_t>
  sortByRegion (const Regions &regions, FirstT &first_vertex, std::vector<std::uint32_t> &jobs) const
  {
    constexpr std::uint16_t NOWHERE = COUNT; // behind all others
    std::vector<std::uint16_t> places (jobs.size ());
    parallelRanges (jobs.size (), threads_,
                    [&] (std::size_t first, std::size_t last)
                    {
                      for (std::size_t i = first; i < last; ++i)
                      {
                        const int v = first_vertex (jobs[i]);
                        places[i] = v < 0 ? NOWHERE : regions[static_cast<std::size_t> (v)];
                      }
                    });
    std::vector<std::uint32_t> starts (COUNT + 2, 0), sorted (jobs.size ());
    for (const std::uint16_t place : places)
      ++starts[place + std::size_t (1)];
    std::partial_sum (starts.begin (), starts.end (), starts.begin ());
    std::vector<std::uint32_t> ends (starts);
    for (std::size_t i = 0; i < jobs.size (); ++i)
      sorted[ends[places[i]]++] = jobs[i];
    jobs.swap (sorted);
    starts.pop_back ();
    return starts;
  }

  /** \brief Run the jobs inside of regions; those on borders are left. */
  template <typename FirstT, typename ReachT, typename BeforeT, typename MakeWorkerT, typename WorkT, typename FinishT>
  void
  runInside (const Regions &regions, FirstT &first_vertex, ReachT &reach, BeforeT &before, MakeWorkerT &make_worker,
             WorkT &work, FinishT &finish, std::vector<std::uint32_t> &jobs) const
  {
    const std::vector<std::uint32_t> starts = sortByRegion (regions, first_vertex, jobs);
    std::vector<std::size_t> used; // regions
    for (std::size_t region = 0; region < COUNT; ++region)
      if (starts[region] < starts[region + 1])
        used.push_back (region);
    std::vector<std::vector<std::uint32_t>> left (used.size ());
    parallelFor (
        used.size (), threads_, make_worker,
        [&] (auto &worker, std::size_t r)
        {
          const std::size_t region = used[r];
          const auto first = jobs.begin () + starts[region], last = jobs.begin () + starts[region + 1];
          std::sort (first, last, before);
          for (auto job = first; job != last; ++job)
          {
            bool any = false, inside = true;
            reach (*job,
                   [&] (int v)
                   {
                     any = true;
                     inside = inside && regions[static_cast<std::size_t> (v)] == region;
                   });
            if (any && inside)
              work (worker, *job);
            else if (any)
              left[r].push_back (*job);
          }
        },
        finish);
    jobs = joinParts (std::move (left), threads_);
  }

  int threads_;
  std::array<Regions, LAYOUTS> regions_; // the second half a region off the first
};

} // namespace erkpa
