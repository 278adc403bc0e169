// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lanes/lanes.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace erkpa
{

/** \brief Memory for calls of the lanes; it only grows. */
class LaneMemory
{
public:
  lanes::Scratch
  scratchFor (std::size_t nodes)
  {
    list_.resize (std::max (list_.size (), nodes + lanes::MAX_WIDTH));
    near_.resize (lanes::Scratch::COLUMNS * list_.size ());
    rows_.resize (std::max (rows_.size (), lanes::MAX_WIDTH * (nodes + 2)));
    return {list_.data (), near_.data (), alignedRows ()};
  }

private:
  /** \brief The first row at the start of a cache line: others would lie on two of them. */
  float *
  alignedRows ()
  {
    void *start = rows_.data ();
    std::size_t space = rows_.size () * sizeof (float);
    return static_cast<float *> (
        std::align (lanes::MAX_WIDTH * sizeof (float), space - lanes::MAX_WIDTH * sizeof (float), start, space));
  }

  std::vector<std::uint32_t> list_;
  std::vector<float> near_, rows_;
};

} // namespace erkpa
