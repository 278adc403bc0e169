// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace erkpa
{

/** \brief Settings of the sharp edges that are found in the points. */
struct SharpOptions
{
  bool automatic = false; ///< find sharp edges, beside those that are given
  double angle = 25.0;    ///< edges whose faces turn by less than this many degrees are taken for smooth; in (0, 90]
};

} // namespace erkpa
