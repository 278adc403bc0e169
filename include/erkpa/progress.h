// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace erkpa
{

/** \brief Called now and then with the fraction of the work done, 0 to 1, from the calling thread. */
using ProgressCallback = std::function<void (double)>;

} // namespace erkpa
