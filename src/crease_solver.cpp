// SPDX-License-Identifier: BSD-3-Clause
#include "crease_solver.h"

#include "plane_meeting.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace erkpa
{

CreaseSolver::CreaseSolver (std::vector<Side> sides, const Eigen::Vector3d &start, double iso, double reach,
                            double tolerance)
    : sides_ (std::move (sides)), start_ (start), position_ (start), iso_ (iso), reach_ (reach), tolerance_ (tolerance),
      gradients_ (sides_.size (), Eigen::Vector3d::Zero ())
{
}

void
CreaseSolver::step (const std::vector<LocalSample> &samples)
{
  constexpr int STEPS = 10;
  constexpr double PARALLEL = 0.05; // sine of about half the angle at which pieces count as one
  PlaneMeeting meeting;
  double squares = 0.0;
  state_ = State::LOST;
  for (std::size_t i = 0; i < sides_.size (); ++i)
  {
    if (!samples[i].isDefined ())
      return;
    meeting.add (samples[i].gradient, iso_ - samples[i].value);
    squares += std::pow (iso_ - samples[i].value, 2);
    gradients_[i] = samples[i].gradient;
  }
  const Eigen::Vector3d move = meeting.point (PARALLEL);
  if (!((position_ + move - start_).norm () < reach_))
    return;
  position_ += move;
  const double length = move.norm ();
  const double shorter = before_ > 0.0 ? std::min (1.0, length / before_) : 1.0; // than this one the next will be
  const bool is_there = length * shorter < tolerance_;
  const bool is_last = ++steps_ == STEPS;
  if (is_there || (is_last && std::sqrt (squares) < 1e3 * tolerance_))
    state_ = State::ARRIVED;
  else if (!is_last)
    state_ = State::AT_WORK;
  before_ = length;
}

} // namespace erkpa
