// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace erkpa
{

/** \brief The threads that help one calling thread, kept from one piece of work to the next.
 *
 * A reconstruction is a few hundred pieces of work, many shorter than the milliseconds it can take until a new thread
 * gets a processor. So the helpers stay, wait for the next piece awake for a moment and then asleep, and a helper that
 * wakes when the work is done is not waited for.
 */
class ThreadTeam
{
public:
  ThreadTeam () = default;
  ThreadTeam (const ThreadTeam &) = delete;
  ThreadTeam &
  operator= (const ThreadTeam &) = delete;
  ~ThreadTeam ();

  /** \brief The team of the calling thread. It lives as long as that thread. */
  static ThreadTeam &
  ofThisThread ();

  /** \brief Calls share (0) here and share (1), share (2) ... on the helpers that come before share (0) returns.
   *
   * Within a share, run calls share (0) only: the threads are busy already.
   * \param[in] thread_count how many threads at most, the calling one among them
   * \param[in] share takes its work from what all shares have in common until none is left; it does not throw
   */
  void
  run (int thread_count, const std::function<void (int)> &share);

private:
  void
  addHelpers (int count);

  /** \brief The life of one helper. */
  void
  help (int thread);

  pid_t process_ = 0; // that started the helpers: a fork does not take them along
  std::vector<std::thread> helpers_;

  std::mutex mutex_; // for all below
  std::condition_variable round_begun_, all_out_;
  const std::function<void (int)> *share_ = nullptr; // of the round that helpers may join, if any
  int thread_count_ = 0;
  std::atomic<unsigned> round_{0};
  std::atomic<int> inside_{0}; // helpers at work
  bool closing_ = false;
};

} // namespace erkpa
