// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "parallel_collect.h"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>
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
  MeshRegions (double side, const std::vector<Eigen::Vector3d> &positions, int threads)
      : scale_ (1.0 / side), positions_ (positions), threads_ (threads)
  {
  }

  /** \brief Run jobs 0 .. count - 1.
   * \param[in] first first (job) is a vertex of the job; -1 where there is no need of it any more
   * \param[in] reach reach (job, visit) visits the vertices of a job and their neighbours; none where there is no need
   * of it any more
   * \param[in] make_worker,work,finish as in parallelFor
   */
  template <typename FirstT, typename ReachT, typename MakeWorkerT, typename WorkT, typename FinishT>
  void
  run (std::size_t count, FirstT first_vertex, ReachT reach, MakeWorkerT make_worker, WorkT work, FinishT finish)
  {
    std::vector<std::uint32_t> jobs (count);
    for (std::size_t i = 0; i < count; ++i)
      jobs[i] = static_cast<std::uint32_t> (i);
    for (const double shift : {0.0, 0.5})
      runInside (shift, first_vertex, reach, make_worker, work, finish, jobs);
    auto worker = make_worker ();
    for (const std::uint32_t job : jobs)
      if (isNeeded (job, reach))
        work (worker, job);
    finish (worker);
  }

private:
  static constexpr std::uint32_t NOWHERE = 0xffffffffu;

  /** \brief A number for the region of a vertex. Two may have the same: they are one region then. */
  std::uint32_t
  regionOf (int v, double shift) const
  {
    const Eigen::Vector3d &p = positions_[static_cast<std::size_t> (v)];
    const auto along = [&] (int axis)
    { return static_cast<std::uint32_t> (static_cast<int> (std::floor (p[axis] * scale_ + shift))); };
    return (along (0) * 73856093u ^ along (1) * 19349663u ^ along (2) * 83492791u) & 0x7fffffffu;
  }

  template <typename ReachT>
  static bool
  isNeeded (std::uint32_t job, ReachT &reach)
  {
    bool any = false;
    reach (job, [&any] (int) { any = true; });
    return any;
  }

  /** \brief Run the jobs inside of regions; those on borders are left. */
  template <typename FirstT, typename ReachT, typename MakeWorkerT, typename WorkT, typename FinishT>
  void
  runInside (double shift, FirstT &first_vertex, ReachT &reach, MakeWorkerT &make_worker, WorkT &work, FinishT &finish,
             std::vector<std::uint32_t> &jobs) const
  {
    std::vector<std::uint64_t> places (jobs.size ()); // region and job
    parallelRanges (jobs.size (), threads_,
                    [&] (std::size_t first, std::size_t last)
                    {
                      for (std::size_t i = first; i < last; ++i)
                      {
                        const int v = first_vertex (jobs[i]);
                        places[i] = std::uint64_t (v < 0 ? NOWHERE : regionOf (v, shift)) << 32 | jobs[i];
                      }
                    });
    std::sort (places.begin (), places.end ());
    std::vector<std::size_t> firsts; // of each region
    for (std::size_t i = 0; i < places.size () && places[i] >> 32 != NOWHERE; ++i)
      if (i == 0 || places[i] >> 32 != places[i - 1] >> 32)
        firsts.push_back (i);
    std::vector<std::vector<std::uint32_t>> left (firsts.size ());
    parallelFor (
        firsts.size (), threads_, make_worker,
        [&] (auto &worker, std::size_t r)
        {
          const std::uint64_t region = places[firsts[r]] >> 32;
          for (std::size_t i = firsts[r]; i < places.size () && places[i] >> 32 == region; ++i)
          {
            const auto job = static_cast<std::uint32_t> (places[i]);
            bool any = false, inside = true;
            reach (job,
                   [&] (int v)
                   {
                     any = true;
                     inside = inside && regionOf (v, shift) == region;
                   });
            if (any && inside)
              work (worker, job);
            else if (any)
              left[r].push_back (job);
          }
        },
        finish);
    jobs = joinParts (std::move (left), threads_);
    std::sort (jobs.begin (), jobs.end ());
  }

  double scale_;
  const std::vector<Eigen::Vector3d> &positions_;
  int threads_;
};

} // namespace erkpa
