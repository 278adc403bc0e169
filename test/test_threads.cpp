// SPDX-License-Identifier: BSD-3-Clause
//
// The threads that share pieces of work.
#include "threads.h"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <thread>
#include <vector>

namespace
{

/** \brief How often each of some items was worked at. */
std::vector<int>
timesDone (std::size_t count, int threads)
{
  std::vector<int> times (count, 0);
  erkpa::parallelFor (
      count, threads, [] { return 0; }, [&] (int, std::size_t i) { ++times[i]; });
  return times;
}

} // namespace

TEST (Threads, DoEveryItemOnceHoweverManyTheyAre)
{
  for (const int threads : {0, 1, 2, 3, 8})
    for (const std::size_t count : {0, 1, 2, 7, 1000})
      for (int time = 0; time < 20; ++time)
        EXPECT_EQ (timesDone (count, threads), std::vector<int> (count, 1)) << threads << " threads";
}

TEST (Threads, HandBackEachWorkerOnce)
{
  std::size_t sum = 0;
  erkpa::parallelFor (
      1001, 4, [] { return std::size_t (0); }, [] (std::size_t &worker, std::size_t i) { worker += i; },
      [&] (std::size_t worker) { sum += worker; });
  EXPECT_EQ (sum, 1001u * 1000u / 2u);
}

TEST (Threads, HandOnAnExceptionAndGoOnAfterwards)
{
  const auto fail = []
  {
    erkpa::parallelFor (
        100, 4, [] { return 0; },
        [] (int, std::size_t i)
        {
          if (i == 37)
            throw std::runtime_error ("item 37");
        });
  };
  for (int time = 0; time < 10; ++time)
  {
    EXPECT_THROW (fail (), std::runtime_error);
    EXPECT_EQ (timesDone (100, 4), std::vector<int> (100, 1));
  }
}

TEST (Threads, MayFindMoreWorkWithinTheirWork)
{
  std::atomic<int> done{0};
  erkpa::parallelFor (
      20, 4, [] { return 0; },
      [&] (int, std::size_t)
      {
        erkpa::parallelFor (
            50, 4, [] { return 0; }, [&] (int, std::size_t) { ++done; });
      });
  EXPECT_EQ (done, 1000);
}

TEST (Threads, OfSeveralCallersDoNotMeet)
{
  std::atomic<int> failures{0};
  std::vector<std::thread> callers;
  callers.reserve (4);
  for (int caller = 0; caller < 4; ++caller)
    callers.emplace_back (
        [&]
        {
          for (int time = 0; time < 50; ++time)
            failures += timesDone (64, 3) == std::vector<int> (64, 1) ? 0 : 1;
        });
  for (std::thread &caller : callers)
    caller.join ();
  EXPECT_EQ (failures, 0);
}

TEST (Threads, AreThereInAForkedProcess)
{
  ASSERT_EQ (timesDone (100, 4), std::vector<int> (100, 1)); // this process has its helpers, which a fork leaves behind
  const pid_t child = ::fork ();
  ASSERT_GE (child, 0);
  if (child == 0)
  {
    ::alarm (20);
    ::_exit (timesDone (100, 4) == std::vector<int> (100, 1) ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ (::waitpid (child, &status, 0), child);
  EXPECT_TRUE (WIFEXITED (status) && WEXITSTATUS (status) == 0);
}
