// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/marching_cubes.h>

namespace erkpa::tool
{

/** \brief A line on stderr with the share of the work done, while there is a terminal and the work takes
 * long.
 *
 * The line is wiped out at the end, so that messages stand on lines of their own.
 */
class ProgressLine
{
public:
  ProgressLine ();
  ~ProgressLine ();
  ProgressLine (const ProgressLine &) = delete;
  ProgressLine &
  operator= (const ProgressLine &) = delete;

  /** \brief Shows the line; empty where there is no terminal. Lives no longer than this object. */
  ProgressCallback
  callback ();

private:
  void
  show (double fraction);

  bool is_terminal_;
  bool is_shown_ = false;
  double next_; ///< when to show the line again, in seconds of the steady clock
};

} // namespace erkpa::tool
