// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench_run.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace bench
{

/** \brief What the command line asks for. */
struct Plan
{
  std::vector<std::string> shapes;
  std::vector<std::size_t> sizes; ///< numbers of points
  std::vector<int> threads;
  int repeats = 1;
  bool poisson = false;
  int poisson_depth = 0; ///< 0: cells as close to ERKPA's as powers of two come
};

/** \brief The same thing measured over and over. */
struct Row
{
  Run run;
  std::vector<Json> results;  ///< one for each repetition
  double speed_up = 0.0;      ///< over the first number of threads; 0 = not measured
  double poisson_ratio = 0.0; ///< time of pcl::Poisson over ERKPA's, the same threads; 0 = not measured

  /** \brief The repetition that took the least time; one that failed, where there is any. */
  const Json &
  best () const;

  bool
  hasFailed () const
  {
    return best ().contains ("error");
  }
};

/** \brief Measures a shape at a size: the rows take turns, so that what else the machine does meets all of them. */
std::vector<Row>
measureRows (const Plan &plan, const std::string &shape, std::size_t points);

/** \brief The row with all its repetitions. */
Json
toJson (const Row &row);

} // namespace bench
