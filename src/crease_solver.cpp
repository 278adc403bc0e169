// SPDX-License-Identifier: BSD-3-Clause
#include "crease_solver.h"

#include "plane_meeting.h"

#include <algorithm>
#include <cmath>

namespace erkpa
{

bool
moveToCrease (LocalField &local, const std::vector<Side> &sides, double iso, double reach, double tolerance,
              Eigen::Vector3d &x, std::vector<Eigen::Vector3d> *gradients_there)
{
  constexpr int STEPS = 10;
  constexpr double PARALLEL = 0.05; // sine of about half the angle at which pieces count as one
  const Eigen::Vector3d start = x;
  if (gradients_there != nullptr)
    gradients_there->resize (sides.size ());
  std::vector<LocalSample> samples;
  double squares = 0.0, before = HUGE_VAL; // of the values; the last step
  for (int step = 0; step < STEPS; ++step)
  {
    PlaneMeeting meeting;
    squares = 0.0;
    local.sampleOnSides (x, sides, samples);
    for (std::size_t i = 0; i < sides.size (); ++i)
    {
      const LocalSample &sample = samples[i];
      if (!sample.isDefined ())
        return false;
      meeting.add (sample.gradient, iso - sample.value);
      squares += std::pow (iso - sample.value, 2);
      if (gradients_there != nullptr)
        (*gradients_there)[i] = sample.gradient;
    }
    const Eigen::Vector3d move = meeting.point (PARALLEL);
    if (!((x + move - start).norm () < reach))
      return false;
    x += move;
    const double length = move.norm ();
    if (length * std::min (1.0, length / before) < tolerance) // the next step is shorter still
      return true;
    before = length;
  }
  return std::sqrt (squares) < 1e3 * tolerance;
}

} // namespace erkpa
