// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>

namespace erkpa
{

/** \brief A number as a message shows it: short, and not 0.000000 where it is small. */
inline std::string
toText (double value)
{
  char text[32];
  std::snprintf (text, sizeof text, "%g", value);
  return text;
}

} // namespace erkpa
