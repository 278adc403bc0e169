// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace erkpa::tool
{

/** \brief Ends the program: its text is the one line the user reads, naming the option or file and the
 * remedy. */
class ToolError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

} // namespace erkpa::tool
