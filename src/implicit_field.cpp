// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/implicit_field.h>

#include "face_map.h"
#include "local_field.h"
#include "node_table.h"
#include "noise.h"
#include "support_size.h"
#include "threads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace erkpa
{

namespace
{

Kernel::ConstPtr
kernelOf (const FieldOptions &options)
{
  const bool collocates = options.interpolation == Interpolation::COLLOCATION;
  const KernelType type =
      options.kernel == KernelType::AUTOMATIC && collocates ? KernelType::WENDLAND_C2 : options.kernel;
  const Kernel::ConstPtr kernel = options.user_kernel ? options.user_kernel : makeKernel (type);
  return options.interpolation == Interpolation::SINGULAR ? makeSingular (kernel) : kernel;
}

Outcome
checkSupport (const FieldOptions &options)
{
  const auto bad = [] (const std::string &why) { return Outcome{Status::INVALID_SETTING, why}; };
  if (options.k != 0 && options.k < 5)
    return bad ("k = " + std::to_string (options.k) +
                " neighbours do not determine a surface: use at least 5, or 0 for automatic");
  if (!(options.radius >= 0.0) || !std::isfinite (options.radius))
    return bad ("the support radius must be positive and finite, or 0 to use k neighbours");
  const RadiusRamp &ramp = options.radius_ramp;
  const auto is_length = [] (double radius) { return radius > 0.0 && std::isfinite (radius); };
  if (ramp.axis > 2 || (ramp.axis >= 0 && !(is_length (ramp.from) && is_length (ramp.to))))
    return bad ("the ramp of the support radius needs the axis 0, 1 or 2 and two positive radii");
  const int given = (options.k > 0) + (options.radius > 0.0) + (ramp.axis >= 0) + (options.radius_function != nullptr);
  if (given > 1)
    return bad ("k, a radius, a ramp and a function of the support radius exclude each other: give one of them");
  return {};
}

} // namespace

ImplicitField::ImplicitField (std::shared_ptr<const OrientedPoints> points, NeighborSearch::ConstPtr search,
                              const FieldOptions &options, int threads, PointLayout::ConstPtr layout)
    : points_ (std::move (points)), search_ (std::move (search)), options_ (options), kernel_ (kernelOf (options))
{
  if (options_.order == Order::AUTOMATIC)
    options_.order = options_.constraint == Constraint::FUNCTIONAL ? Order::LINEAR : Order::SPHERICAL;
  if (!layout)
    layout = std::make_shared<const PointLayout> (*points_, threads);
  layout_ = layout;
  const double spacing = layout->spacing;
  grid_search_ = layout->search;
  if (options_.k == 0 && SupportSize::kindOf (*points_, options_) == SupportSize::Kind::NEAREST)
    options_.k = options_.sharp_surfaces.empty () ? layout->k : layout->k_within_faces;
  support_size_ = std::make_shared<const SupportSize> (*points_, options_, spacing);
  warpPositions ();
  spacing_ = options_.warp ? measureSpacing (warped_positions_, *warped_search_, threads) : spacing;
  typical_radius_ = support_size_->typical () * (options_.warp && spacing > 0.0 ? spacing_ / spacing : 1.0);
  feature_size_ = spacing_ * std::sqrt (static_cast<double> (layout->k) / CLEAN_SUPPORT);
  for (std::size_t i = 0; i < options_.sharp_surfaces.size (); ++i)
    if (!separatesFaces (*options_.sharp_surfaces[i]))
    {
      enriching_.push_back (options_.sharp_surfaces[i]);
      enriching_places_.push_back (static_cast<int> (i));
    }
  pencils_ = std::make_shared<const std::vector<Pencil>> (findPencils (enriching_, spacing));
  faces_ = FaceMap::make (*points_, *layout->grid, options_.sharp_surfaces, spacing, threads);
  node_table_ = std::make_shared<const NodeTable> (*points_, layout->grid, threads);
  if (options_.constraint != Constraint::OFFSURFACE)
    return;
  offsets_ = support_size_->radiiOfNodes (*search_, threads);
  // All searches reach as far as the largest offset: a stray point must not be the one that says how far.
  constexpr double FAR = 4.0;
  const bool by_nearest = support_size_->kind () == SupportSize::Kind::NEAREST;
  const double most = by_nearest ? FAR * support_size_->typical () : HUGE_VAL;
  for (float &offset : offsets_)
  {
    offset = static_cast<float> (options_.offset * std::min (static_cast<double> (offset), most));
    largest_offset_ = std::max (largest_offset_, static_cast<double> (offset));
  }
}

ImplicitField::~ImplicitField () = default;

ImplicitField::ConstPtr
ImplicitField::remade (const FieldOptions &options, int threads) const
{
  return std::make_shared<const ImplicitField> (points_, search_, options, threads, layout_);
}

void
ImplicitField::warpPositions ()
{
  if (!options_.warp)
    return;
  for (const Eigen::Vector3f &p : points_->positions)
    warped_positions_.emplace_back (
        (options_.warp->map (p.cast<double> () + points_->origin) - points_->origin).cast<float> ());
  warped_search_ = makeKdTreeSearch (warped_positions_);
}

double
ImplicitField::nodeValue (int node, int side) const
{
  if (values_.empty ())
    return side == 0 ? 0.0 : side * offsetOf (node);
  return values_[valueIndex (node, side)];
}

void
ImplicitField::setNodeValues (std::vector<double> values)
{
  if (values.size () != points_->size () * static_cast<std::size_t> (valuesPerNode ()))
    throw std::invalid_argument ("setNodeValues needs a value for each node and off-surface point");
  values_ = std::move (values);
}

Outcome
ImplicitField::checkOptions (const FieldOptions &options)
{
  const auto bad = [] (const std::string &why) { return Outcome{Status::INVALID_SETTING, why}; };
  if (!(options.offset > 0.0 && options.offset < 1.0))
    return bad ("the offset of off-surface points is a share of the support radius: use a value between 0 and 1");
  if (!(options.flatten > 0.0 && options.flatten <= 1.0))
    return bad ("flatten is the share of the radius that supports reach along the normals: use a value above 0, at "
                "most 1");
  if (options.enrichment == EnrichmentType::JUMP && options.constraint != Constraint::FUNCTIONAL)
    return bad ("the jump enrichment is for functional constraints, whose values jump across an edge: use the kink");
  if (options.constraint == Constraint::OFFSURFACE && options.offset >= options.flatten)
    return bad ("the off-surface points lie beyond the flattened supports: use a smaller offset or a larger flatten");
  const bool is_singular = options.kernel == KernelType::SINGULAR && !options.user_kernel;
  if (is_singular && options.interpolation != Interpolation::NONE)
    return bad ("the singular kernel interpolates by itself: leave interpolation at none, or take another kernel");
  const Outcome outcome = options.user_kernel ? checkKernel (*options.user_kernel) : Outcome ();
  return outcome.ok () ? checkSupport (options) : outcome;
}

double
ImplicitField::value (const Eigen::Vector3d &x) const
{
  LocalField local (*this, *search_);
  const Eigen::Vector3d position = x - points_->origin;
  local.gather (position, 0.0);
  return local.value (position);
}

FieldSample
ImplicitField::sample (const Eigen::Vector3d &x) const
{
  LocalField local (*this, *search_);
  const Eigen::Vector3d position = x - points_->origin;
  local.gather (position, 0.0);
  return local.sample (position);
}

std::vector<ShapeFunction>
ImplicitField::shapeFunctions (const Eigen::Vector3d &x) const
{
  LocalField local (*this, *search_);
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

  const auto make_worker = [this] { return LocalField (*this, *search_); };
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
