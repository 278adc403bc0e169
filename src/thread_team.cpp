// SPDX-License-Identifier: BSD-3-Clause
#include "thread_team.h"

#include <unistd.h>

#include <chrono>
#include <memory>
#include <system_error>

namespace erkpa
{

namespace
{

thread_local bool is_busy = false; // in a share

/** \brief Waits awake, for as long as falling asleep and being woken would take; whether it came true. */
template <typename PredicateT>
bool
comesSoon (PredicateT predicate)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now () + std::chrono::microseconds (50);
  while (!predicate ())
  {
    if (Clock::now () > end)
      return false;
    std::this_thread::yield (); // to whom else the processor may serve
  }
  return true;
}

} // namespace

ThreadTeam::~ThreadTeam ()
{
  {
    const std::lock_guard<std::mutex> lock (mutex_);
    closing_ = true;
    ++round_;
  }
  round_begun_.notify_all ();
  for (std::thread &helper : helpers_)
    helper.join ();
}

ThreadTeam &
ThreadTeam::ofThisThread ()
{
  thread_local std::unique_ptr<ThreadTeam> team;
  if (team && team->process_ != ::getpid ())
    team.release (); // NOLINT(bugprone-unused-return-value): a forked process has the team without its threads
  if (!team)
  {
    team = std::make_unique<ThreadTeam> ();
    team->process_ = ::getpid ();
  }
  return *team;
}

void
ThreadTeam::run (int thread_count, const std::function<void (int)> &share)
{
  if (thread_count <= 1 || is_busy)
    return share (0);

  addHelpers (thread_count - 1);
  {
    const std::lock_guard<std::mutex> lock (mutex_);
    share_ = &share;
    thread_count_ = thread_count;
    ++round_;
  }
  round_begun_.notify_all ();
  is_busy = true;
  share (0);
  is_busy = false;

  std::unique_lock<std::mutex> lock (mutex_);
  share_ = nullptr; // who comes now comes too late
  if (inside_ == 0)
    return;
  lock.unlock ();
  const auto all_out = [&] { return inside_ == 0; };
  if (comesSoon (all_out))
    return;
  lock.lock ();
  all_out_.wait (lock, all_out);
}

void
ThreadTeam::addHelpers (int count)
{
  try
  {
    while (static_cast<int> (helpers_.size ()) < count)
      helpers_.emplace_back (&ThreadTeam::help, this, static_cast<int> (helpers_.size ()) + 1);
  }
  catch (const std::system_error &) // no more threads to be had: those there are do the work
  {
  }
}

void
ThreadTeam::help (int thread)
{
  is_busy = true;
  for (unsigned seen = 0;;)
  {
    const auto begun = [&] { return round_ != seen; };
    const bool soon = comesSoon (begun);
    std::unique_lock<std::mutex> lock (mutex_);
    if (!soon)
      round_begun_.wait (lock, begun);
    seen = round_;
    if (closing_)
      return;
    if (!share_ || thread >= thread_count_)
      continue;
    const auto &share = *share_;
    ++inside_;
    lock.unlock ();
    share (thread);
    lock.lock ();
    if (--inside_ == 0)
      all_out_.notify_one ();
  }
}

} // namespace erkpa
