// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/status.h>

#include <memory>

namespace erkpa
{

/** \brief The kernel w(t) that weighs the nodes (section 3.2 of the paper), t = distance / support radius.
 *
 * Only 0 <= t < 1 is asked for; beyond, the weight is zero. The field is as smooth as the kernel: w and its
 * derivatives should run to zero at t = 1. The scale of w is of no account. Derive from this class for a kernel of
 * your own; it must be const and safe from several threads.
 */
class Kernel
{
public:
  using ConstPtr = std::shared_ptr<const Kernel>;

  Kernel () = default;
  Kernel (const Kernel &) = delete;
  Kernel &
  operator= (const Kernel &) = delete;
  virtual ~Kernel () = default;

  /** \brief w(t): finite, not negative, falling. */
  virtual double
  weight (double t) const = 0;

  /** \brief dw/dt divided by t: finite at t = 0, where the gradient of w needs it. */
  virtual double
  derivativeOverT (double t) const = 0;
};

/** \brief The kernels that come with the library. */
enum class KernelType
{
  AUTOMATIC,   ///< the paper's; for collocation WENDLAND_C2, whose Fourier transform has no zero: only such a kernel
               ///< makes a system that is well conditioned
  PAPER,       ///< 1 - 10 t³ + 15 t⁴ - 6 t⁵, the paper's (section 4); C2
  WENDLAND_C2, ///< (1 - t)⁴ (4 t + 1); C2, narrower
  WENDLAND_C4, ///< (1 - t)⁶ (35 t² + 18 t + 3) / 3; C4, narrower still
  GAUSSIAN,    ///< exp (-4 t²) (1 - t²)³: a Gaussian brought to zero at t = 1; C2
  SINGULAR     ///< the paper's over t²: the field passes through the nodes
};

Kernel::ConstPtr
makeKernel (KernelType type);

/** \brief A kernel over t²: infinite at the node (cut off at t = 1e-6), so that the field interpolates. */
Kernel::ConstPtr
makeSingular (Kernel::ConstPtr kernel);

/** \brief Tells whether a kernel keeps the rules: finite, not negative, falling, about zero at t = 1. */
Outcome
checkKernel (const Kernel &kernel);

} // namespace erkpa
