// SPDX-License-Identifier: BSD-3-Clause
#include "local_field.h"

#include "field_fit.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

namespace erkpa
{

void
LocalField::gather (const Eigen::Vector3d &center, double extent)
{
  if (warp_ == nullptr)
  {
    gatherUnwarped (center, extent);
    return;
  }
  startGuess (center);
  constexpr double MARGIN = 1.5; // the Jacobian changes over the ball; points beyond gather for themselves
  const double stretch = Eigen::JacobiSVD<Eigen::Matrix3d> (unwarping_).singularValues ()[0];
  gatherUnwarped (guess_ + unwarping_ * (center - warped_center_), MARGIN * stretch * extent);
}

void
LocalField::gatherUnwarped (const Eigen::Vector3d &center, double extent)
{
  ball_center_ = center;
  ball_extent_ = extent;
  support_.gather (center, extent);
  enrichment_.gather (support_);
}

/** \brief Points near \a center are sought from where its nearest node comes from. */
void
LocalField::startGuess (const Eigen::Vector3d &center)
{
  std::vector<int> nearest;
  std::vector<float> squared;
  field_.surfaceSearch ().nearestK (center.cast<float> (), 1, nearest, squared);
  if (nearest.empty ())
    return;
  const auto node = static_cast<std::size_t> (nearest.front ());
  guess_ = field_.points ().positions[node].cast<double> ();
  warped_center_ = field_.surfacePositions ()[node].cast<double> ();
  unwarping_ = warp_->jacobian (guess_ + field_.points ().origin).inverse ();
}

bool
LocalField::unwarp (const Eigen::Vector3d &x, Eigen::Vector3d &unwarped)
{
  const Eigen::Vector3d &origin = field_.points ().origin;
  constexpr double TOLERANCE = 1e-6; // of the nodes' spacing; the method stops far below where it can
  Eigen::Vector3d position = guess_ + origin;
  if (!warp_->invert (x + origin, position, TOLERANCE * field_.spacing ()))
    return false;
  unwarping_ = warp_->jacobian (position).inverse ();
  unwarped = position - origin;
  return unwarped.allFinite () && unwarping_.allFinite ();
}

double
LocalField::value (const Eigen::Vector3d &x)
{
  evaluate (x, Task::VALUE);
  return result_.value;
}

LocalSample
LocalField::sample (const Eigen::Vector3d &x)
{
  LocalSample sample;
  if (evaluate (x, Task::GRADIENT))
    static_cast<FieldSample &> (sample) = result_;
  sample.radius = support_.radius ();
  sample.border_offset = borderOffset ();
  if (warp_ != nullptr)
    sample.gradient = unwarping_.transpose () * sample.gradient; // of f (warp^-1 (x))
  return sample;
}

std::vector<ShapeFunction>
LocalField::shapeFunctions (const Eigen::Vector3d &x)
{
  shape_functions_.clear ();
  evaluate (x, Task::SHAPE_FUNCTIONS);
  return shape_functions_;
}

bool
LocalField::evaluate (const Eigen::Vector3d &x, Task task)
{
  result_ = FieldSample ();
  if (warp_ == nullptr)
    return evaluateUnwarped (x, task);
  Eigen::Vector3d unwarped;
  if (!unwarp (x, unwarped))
    return false;
  if ((unwarped - ball_center_).norm () > ball_extent_)
    gatherUnwarped (unwarped, 0.0);
  return evaluateUnwarped (unwarped, task);
}

bool
LocalField::evaluateUnwarped (const Eigen::Vector3d &x, Task task)
{
  if (!support_.covers (x))
    gatherUnwarped (x, 0.0);
  if (!support_.select (x))
    return false;
  ++evaluations_;
  support_nodes_ += support_.nodes ().size ();
  enrichment_.select (support_, x);
  switch (field_.options ().order)
  {
    case Order::CONSTANT:
      fit<ConstantBasis> (task);
      break;
    case Order::LINEAR:
      fit<LinearBasis> (task);
      break;
    case Order::AUTOMATIC: // settled by the field
    case Order::SPHERICAL:
      fit<SphericalBasis> (task);
      break;
    case Order::QUADRATIC:
      fit<QuadraticBasis> (task);
      break;
  }
  return result_.isDefined ();
}

template <typename BasisT>
void
LocalField::fit (Task task)
{
  if (enrichment_.size () == 0)
    fitWith<BasisT, BasisT::SIZE, BasisT::SIZE> (task);
  else
    fitWith<BasisT, Eigen::Dynamic, BasisT::SIZE + Enrichment::MAX_TERMS> (task);
}

template <typename BasisT, int Size, int MaxSize>
void
LocalField::fitWith (Task task)
{
  FieldFit<BasisT, Size, MaxSize> fit (field_.points (), field_.options ().constraint, support_, enrichment_);
  result_.value = fit.value ();
  if (task == Task::GRADIENT)
    result_.gradient = fit.gradient ();
  else if (task == Task::SHAPE_FUNCTIONS)
    fit.shapeFunctions (shape_functions_);
}

double
LocalField::borderOffset () const
{
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero ();
  double total = 0.0;
  for (const SupportNode &node : support_.nodes ())
  {
    centroid += node.weight * node.u;
    total += node.weight;
  }
  const double slope = result_.gradient.norm ();
  if (!(total > 0.0) || !(slope > 0.0))
    return HUGE_VAL;
  centroid /= total;
  const Eigen::Vector3d normal = result_.gradient / slope;
  return (centroid - centroid.dot (normal) * normal).norm ();
}

void
LocalField::blendAttributes (float *attributes) const
{
  const OrientedPoints &points = field_.points ();
  const auto channels = static_cast<std::size_t> (points.channels);
  double total = 0.0;
  std::vector<double> sums (channels, 0.0);
  for (const SupportNode &node : support_.nodes ())
  {
    const auto i = static_cast<std::size_t> (support_.pointOf (node).node);
    total += node.weight;
    for (std::size_t c = 0; c < channels; ++c)
      sums[c] += node.weight * static_cast<double> (points.attributes[i * channels + c]);
  }
  for (std::size_t c = 0; c < channels; ++c)
    attributes[c] = total > 0.0 ? static_cast<float> (sums[c] / total) : 0.0f;
}

} // namespace erkpa
