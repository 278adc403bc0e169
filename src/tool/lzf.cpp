// SPDX-License-Identifier: BSD-3-Clause
#include "lzf.h"

#include <algorithm>
#include <cstddef>

namespace erkpa::tool
{

bool
decompressLzf (std::string_view bytes, std::vector<std::uint8_t> &output)
{
  std::size_t in = 0;
  std::size_t out = 0;
  const auto next = [&bytes, &in] () -> std::size_t { return static_cast<std::uint8_t> (bytes[in++]); };
  while (in < bytes.size ())
  {
    const std::size_t control = next ();
    if (control < 32) // control + 1 bytes as they are
    {
      const std::size_t length = control + 1;
      if (length > bytes.size () - in || length > output.size () - out)
        return false;
      std::copy_n (bytes.begin () + static_cast<std::ptrdiff_t> (in), length,
                   output.begin () + static_cast<std::ptrdiff_t> (out));
      in += length;
      out += length;
      continue;
    }
    // a repetition of what came out before: 3 bits of length, 13 of distance, 8 more of length where 3 are
    // full
    std::size_t length = control >> 5;
    if (bytes.size () - in < (length == 7 ? 2u : 1u))
      return false;
    if (length == 7)
      length += next ();
    length += 2;
    const std::size_t distance = ((control & 31u) << 8) + next () + 1;
    if (distance > out || length > output.size () - out)
      return false;
    for (const std::size_t end = out + length; out < end; ++out) // byte by byte: source and target may overlap
      output[out] = output[out - distance];
  }
  return out == output.size ();
}

} // namespace erkpa::tool
