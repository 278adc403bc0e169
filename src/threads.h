// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "thread_team.h"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <vector>

namespace erkpa
{

/** \brief Number of threads for a setting where 0 means all processors; more than any machine has are not started. */
inline int
threadCount (int threads)
{
  return threads > 0 ? std::min (threads, 256) : omp_get_max_threads ();
}

/** \brief Runs share (thread) on several threads, the calling one among them; an exception is thrown again here.
 *
 * Threads of our own, not a team of OpenMP: such a team waits for its next work by spinning, which takes the
 * processors from whatever else runs in the pipeline.
 */
template <typename ShareT>
void
runThreads (int thread_count, ShareT share)
{
  std::exception_ptr failure;
  std::mutex failing;
  ThreadTeam::ofThisThread ().run (thread_count,
                                   [&] (int thread)
                                   {
                                     try
                                     {
                                       share (thread);
                                     }
                                     catch (...)
                                     {
                                       const std::lock_guard<std::mutex> lock (failing);
                                       failure = std::current_exception ();
                                     }
                                   });
  if (failure)
    std::rethrow_exception (failure);
}

/** \brief Runs work (worker, i) for i = 0 .. count - 1 on several threads, with one worker per thread.
 *
 * Items must not depend on each other; then the result does not depend on the number of threads. An
 * exception thrown by an item is thrown again here once all threads have stopped.
 * \param[in] make_worker makes the scratch memory of one thread
 * \param[in] work called once per item
 * \param[in] finish called for each worker at the end, from the calling thread
 */
template <typename MakeWorkerT, typename WorkT, typename FinishT>
void
parallelFor (std::size_t count, int threads, MakeWorkerT make_worker, WorkT work, FinishT finish)
{
  const int thread_count = std::min (threadCount (threads), static_cast<int> (std::min<std::size_t> (count, 4096)));
  struct alignas (128) Seat // away from the others': processors fetch two lines of 64 at once
  {
    decltype (make_worker ()) worker;
  };
  std::vector<Seat> seats;
  seats.reserve (static_cast<std::size_t> (thread_count));
  for (int t = 0; t < thread_count; ++t)
    seats.push_back (Seat{make_worker ()});

  const std::size_t chunk =
      std::clamp<std::size_t> (count / (8 * static_cast<std::size_t> (std::max (1, thread_count))), 1, 4);
  std::atomic<std::size_t> next{0};
  runThreads (thread_count,
              [&] (int thread)
              {
                for (std::size_t first = next.fetch_add (chunk); first < count; first = next.fetch_add (chunk))
                  for (std::size_t i = first; i < std::min (count, first + chunk); ++i)
                    work (seats[static_cast<std::size_t> (thread)].worker, i);
              });
  for (Seat &seat : seats)
    finish (seat.worker);
}

template <typename MakeWorkerT, typename WorkT>
void
parallelFor (std::size_t count, int threads, MakeWorkerT make_worker, WorkT work)
{
  parallelFor (count, threads, make_worker, work, [] (auto &) {});
}

/** \brief Runs work (first, last) over the stretches of 0 .. count - 1, for items that cost little each.
 * \param[in] stretch items of one
 */
template <typename WorkT>
void
parallelRanges (std::size_t count, int threads, WorkT work, std::size_t stretch = 16384)
{
  parallelFor ((count + stretch - 1) / stretch, threads, [] { return 0; },
               [&] (int, std::size_t i) { work (i * stretch, std::min (count, (i + 1) * stretch)); });
}

} // namespace erkpa
