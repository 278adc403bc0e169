// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/kernel.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief Section 4 of the paper. */
class PaperKernel : public Kernel
{
public:
  double
  weight (double t) const override
  {
    return 1.0 + t * t * t * (-10.0 + t * (15.0 - 6.0 * t));
  }

  double
  derivativeOverT (double t) const override
  {
    return -30.0 * t * (1.0 - t) * (1.0 - t);
  }
};

/** \brief H. Wendland, Adv. Comput. Math. 4 (1995): φ_3,1. */
class WendlandC2Kernel : public Kernel
{
public:
  double
  weight (double t) const override
  {
    const double s = (1.0 - t) * (1.0 - t);
    return s * s * (4.0 * t + 1.0);
  }

  double
  derivativeOverT (double t) const override
  {
    const double s = 1.0 - t;
    return -20.0 * s * s * s;
  }
};

/** \brief The same, φ_3,2. */
class WendlandC4Kernel : public Kernel
{
public:
  double
  weight (double t) const override
  {
    const double s = (1.0 - t) * (1.0 - t);
    return s * s * s * (t * (35.0 * t + 18.0) + 3.0) / 3.0;
  }

  double
  derivativeOverT (double t) const override
  {
    const double s = (1.0 - t) * (1.0 - t);
    return -56.0 / 3.0 * s * s * (1.0 - t) * (5.0 * t + 1.0);
  }
};

class GaussianKernel : public Kernel
{
public:
  double
  weight (double t) const override
  {
    const double s = 1.0 - t * t;
    return std::exp (-STEEPNESS * t * t) * s * s * s;
  }

  double
  derivativeOverT (double t) const override
  {
    const double s = 1.0 - t * t;
    return -std::exp (-STEEPNESS * t * t) * s * s * (2.0 * STEEPNESS * s + 6.0);
  }

private:
  static constexpr double STEEPNESS = 4.0;
};

class SingularKernel : public Kernel
{
public:
  explicit SingularKernel (ConstPtr kernel) : kernel_ (std::move (kernel)) {}

  double
  weight (double t) const override
  {
    const double s = std::max (t, CUT_OFF);
    return kernel_->weight (t) / (s * s);
  }

  double
  derivativeOverT (double t) const override
  {
    const double s = std::max (t, CUT_OFF);
    const double of_kernel = kernel_->derivativeOverT (t) / (s * s);
    return t > CUT_OFF ? of_kernel - 2.0 * kernel_->weight (t) / (s * s * s * s) : of_kernel;
  }

private:
  static constexpr double CUT_OFF = 1e-6;

  ConstPtr kernel_;
};

} // namespace

Kernel::ConstPtr
makeKernel (KernelType type)
{
  switch (type)
  {
    case KernelType::WENDLAND_C2:
      return std::make_shared<WendlandC2Kernel> ();
    case KernelType::WENDLAND_C4:
      return std::make_shared<WendlandC4Kernel> ();
    case KernelType::GAUSSIAN:
      return std::make_shared<GaussianKernel> ();
    case KernelType::SINGULAR:
      return makeSingular (std::make_shared<PaperKernel> ());
    case KernelType::AUTOMATIC:
    case KernelType::PAPER:
      break;
  }
  return std::make_shared<PaperKernel> ();
}

Kernel::ConstPtr
makeSingular (Kernel::ConstPtr kernel)
{
  return std::make_shared<SingularKernel> (std::move (kernel));
}

Outcome
checkKernel (const Kernel &kernel)
{
  const auto bad = [] (const std::string &why) {
    return Outcome{Status::INVALID_SETTING, "the kernel " + why + "; see erkpa::Kernel for what it must keep"};
  };
  constexpr int STEPS = 64;
  double last = kernel.weight (0.0);
  const double largest = last;
  for (int i = 0; i < STEPS; ++i)
  {
    const double t = static_cast<double> (i) / STEPS, weight = kernel.weight (t);
    if (!std::isfinite (weight) || !std::isfinite (kernel.derivativeOverT (t)))
      return bad ("is not finite for 0 <= t < 1");
    if (weight < 0.0 || weight > last * (1.0 + 1e-9))
      return bad ("is negative or rises between t = 0 and 1");
    last = weight;
  }
  if (!(largest > 0.0) || kernel.weight (1.0 - 1e-6) > 1e-3 * largest)
    return bad ("must be positive at t = 0 and run to zero at t = 1");
  return {};
}

} // namespace erkpa
