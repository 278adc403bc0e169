// SPDX-License-Identifier: BSD-3-Clause
#include "block_field.h"

#include "support.h"
#include "support_size.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace erkpa
{

namespace
{

constexpr double ROUNDING = 1e-5; // of a length, in float

std::optional<lanes::Kernel>
laneKernelOf (const FieldOptions &options)
{
  if (options.user_kernel || options.interpolation == Interpolation::SINGULAR)
    return std::nullopt;
  switch (options.kernel)
  {
    case KernelType::AUTOMATIC:
      return options.interpolation == Interpolation::COLLOCATION ? lanes::Kernel::WENDLAND_C2 : lanes::Kernel::PAPER;
    case KernelType::PAPER:
      return lanes::Kernel::PAPER;
    case KernelType::WENDLAND_C2:
      return lanes::Kernel::WENDLAND_C2;
    case KernelType::WENDLAND_C4:
      return lanes::Kernel::WENDLAND_C4;
    case KernelType::GAUSSIAN:
      return lanes::Kernel::GAUSSIAN;
    case KernelType::SINGULAR: // weights of 1e12 leave nothing of the others in float
      break;
  }
  return std::nullopt;
}

lanes::Basis
laneBasisOf (Order order)
{
  switch (order)
  {
    case Order::CONSTANT:
      return lanes::Basis::CONSTANT;
    case Order::LINEAR:
      return lanes::Basis::LINEAR;
    case Order::QUADRATIC:
      return lanes::Basis::QUADRATIC;
    case Order::AUTOMATIC: // settled by the field
    case Order::SPHERICAL:
      break;
  }
  return lanes::Basis::SPHERICAL;
}

lanes::Constraint
laneConstraintOf (Constraint constraint)
{
  switch (constraint)
  {
    case Constraint::FUNCTIONAL:
      return lanes::Constraint::FUNCTIONAL;
    case Constraint::OFFSURFACE:
      return lanes::Constraint::VALUES;
    case Constraint::HERMITE:
      break;
  }
  return lanes::Constraint::HERMITE;
}

} // namespace

bool
BlockField::canEvaluate (const ImplicitField &field)
{
  const FieldOptions &options = field.options ();
  return laneKernelOf (options) && !options.warp && options.flatten >= 1.0 && field.points ().shapes.empty () &&
         field.supportSize ().kind () != SupportSize::Kind::PER_NODE && field.supportSize ().typical () > 0.0;
}

BlockField::BlockField (const ImplicitField &field, const lanes::Engine &engine)
    : field_ (field), table_ (canEvaluate (field) ? &field.nodeTable () : nullptr), engine_ (engine),
      groups_ (field.faces ()), unit_ (field.supportSize ().typical ()), inverse_unit_ (1.0 / unit_)
{
  if (table_ == nullptr)
    return;
  const FieldOptions &options = field.options ();
  settings_.basis = laneBasisOf (options.order);
  settings_.constraint = laneConstraintOf (options.constraint);
  settings_.kernel = *laneKernelOf (options);
  const bool by_nearest = field.supportSize ().kind () == SupportSize::Kind::NEAREST;
  settings_.k = by_nearest ? std::min (field.supportSize ().k (), static_cast<int> (field.points ().size ())) : 0;
  settings_.min_nodes = static_cast<int> (std::min (Support::MIN_NODES, field.points ().size ()));
  setReach (1.0, 0.0, 0.0);
}

void
BlockField::setReach (double share, double offset, double near_enough)
{
  settings_.reach = static_cast<float> (share);
  settings_.offset = static_cast<float> (offset * inverse_unit_);
  settings_.near_enough = static_cast<float> (near_enough * inverse_unit_);
}

bool
BlockField::gather (const Eigen::Vector3d &center, double extent)
{
  clearPoints ();
  if (table_ == nullptr)
    return false;
  // A middle that floats can say: then differences from it are exact.
  center_ = center.cast<float> ().cast<double> ();
  const double all = extent + (center - center_).norm ();
  if (!findReach (center_, all))
    return false;
  has_separations_ = groups_.gather (center, extent);
  gatherSharpSurfaces ();
  copyNodes ();
  return true;
}

/** \brief A distance within which there are k of the gathered nodes, little more than that of the k-th.
 *
 * The exact one is found for every point by itself; a few counts are quicker here than a selection.
 * \param[in] guess a distance that may do; the result is larger where it does not
 */
double
BlockField::boundOfKth (std::size_t k, double guess) const
{
  const auto count_within = [this] (double distance)
  {
    const auto squared = static_cast<float> (distance * distance);
    int count = 0;
    for (std::size_t i = 0; i < found_; ++i)
      count += squared_[i] <= squared ? 1 : 0;
    return static_cast<std::size_t> (count);
  };
  constexpr int STEPS = 5;
  double low = 0.0, high = guess;
  if (count_within (guess) < k)
    return HUGE_VAL;
  for (int step = 0; step < STEPS; ++step)
  {
    const double middle = 0.5 * (std::max (low, 0.5 * high) + high);
    (count_within (middle) < k ? low : high) = middle;
  }
  return high;
}

/** \brief See Support::gather (). */
bool
BlockField::findReach (const Eigen::Vector3d &center, double extent)
{
  const SupportSize &size = field_.supportSize ();
  if (size.kind () != SupportSize::Kind::NEAREST)
  {
    center_radius_ = size.radiusAt (center);
    const double stretch = size.kind () == SupportSize::Kind::FUNCTION ? 2.0 : 1.0;
    gatherNodes (center, std::max (center_radius_, 0.0) + stretch * extent);
    return true;
  }
  constexpr double FARTHEST = 1e18; // its square is still a float
  const auto k = static_cast<std::size_t> (settings_.k);
  double guess = 1.15 * (center_radius_ > 0.0 ? std::min (center_radius_, 2.0 * unit_) : unit_);
  for (; center.norm () < FARTHEST && guess < FARTHEST; guess *= 2.0)
  {
    gatherNodes (center, guess + 2.0 * extent);
    if (found_ < k)
      continue;
    center_radius_ = boundOfKth (k, guess);
    if (center_radius_ <= guess)
      return true;
  }
  center_radius_ = 0.0;
  return false;
}

void
BlockField::gatherNodes (const Eigen::Vector3d &center, double reach)
{
  reach_ = reach;
  const double all = (reach + field_.largestOffset ()) * (1.0 + ROUNDING);
  const auto limit = static_cast<float> (all * all);
  const PointGrid &grid = *table_->grid;
  const float *x = grid.coordinates (0).data (), *y = grid.coordinates (1).data (), *z = grid.coordinates (2).data ();
  const auto cx = static_cast<float> (center[0]), cy = static_cast<float> (center[1]),
             cz = static_cast<float> (center[2]);
  std::size_t kept = 0;
  grid.visitNear (center, all,
                  [&] (std::size_t first, std::size_t last)
                  {
                    if (places_.size () <= kept + (last - first))
                    {
                      places_.resize (2 * (kept + (last - first)) + 1);
                      squared_.resize (places_.size ());
                    }
                    for (std::size_t place = first; place < last; ++place)
                    {
                      const float dx = x[place] - cx, dy = y[place] - cy, dz = z[place] - cz;
                      const float squared = dx * dx + dy * dy + dz * dz;
                      places_[kept] = static_cast<std::uint32_t> (place);
                      squared_[kept] = squared;
                      kept += squared <= limit ? 1 : 0;
                    }
                  });
  found_ = kept;
}

/** \brief The sharp surfaces that may add terms somewhere in the ball. */
void
BlockField::gatherSharpSurfaces ()
{
  near_surfaces_.clear ();
  const double reach = reach_ + field_.largestOffset ();
  const Eigen::Vector3d center = center_ + field_.points ().origin;
  for (const SharpSurface::ConstPtr &surface : field_.enrichingSurfaces ())
  {
    if (surface->isAbsentIn (center, reach))
      continue;
    const SpaceWarp *warp = nullptr;
    const bool is_plane = planeBehind (*surface, &warp) != nullptr && warp == nullptr;
    if (!is_plane || std::abs (surface->theta (center)) <= reach)
      near_surfaces_.emplace_back (surface.get (), is_plane);
  }
}

bool
BlockField::isPlainAt (const Eigen::Vector3d &x) const
{
  if (has_separations_ && groups_.hasSeparationAt (x))
    return false;
  // All nodes in the support lie on one side of a plane that is farther than they are.
  const bool is_function = field_.supportSize ().kind () == SupportSize::Kind::FUNCTION;
  const double radius = (is_function ? reach_ : center_radius_) + (x - center_).norm ();
  const double reach = (radius + field_.largestOffset ()) * (1.0 + ROUNDING);
  return std::all_of (near_surfaces_.begin (), near_surfaces_.end (),
                      [&] (const auto &near)
                      { return near.second && std::abs (near.first->theta (x + field_.points ().origin)) > reach; });
}

/** \brief The gathered nodes as the lanes see them; off-surface points after the nodes. */
void
BlockField::copyNodes ()
{
  const auto per_node = static_cast<std::size_t> (field_.valuesPerNode ());
  node_count_ = per_node * found_;
  const bool has_values = field_.hasNodeValues () || per_node > 1;
  const bool has_confidences = !table_->confidences.empty ();
  for (std::size_t a = 0; a < 3; ++a)
  {
    positions_[a].resize (node_count_ + lanes::MAX_WIDTH);
    normals_[a].resize (node_count_);
    const std::vector<float> &from = table_->grid->coordinates (static_cast<int> (a));
    const auto center = static_cast<float> (center_[static_cast<Eigen::Index> (a)]);
    const auto scale = static_cast<float> (inverse_unit_);
    for (std::size_t i = 0; i < found_; ++i)
    {
      positions_[a][i] = (from[places_[i]] - center) * scale;
      normals_[a][i] = table_->normals[a][places_[i]];
    }
  }
  confidences_.resize (has_confidences ? node_count_ : 0);
  for (std::size_t i = 0; i < confidences_.size (); ++i)
    confidences_[i] = table_->confidences[places_[i % found_]];
  lambdas_.resize (has_values ? node_count_ : 0);
  for (std::size_t i = 0; i < lambdas_.size (); ++i)
    lambdas_[i] = static_cast<float> (inverse_unit_ * field_.nodeValue (nodeAt (i % found_), sideOf (i)));
  for (std::size_t i = found_; i < node_count_; ++i)
    for (std::size_t a = 0; a < 3; ++a)
    {
      normals_[a][i] = normals_[a][i % found_];
      const auto offset = static_cast<float> (sideOf (i) * inverse_unit_ * field_.offsetOf (nodeAt (i % found_)));
      positions_[a][i] = positions_[a][i % found_] + offset * normals_[a][i];
    }
}

/** \brief Attributes are wanted at few points only. */
void
BlockField::copyAttributes ()
{
  const OrientedPoints &points = field_.points ();
  const auto channels = static_cast<std::size_t> (points.channels);
  node_attributes_.resize (channels * node_count_);
  for (std::size_t c = 0; c < channels; ++c)
    for (std::size_t i = 0; i < node_count_; ++i)
      node_attributes_[c * node_count_ + i] =
          points.attributes[static_cast<std::size_t> (nodeAt (i % found_)) * channels + c];
}

void
BlockField::clearPoints ()
{
  count_ = 0;
}

void
BlockField::addPoint (const Eigen::Vector3d &x)
{
  if (points_[0].size () < count_ + lanes::MAX_WIDTH)
    resizePoints (2 * (count_ + lanes::MAX_WIDTH));
  for (std::size_t a = 0; a < 3; ++a)
  {
    const auto axis = static_cast<Eigen::Index> (a);
    points_[a][count_] = static_cast<float> ((x[axis] - center_[axis]) * inverse_unit_);
  }
  ++count_;
}

void
BlockField::resizePoints (std::size_t size)
{
  for (auto *arrays : {&points_, &growths_, &gradients_})
    for (std::vector<float> &array : *arrays)
      array.resize (size);
  for (std::vector<float> *array : {&bounds_, &guesses_, &values_, &radii_, &border_offsets_})
    array->resize (size);
  in_reach_.resize (size);
  states_.resize (size);
  nearest_.resize (size);
  supports_.resize (size);
  attributes_.resize (size * static_cast<std::size_t> (field_.points ().channels));
}

/** \brief What is known of ε at the points; the last lanes repeat the last point. */
void
BlockField::setRadii ()
{
  for (std::size_t i = count_; i < padded (); ++i)
    for (std::vector<float> &coordinates : points_)
      coordinates[i] = coordinates[count_ - 1];
  const SupportSize &size = field_.supportSize ();
  const auto radius = static_cast<float> (center_radius_ * inverse_unit_);
  for (std::size_t i = 0; i < padded (); ++i)
  {
    const Eigen::Vector3f x (points_[0][i], points_[1][i], points_[2][i]);
    bounds_[i] = guesses_[i] = radius;
    if (size.kind () == SupportSize::Kind::NEAREST)
      bounds_[i] = (radius + x.norm ()) * static_cast<float> (1.0 + ROUNDING); // ε is 1-Lipschitz
    if (size.kind () != SupportSize::Kind::FUNCTION)
      continue;
    const Eigen::Vector3d position = center_ + unit_ * x.cast<double> ();
    bounds_[i] = static_cast<float> (size.radiusAt (position) * inverse_unit_);
    const Eigen::Vector3d growth = size.radiusGradientAt (position);
    for (std::size_t a = 0; a < 3; ++a)
      growths_[a][i] = static_cast<float> (growth[static_cast<Eigen::Index> (a)]);
  }
}

lanes::Nodes
BlockField::nodes () const
{
  lanes::Nodes nodes{};
  nodes.count = node_count_;
  nodes.on_surface = found_;
  nodes.x = positions_[0].data ();
  nodes.y = positions_[1].data ();
  nodes.z = positions_[2].data ();
  nodes.nx = normals_[0].data ();
  nodes.ny = normals_[1].data ();
  nodes.nz = normals_[2].data ();
  nodes.lambda = lambdas_.empty () ? nullptr : lambdas_.data ();
  nodes.confidence = confidences_.empty () ? nullptr : confidences_.data ();
  nodes.attributes = node_attributes_.data ();
  nodes.channels = settings_.gradients ? static_cast<std::size_t> (field_.points ().channels) : 0;
  return nodes;
}

void
BlockField::evaluate (bool gradients)
{
  if (count_ == 0)
    return;
  settings_.gradients = gradients;
  if (gradients)
    copyAttributes ();
  setRadii ();
  list_.resize (std::max (list_.size (), node_count_ + 1));
  rows_.resize (std::max (rows_.size (), lanes::MAX_WIDTH * (found_ + 1)));
  lanes::Points points{
      count_, points_[0].data (), points_[1].data (), points_[2].data (), bounds_.data (), guesses_.data (),
      {},     attributesStride ()};
  if (field_.supportSize ().kind () == SupportSize::Kind::FUNCTION)
    for (std::size_t a = 0; a < 3; ++a)
      points.growth[a] = growths_[a].data ();
  const lanes::Samples samples{values_.data (),
                               radii_.data (),
                               in_reach_.data (),
                               states_.data (),
                               field_.faces () != nullptr ? nearest_.data () : nullptr,
                               {gradients_[0].data (), gradients_[1].data (), gradients_[2].data ()},
                               border_offsets_.data (),
                               attributes_.data (),
                               supports_.data ()};
  engine_.evaluate (settings_, nodes (), points, {list_.data (), rows_.data ()}, samples);
  evaluations_ += count_;
  for (std::size_t i = 0; i < count_; ++i)
    support_nodes_ += supports_[i];
  if (field_.supportSize ().kind () == SupportSize::Kind::FUNCTION)
    refuseUncovered ();
}

/** \brief A radius that is a function may reach farther than was gathered for: see Support::covers (). */
void
BlockField::refuseUncovered ()
{
  for (std::size_t i = 0; i < count_; ++i)
  {
    const Eigen::Vector3f x (points_[0][i], points_[1][i], points_[2][i]);
    if (unit_ * static_cast<double> (x.norm () + bounds_[i]) > reach_ * (1.0 + ROUNDING))
      states_[i] = lanes::State::UNSETTLED;
  }
}

int
BlockField::face (std::size_t point) const
{
  return field_.faces () == nullptr ? -1 : field_.faces ()->faceOf (nodeAt (nearest_[point]));
}

} // namespace erkpa
