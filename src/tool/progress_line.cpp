// SPDX-License-Identifier: BSD-3-Clause
#include "progress_line.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>

namespace erkpa::tool
{

namespace
{

constexpr double PATIENCE = 1.0; ///< seconds before the line appears
constexpr double INTERVAL = 0.1; ///< seconds between two lines

double
now ()
{
  return std::chrono::duration<double> (std::chrono::steady_clock::now ().time_since_epoch ()).count ();
}

} // namespace

ProgressLine::ProgressLine () : is_terminal_ (isatty (STDERR_FILENO) == 1), next_ (now () + PATIENCE) {}

ProgressLine::~ProgressLine ()
{
  if (is_shown_)
    std::fputs ("\033[K", stderr);
}

ProgressCallback
ProgressLine::callback ()
{
  if (!is_terminal_)
    return {};
  return [this] (double fraction) { show (fraction); };
}

void
ProgressLine::show (double fraction)
{
  const double time = now ();
  if (time < next_)
    return;
  next_ = time + INTERVAL;
  is_shown_ = true;
  std::fprintf (stderr, "\0337%3.0f %%\0338", 100.0 * fraction); // and the cursor goes back
}

} // namespace erkpa::tool
