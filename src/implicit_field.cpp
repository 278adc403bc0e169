// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/implicit_field.h>

#include "local_field.h"
#include "noise.h"
#include "threads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace erkpa
{

ImplicitField::ImplicitField (std::shared_ptr<const OrientedPoints> points, NeighborSearch::ConstPtr search,
                              const FieldOptions &options)
    : points_ (std::move (points)), search_ (std::move (search)), options_ (options)
{
  const int k = chooseSupportSize (*points_, *search_);
  spacing_ = measureSpacing (*points_, *search_);
  feature_size_ = spacing_ * std::sqrt (static_cast<double> (k) / CLEAN_SUPPORT);
  if (options_.radius == 0.0 && options_.k == 0)
    options_.k = k;
  pencils_ = std::make_shared<const std::vector<Pencil>> (findPencils (options_.sharp_surfaces, spacing_));
}

ImplicitField::~ImplicitField () = default;

double
ImplicitField::typicalRadius () const
{
  return options_.radius > 0.0 ? options_.radius : spacing_ * std::sqrt (options_.k / M_PI);
}

Outcome
ImplicitField::checkOptions (const FieldOptions &options)
{
  if (options.k != 0 && options.k < 5)
    return {Status::INVALID_SETTING, "k = " + std::to_string (options.k) +
                                         " neighbours do not determine a surface: use at least 5, or 0 for automatic"};
  if (!(options.radius >= 0.0) || !std::isfinite (options.radius))
    return {Status::INVALID_SETTING, "the support radius must be positive and finite, or 0 to use k neighbours"};
  return {};
}

double
ImplicitField::value (const Eigen::Vector3d &x) const
{
  LocalField local (*this);
  const Eigen::Vector3d position = x - points_->origin;
  local.gather (position, 0.0);
  return local.value (position);
}

FieldSample
ImplicitField::sample (const Eigen::Vector3d &x) const
{
  LocalField local (*this);
  const Eigen::Vector3d position = x - points_->origin;
  local.gather (position, 0.0);
  return local.sample (position);
}

std::vector<ShapeFunction>
ImplicitField::shapeFunctions (const Eigen::Vector3d &x) const
{
  LocalField local (*this);
  const Eigen::Vector3d position = x - points_->origin;
  local.gather (position, 0.0);
  return local.shapeFunctions (position);
}

void
ImplicitField::evaluate (const std::vector<Eigen::Vector3d> &points, std::vector<FieldSample> &samples,
                         int threads) const
{
  samples.assign (points.size (), FieldSample ());
  // Points of one cell of a coarse grid share a neighbourhood.
  const double side = std::max (0.6 * typicalRadius (), 1e-30);
  using Cell = std::array<double, 3>;
  std::vector<std::pair<Cell, std::size_t>> order (points.size ());
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    const Eigen::Vector3d cell = ((points[i] - points_->origin) / side).array ().floor ();
    order[i] = {{cell[0], cell[1], cell[2]}, i};
  }
  order.erase (std::remove_if (order.begin (), order.end (),
                               [&] (const auto &entry) { return !points[entry.second].allFinite (); }),
               order.end ());
  std::sort (order.begin (), order.end ());
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < order.size (); ++i)
    if (i == 0 || order[i].first != order[i - 1].first)
      starts.push_back (i);
  starts.push_back (order.size ());

  const auto make_worker = [this] { return LocalField (*this); };
  parallelFor (starts.size () - 1, threads, make_worker,
               [&] (LocalField &local, std::size_t group)
               {
                 const Cell &cell = order[starts[group]].first;
                 const Eigen::Vector3d center = (Eigen::Vector3d (cell[0], cell[1], cell[2]).array () + 0.5) * side;
                 local.gather (center, 0.5 * std::sqrt (3.0) * side);
                 for (std::size_t i = starts[group]; i < starts[group + 1]; ++i)
                   samples[order[i].second] = local.sample (points[order[i].second] - points_->origin);
               });
}

} // namespace erkpa
