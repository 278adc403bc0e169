// SPDX-License-Identifier: BSD-3-Clause
#include "moment_lattice.h"

#include "block_field.h"
#include "block_nodes.h"
#include "lane_memory.h"
#include "lane_settings.h"
#include "support_size.h"
#include "threads.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace erkpa
{

namespace
{

/** \brief Whether the field's sums can be kept at points of a lattice at all. */
bool
canKeepSums (const ImplicitField &field)
{
  const FieldOptions &options = field.options ();
  // Squares with functional values ask for the nodes nearly everywhere. Values of collocation are those of exact sums.
  return BlockField::canEvaluate (field) && field.faces () == nullptr && options.flatten >= 1.0 &&
         field.supportSize ().kind () == SupportSize::Kind::CONSTANT &&
         options.interpolation != Interpolation::COLLOCATION &&
         (options.order == Order::LINEAR ||
          (options.order == Order::SPHERICAL && options.constraint != Constraint::FUNCTIONAL));
}

/** \brief The fewest cells of the lattice along a support radius that leave weights no farther off than \a tolerance; 0
 * where none do. */
double
cellsPerRadius (const Kernel &kernel, double tolerance)
{
  constexpr double FEWEST = 4.0, MOST = 64.0;
  for (double cells = FEWEST; cells <= MOST; cells += 0.25)
    if (MomentLattice::errorOf (kernel, cells) <= tolerance)
      return cells;
  return 0.0;
}

/** \brief The lowest cell of the brick of a cell. */
Eigen::Array3i
firstOf (const Eigen::Array3i &cell)
{
  return cell.unaryExpr ([] (int c) { return c & ~(MomentLattice::SIDE - 1); });
}

/** \brief A cell of a brick, from the lowest one. */
Eigen::Array3i
pointAt (int place)
{
  return {place & 3, (place >> 2) & 3, place >> 4};
}

/** \brief The cells of a brick in its i-th plane across an axis. */
std::uint64_t
planeOf (int axis, int i)
{
  constexpr std::array<std::uint64_t, 3> LOWEST{0x1111111111111111u, 0x000f000f000f000fu, 0x000000000000ffffu};
  constexpr std::array<int, 3> STEPS{1, 4, 16};
  const auto a = static_cast<std::size_t> (axis);
  return LOWEST[a] << (STEPS[a] * i);
}

/** \brief The number of the brick of a cell. */
std::uint64_t
keyOf (const Eigen::Array3i &cell)
{
  std::uint64_t key = 0;
  for (const int c : cell)
    key = key << 21 | (static_cast<std::uint64_t> (c >> 2) & 0x1fffff);
  return key;
}

} // namespace

double
MomentLattice::errorOf (const Kernel &kernel, double per_radius)
{
  constexpr std::array<double, 4> WEIGHTS{-1.0 / 16.0, 9.0 / 16.0, 9.0 / 16.0, -1.0 / 16.0}; // in the middle
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k)
      {
        const auto away = [] (std::size_t n) { return static_cast<double> (n) - 1.5; };
        const double t = Eigen::Vector3d (away (i), away (j), away (k)).norm () / per_radius;
        sum += WEIGHTS[i] * WEIGHTS[j] * WEIGHTS[k] * (t < 1.0 ? kernel.weight (t) : 0.0);
      }
  return std::abs (sum / kernel.weight (0.0) - 1.0);
}

std::unique_ptr<MomentLattice>
MomentLattice::make (const ImplicitField &field, const PolygonizerOptions &options, double voxel_size,
                     const lanes::Engine &engine)
{
  // With fewer nodes in a support, sums over them take no longer, and far off the nodes they are asked for anyway: both
  // were measured.
  constexpr double FEWEST_NODES = 600.0, FARTHEST = 0.2;
  constexpr double LEAST = 1.5; // voxels
  if (!(options.moment_tolerance > 0.0) || !canKeepSums (field))
    return nullptr;
  const double radius = field.typicalRadius (), in_spacings = radius / field.spacing ();
  const double cells = cellsPerRadius (field.kernel (), options.moment_tolerance);
  const double spacing = cells > 0.0 ? radius / cells : 0.0;
  if (!(M_PI * in_spacings * in_spacings >= FEWEST_NODES) || std::abs (options.iso_level) > FARTHEST * radius ||
      spacing < LEAST * voxel_size)
    return nullptr;
  return std::unique_ptr<MomentLattice> (new MomentLattice (field, options, spacing, engine));
}

MomentLattice::MomentLattice (const ImplicitField &field, const PolygonizerOptions &options, double spacing,
                              const lanes::Engine &engine)
    : field_ (field), options_ (options), engine_ (engine), spacing_ (spacing),
      columns_ (engine.lattice->columns (laneSettingsOf (field)) + static_cast<std::size_t> (field.points ().channels))
{
}

const MomentLattice::Brick *
MomentLattice::brickOf (const Eigen::Array3i &cell) const
{
  const auto found = index_.find (keyOf (cell));
  return found != index_.end () ? found->second : nullptr;
}

MomentLattice::Brick &
MomentLattice::placeBrick (const Eigen::Array3i &first)
{
  Brick *&brick = index_[keyOf (first)];
  if (brick == nullptr)
  {
    // A middle that floats can say: see BlockField::gather ().
    const Eigen::Vector3d middle = spacing_ * (first.cast<double> () + 0.5 * (SIDE - 1)).matrix ();
    bricks_.push_back ({first, middle.cast<float> ().cast<double> ()});
    brick = &bricks_.back ();
  }
  return *brick;
}

