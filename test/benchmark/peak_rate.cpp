// SPDX-License-Identifier: BSD-3-Clause
#include "peak_rate.h"

#include "peak_loop.h"

#include <algorithm>
#include <cstring>
#include <ctime>
#include <map>

namespace bench
{

namespace
{

using Loop = float (*) (std::size_t rounds);

Loop
loopOf (const erkpa::lanes::Engine &engine)
{
#ifdef ERKPA_X86_LANES
  if (std::strcmp (engine.name, "AVX2") == 0)
    return runMultiplyAddsAvx2;
  if (std::strcmp (engine.name, "AVX-512") == 0)
    return runMultiplyAddsAvx512;
#endif
  return std::strcmp (engine.name, "baseline") == 0 ? runMultiplyAddsBaseline : nullptr;
}

/** \brief The best of many runs of about a tenth of a millisecond: some of them nothing disturbs. */
double
measure (Loop loop, std::size_t width)
{
  constexpr int RUNS = 100;
  constexpr std::size_t ROUNDS = 100000;
  double best = 0.0;
  volatile float result = 0.0f; // is used
  for (int run = 0; run < RUNS; ++run)
  {
    const double start = threadSeconds ();
    result = loop (ROUNDS);
    const double seconds = threadSeconds () - start;
    if (seconds > 0.0)
      best = std::max (best, 2.0 * static_cast<double> (ROUNDS * CHAINS * width) / seconds);
  }
  static_cast<void> (result);
  return best;
}

} // namespace

double
threadSeconds ()
{
  timespec time = {};
  clock_gettime (CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double> (time.tv_sec) + 1e-9 * static_cast<double> (time.tv_nsec);
}

double
peakRate (const erkpa::lanes::Engine &engine)
{
  static std::map<const erkpa::lanes::Engine *, double> rates;
  const auto known = rates.find (&engine);
  if (known != rates.end ())
    return known->second;
  const Loop loop = loopOf (engine);
  return rates[&engine] = loop != nullptr ? measure (loop, engine.width) : 0.0;
}

} // namespace bench
