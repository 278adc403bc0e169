// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace erkpa
{

/** \brief The paper's kernel (section 4): w(t) = 1 - 10 t^3 + 15 t^4 - 6 t^5 on [0, 1], zero beyond; C2.
 *
 * t is the distance between a point and a node in units of the support radius.
 */
struct PaperKernel
{
  static double
  weight (double t)
  {
    return t < 1.0 ? 1.0 + t * t * t * (-10.0 + t * (15.0 - 6.0 * t)) : 0.0;
  }

  /** \brief dw/dt divided by t: finite at t = 0, where the gradient of w needs it. */
  static double
  derivativeOverT (double t)
  {
    return t < 1.0 ? -30.0 * t * (1.0 - t) * (1.0 - t) : 0.0;
  }
};

} // namespace erkpa
