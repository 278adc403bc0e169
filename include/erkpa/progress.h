// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace erkpa
{

/** \brief Called now and then with the fraction of the work done, 0 to 1, from the calling thread. */
using ProgressCallback = std::function<void (double)>;

/** \brief The progress of a part of the work that begins at \a start and is \a share of the whole. */
inline ProgressCallback
partOf (const ProgressCallback &progress, double start, double share)
{
  if (!progress)
    return {};
  return [progress, start, share] (double done) { progress (start + share * done); };
}

} // namespace erkpa