void
MomentLattice::listCell (const Eigen::Vector3d &x, std::vector<Cells> &list) const
{
  const Eigen::Array3i cell = cellOf (x), first = firstOf (cell);
  if (list.empty () || (list.back ().first != first).any ())
    list.push_back ({first, 0});
  list.back ().cells |= bitOf (cell);
}

/** \brief What a thread sums up with. */
struct MomentLattice::Worker
{
  Worker (const ImplicitField &field, const PolygonizerOptions &options, const lanes::Engine &engine)
      : settings (laneSettingsOf (field)), unit (field.typicalRadius ()), has_attributes (field.points ().channels > 0),
        nodes (field, engine, unit)
  {
    settings.reach = static_cast<float> (options.reach);
    settings.offset = static_cast<float> (std::abs (options.iso_level) / unit);
    radii.fill (1.0f);
  }

  lanes::Points
  points (std::size_t count) const
  {
    return {count, positions[0].data (), positions[1].data (), positions[2].data (), radii.data (), radii.data (), {},
            POINTS};
  }

  lanes::Settings settings;
  double unit; // of the lanes' lengths
  bool has_attributes;
  BlockNodes nodes;
  LaneMemory memory;
  std::array<std::array<float, POINTS>, 3> positions{};
  std::array<float, POINTS> radii{};
  std::vector<float> sums;
};

void
MomentLattice::cover (const std::vector<Cells> &list)
{
  for (const Cells &cells : list)
  {
    Brick &brick = placeBrick (cells.first);
    std::uint64_t fresh = cells.cells & ~brick.cells;
    brick.cells |= fresh;
    for (; fresh != 0; fresh &= fresh - 1)
      wantPointsOf (cells.first + pointAt (__builtin_ctzll (fresh)));
  }
  std::vector<Brick *> wanting;
  for (Brick &brick : bricks_)
    if ((brick.wanted & ~brick.points) != 0)
    {
      wanting.push_back (&brick);
      size_ += static_cast<std::size_t> (__builtin_popcountll (brick.wanted & ~brick.points));
    }
  parallelFor (
      wanting.size (), options_.threads, [this] { return Worker (field_, options_, engine_); },
      [&] (Worker &worker, std::size_t i) { sumUp (worker, *wanting[i]); });
}

/** \brief The four points along each axis around a cell are in two bricks at most. */
void
MomentLattice::wantPointsOf (const Eigen::Array3i &cell)
{
  const Eigen::Array3i low = cell - 1, high = cell + 2, low_brick = firstOf (low), high_brick = firstOf (high);
  Eigen::Array3i brick;
  for (brick[2] = low_brick[2]; brick[2] <= high_brick[2]; brick[2] += SIDE)
    for (brick[1] = low_brick[1]; brick[1] <= high_brick[1]; brick[1] += SIDE)
      for (brick[0] = low_brick[0]; brick[0] <= high_brick[0]; brick[0] += SIDE)
      {
        std::uint64_t points = ~std::uint64_t (0);
        for (int axis = 0; axis < 3; ++axis)
        {
          std::uint64_t along = 0;
          for (int i = std::max (low[axis], brick[axis]); i <= std::min (high[axis], brick[axis] + SIDE - 1); ++i)
            along |= planeOf (axis, i - brick[axis]);
          points &= along;
        }
        placeBrick (brick).wanted |= points;
      }
}

/** \brief Only those points of a brick that have no sums yet. */
void
MomentLattice::sumUp (Worker &worker, Brick &brick) const
{
  std::array<std::size_t, POINTS> places{};
  std::size_t count = 0;
  for (std::uint64_t left = brick.wanted & ~brick.points; left != 0; left &= left - 1)
    places[count++] = static_cast<std::size_t> (__builtin_ctzll (left));
  for (std::size_t i = 0; i < POINTS; ++i) // the last vector is filled up with the last point
  {
    const Eigen::Array3i point = brick.first + pointAt (static_cast<int> (places[std::min (i, count - 1)]));
    const Eigen::Vector3f x =
        ((spacing_ * point.cast<double> ().matrix () - brick.center) / worker.unit).cast<float> ();
    for (std::size_t a = 0; a < 3; ++a)
      worker.positions[a][i] = x[static_cast<Eigen::Index> (a)];
  }
  const double reach = worker.unit + std::sqrt (3.0) * 0.5 * (SIDE - 1) * spacing_;
  worker.nodes.lookAround (brick.center, reach);
  worker.nodes.copyWithin (reach);
  if (worker.has_attributes)
    worker.nodes.copyAttributes ();
  const lanes::Nodes nodes = worker.nodes.view (worker.has_attributes);
  worker.sums.resize (columns_ * POINTS);
  engine_.lattice->sum (worker.settings, nodes, worker.points (count), worker.memory.scratchFor (nodes.count), POINTS,
                        worker.sums.data ());
  brick.sums.resize (columns_ * POINTS + SIDE); // absent points, and some after the last one, are read: weights of zero
  for (std::size_t column = 0; column < columns_; ++column)
    for (std::size_t i = 0; i < count; ++i)
      brick.sums[column * POINTS + places[i]] = worker.sums[column * POINTS + i];
  brick.points = brick.wanted;
}

} // namespace erkpa
