// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace erkpa
{

/** \brief Adds the time it lives to a number of seconds. */
class StageClock
{
public:
  explicit StageClock (double &seconds) : seconds_ (seconds), start_ (Clock::now ()) {}

  StageClock (const StageClock &) = delete;
  StageClock &
  operator= (const StageClock &) = delete;

  ~StageClock ()
  {
    seconds_ += std::chrono::duration<double> (Clock::now () - start_).count ();
  }

private:
  using Clock = std::chrono::steady_clock;
  double &seconds_;
  Clock::time_point start_;
};

} // namespace erkpa
