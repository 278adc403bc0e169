// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/console/print.h>
#include <pcl/console/time.h>

#include <cstdio>
#include <string>

namespace erkpa::tool
{

/** \brief A step with its line on stdout, in the manner of PCL's tools: "> Loading a.pcd [done, 3 ms : 9
 * points]". */
class Step
{
public:
  Step (const char *verb, const std::string &object)
  {
    pcl::console::print_highlight ("%s ", verb);
    pcl::console::print_value ("%s ", object.c_str ());
    std::fflush (stdout);
    clock_.tic ();
  }

  ~Step ()
  {
    if (!is_done_)
      pcl::console::print_info ("[failed]\n");
    std::fflush (stdout); // before what may follow on stderr
  }

  Step (const Step &) = delete;
  Step &
  operator= (const Step &) = delete;

  /** \return the seconds since the step began */
  double
  done (std::size_t count, const char *unit)
  {
    const double milliseconds = clock_.toc ();
    is_done_ = true;
    pcl::console::print_info ("[done, ");
    pcl::console::print_value ("%g", milliseconds);
    pcl::console::print_info (" ms : ");
    pcl::console::print_value ("%zu", count);
    pcl::console::print_info (" %s]\n", unit);
    std::fflush (stdout);
    return milliseconds * 1e-3;
  }

private:
  pcl::console::TicToc clock_;
  bool is_done_ = false;
};

} // namespace erkpa::tool
