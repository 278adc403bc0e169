// SPDX-License-Identifier: BSD-3-Clause
#include "machine.h"

#include <algorithm>
#include <fstream>

namespace bench
{

std::string
processorName ()
{
  std::ifstream info ("/proc/cpuinfo");
  std::string line;
  while (std::getline (info, line))
    if (line.rfind ("model name", 0) == 0)
      return line.substr (std::min (line.size (), line.find (':') + 2));
  return "processor unknown";
}

} // namespace bench
