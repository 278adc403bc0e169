// SPDX-License-Identifier: BSD-3-Clause
#include "crease_loop.h"

#include "crease_turn.h"
#include "plane_meeting.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

namespace erkpa
{

CreaseLoop::CreaseLoop (const CellLoop &loop, const SurfaceVertices &vertices, double iso, double voxel,
                        MeshedLoop &result)
    : loop_ (&loop), vertices_ (&vertices), iso_ (iso), voxel_ (voxel), result_ (&result)
{
  for (const int v : loop.ring)
    around_ += position (v) / static_cast<double> (loop.ring.size ());
}

void
CreaseLoop::listPassages (std::size_t own_place, std::vector<Passage> &passages) const
{
  for (std::size_t i = 0; i < loop_->ring.size (); ++i)
  {
    const int a = loop_->ring[i], b = next (i);
    if (keyOf (a) != keyOf (b) && mayCrease (normalOf (std::min (a, b)), normalOf (std::max (a, b))))
      passages.push_back ({own_place, a, b, false});
  }
}

void
CreaseLoop::cross (int a, int b)
{
  result_->crossings.push_back (orderedPair (a, b));
  const auto is_known = [this] (int v)
  { return std::any_of (sides_.begin (), sides_.end (), [&] (int other) { return keyOf (other) == keyOf (v); }); };
  for (const int v : {a, b})
    if (!is_known (v))
      sides_.push_back (v);
}

/** \brief Whether one crease runs through: the vertex may be anywhere on it. */
bool
CreaseLoop::isSingle () const
{
  return result_->crossings.size () == 2;
}

void
CreaseLoop::start ()
{
  if (result_->crossings.empty ())
    return;
  middle_ = isSingle () ? middleOfCrossings () : around_;
  setOut (minimizeDistances ());
}

/** \brief Between the places where a crease crosses the loop. Two loops share each of these, so that the vertices of
 * loops along a crease stand in the order of the loops. */
Eigen::Vector3d
CreaseLoop::middleOfCrossings () const
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  for (const VertexPair &crossing : result_->crossings)
    sum += 0.5 * (position (crossing.first) + position (crossing.second));
  return sum / static_cast<double> (result_->crossings.size ());
}

/** \brief The point nearest to the tangent planes at the loop's vertices (Kobbelt et al. 2001). */
Eigen::Vector3d
CreaseLoop::minimizeDistances () const
{
  PlaneMeeting meeting;
  for (const int v : loop_->ring)
    meeting.add (normalOf (v), normalOf (v).dot (position (v) - middle_));
  const Eigen::Vector3d step = meeting.point (0.1);
  const double length = step.norm ();
  const double limit = 1.5 * voxel_;
  return middle_ + (length > limit ? limit / length : 1.0) * step;
}

void
CreaseLoop::setOut (const Eigen::Vector3d &from)
{
  constexpr double TOLERANCE = 1e-5; // voxels
  std::vector<Side> sides;
  for (const int v : sides_)
    sides.push_back (sideOf (*vertices_, static_cast<std::size_t> (v)));
  solver_.emplace (std::move (sides), from, iso_, REACH * voxel_, TOLERANCE * voxel_);
}

void
CreaseLoop::arrive ()
{
  if (!solver_)
    return;
  if (solver_->hasArrived () && (solver_->position () - middle_).norm () < REACH * voxel_)
  {
    result_->has_center = true;
    result_->position = solver_->position ();
    gradients_ = solver_->gradients ();
  }
  solver_.reset ();
}

void
CreaseLoop::startInside ()
{
  if (!result_->has_center || !isSingle ())
    return;
  constexpr double MARGIN = 0.02, STEEP = 0.1; // voxels; sine between crease and side of the loop
  const Eigen::Vector3d along = gradients_.front ().cross (gradients_.back ()).normalized ();
  double low = -REACH * voxel_, high = -low;
  for (std::size_t i = 0; i < loop_->ring.size (); ++i)
  {
    const int a = loop_->ring[i], b = next (i);
    const std::vector<VertexPair> &crossings = result_->crossings;
    if (std::find (crossings.begin (), crossings.end (), orderedPair (a, b)) != crossings.end ())
      continue;
    const Eigen::Vector3d up = (normalOf (a) + normalOf (b)).normalized ();
    const Eigen::Vector3d inwards = up.cross (position (b) - position (a)).normalized ();
    const double room = inwards.dot (result_->position - position (a)) - MARGIN * voxel_, slope = inwards.dot (along);
    if (slope > STEEP)
      low = std::max (low, -room / slope);
    else if (slope < -STEEP)
      high = std::min (high, -room / slope);
  }
  if (low > 0.0 || high < 0.0)
    setOut (result_->position + (low > high ? 0.5 * (low + high) : low > 0.0 ? low : high) * along);
}

void
CreaseLoop::describe ()
{
  result_->face = vertices_->faces[static_cast<std::size_t> (sides_.front ())];
  std::vector<Eigen::Vector3d> normals; // of the faces: several sides of sharp surfaces can be of one
  for (const Eigen::Vector3d &gradient : gradients_)
  {
    const auto is_known = [&] (const Eigen::Vector3d &n) { return turnBetween (n, gradient) < LEAST_CREASE_TURN; };
    if (gradient.norm () > 0.0 && std::none_of (normals.begin (), normals.end (), is_known))
      normals.push_back (gradient.normalized ());
  }
  result_->normal.setZero ();
  for (const Eigen::Vector3d &normal : normals)
    result_->normal += normal;
  if (result_->normal.norm () > 0.0)
    result_->normal.normalize ();
}

} // namespace erkpa
