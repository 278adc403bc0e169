// SPDX-License-Identifier: BSD-3-Clause
#include "local_field.h"

#include "hermite_fit.h"

#include <algorithm>
#include <cmath>

namespace erkpa
{

void
LocalField::gather (const Eigen::Vector3d &center, double extent)
{
  support_.gather (center, extent);
  enrichment_.gather (support_);
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
  HermiteFit<BasisT, Size, MaxSize> fit (field_.points (), support_, enrichment_);
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
    const auto i = static_cast<std::size_t> (support_.candidates ()[static_cast<std::size_t> (node.slot)]);
    total += node.weight;
    for (std::size_t c = 0; c < channels; ++c)
      sums[c] += node.weight * static_cast<double> (points.attributes[i * channels + c]);
  }
  for (std::size_t c = 0; c < channels; ++c)
    attributes[c] = total > 0.0 ? static_cast<float> (sums[c] / total) : 0.0f;
}

} // namespace erkpa
