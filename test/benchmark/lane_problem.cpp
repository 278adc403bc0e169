// SPDX-License-Identifier: BSD-3-Clause
#include "lane_problem.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace bench
{

namespace
{

using erkpa::lanes::Basis;
using erkpa::lanes::MAX_WIDTH;

std::size_t
padded (std::size_t count)
{
  return (count + MAX_WIDTH - 1) / MAX_WIDTH * MAX_WIDTH;
}

int
sizeOf (Basis basis)
{
  switch (basis)
  {
    case Basis::CONSTANT:
      return 1;
    case Basis::LINEAR:
      return 4;
    case Basis::SPHERICAL:
      return 5;
    case Basis::QUADRATIC:
      break;
  }
  return 10;
}

/** \brief By basis, in the order of their names. */
double
pick (Basis basis, double constant, double linear, double spherical, double quadratic)
{
  const double values[] = {constant, linear, spherical, quadratic};
  return values[static_cast<std::size_t> (basis)];
}

/** \brief The surface about which the nodes lie, in support radii. */
double
height (double x, double y)
{
  return 0.05 * std::sin (2.0 * x) + 0.05 * y * y;
}

} // namespace

double
flopsPerPair (Basis basis, erkpa::lanes::Constraint constraint, bool gradients)
{
  const bool is_functional = constraint == erkpa::lanes::Constraint::FUNCTIONAL;
  const double n = sizeOf (basis), products = pick (basis, 1.0, 10.0, 15.0, 35.0);
  const double value = 23.0 + 2.0 * products + (is_functional ? 7.0 + 2.0 * n : 2.0 * (n - 1.0));
  const double slopes = is_functional ? pick (basis, 20.0, 13.0, 13.0, 13.0) : pick (basis, 0.0, 11.0, 23.0, 59.0);
  const double gradient = 30.0 + pick (basis, 0.0, 0.0, 0.0, 6.0) + 4.0 * (n - 1.0) + 2.0 + slopes + 15.0;
  return gradients ? value + gradient : value;
}

LaneProblem::LaneProblem (const LaneCase &what)
{
  settings_.basis = what.basis;
  settings_.constraint = what.constraint;
  settings_.kernel = erkpa::lanes::Kernel::PAPER;
  settings_.k = what.k;
  settings_.gradients = what.gradients;
  settings_.reach = 0.9f;
  settings_.min_nodes = 4;
  if (what.k == 0)
  {
    makeNodes (what.nodes, 0.8);
    makePoints (0.05);
    return;
  }
  // As the polygonizer does it: k nodes in the unit disc, a block of four grid nodes along each axis at the default
  // voxel, and all nodes gathered that may be among the nearest somewhere in its ball.
  const double k = what.k, voxel = 0.7 * std::sqrt (M_PI / k), half = 1.5 * voxel;
  const double extent = 1.2 + 2.0 * std::sqrt (3.0) * half;
  makeNodes (static_cast<std::size_t> (k * extent * extent), extent);
  makePoints (half);
}

/** \brief Nodes at random, evenly spread over a disc that is bent a little. */
void
LaneProblem::makeNodes (std::size_t count, double extent)
{
  node_count_ = count;
  for (auto *arrays : {&positions_, &normals_})
    for (std::vector<float> &array : *arrays)
      array.assign (padded (count), 0.0f);
  std::mt19937 random (17);
  std::uniform_real_distribution<double> unit (0.0, 1.0);
  for (std::size_t i = 0; i < count; ++i)
  {
    const double turn = 2.0 * M_PI * unit (random), r = extent * std::sqrt (unit (random));
    const double x = r * std::cos (turn), y = r * std::sin (turn);
    const double slope_x = 0.1 * std::cos (2.0 * x), slope_y = 0.1 * y;
    const double length = std::sqrt (1.0 + slope_x * slope_x + slope_y * slope_y);
    const double position[] = {x, y, height (x, y)}, normal[] = {-slope_x, -slope_y, 1.0};
    for (std::size_t a = 0; a < 3; ++a)
    {
      positions_[a][i] = static_cast<float> (position[a]);
      normals_[a][i] = static_cast<float> (normal[a] / length);
    }
  }
  list_.resize (count + MAX_WIDTH);
  near_.resize (erkpa::lanes::Scratch::COLUMNS * list_.size ());
  rows_.resize (MAX_WIDTH * count);
}

/** \brief A grid of points around the middle, with the radii that are known beforehand. */
void
LaneProblem::makePoints (double half)
{
  for (auto *arrays : {&points_, &gradients_})
    for (std::vector<float> &array : *arrays)
      array.resize (POINTS);
  for (std::vector<float> *array : {&bounds_, &guesses_, &values_, &radii_, &border_offsets_})
    array->assign (POINTS, 1.0f);
  in_reach_.resize (POINTS);
  states_.resize (POINTS);
  supports_.resize (POINTS);
  for (std::size_t i = 0; i < POINTS; ++i)
  {
    const std::size_t place[] = {i % 4, i / 4 % 4, i / 16};
    double squared = 0.0;
    for (std::size_t a = 0; a < 3; ++a)
    {
      const double coordinate = (2.0 / 3.0 * static_cast<double> (place[a]) - 1.0) * half;
      points_[a][i] = static_cast<float> (coordinate);
      squared += coordinate * coordinate;
    }
    if (settings_.k > 0)
      bounds_[i] = static_cast<float> (1.2 + std::sqrt (squared)); // ε is 1-Lipschitz
  }
}

void
LaneProblem::evaluate (const erkpa::lanes::Engine &engine)
{
  erkpa::lanes::Nodes nodes{};
  nodes.count = nodes.on_surface = node_count_;
  nodes.x = positions_[0].data ();
  nodes.y = positions_[1].data ();
  nodes.z = positions_[2].data ();
  nodes.nx = normals_[0].data ();
  nodes.ny = normals_[1].data ();
  nodes.nz = normals_[2].data ();
  const erkpa::lanes::Points points{
      POINTS, points_[0].data (), points_[1].data (), points_[2].data (), bounds_.data (), guesses_.data (), {},
      POINTS};
  erkpa::lanes::Samples samples{};
  samples.value = values_.data ();
  samples.radius = radii_.data ();
  samples.in_reach = in_reach_.data ();
  samples.state = states_.data ();
  samples.support = supports_.data ();
  for (std::size_t a = 0; a < 3; ++a)
    samples.gradient[a] = gradients_[a].data ();
  samples.border_offset = border_offsets_.data ();
  engine.evaluate (settings_, nodes, points, erkpa::lanes::SharpSurfaces{},
                   {list_.data (), near_.data (), rows_.data ()}, samples);
}

std::size_t
LaneProblem::pairs () const
{
  std::size_t sum = 0;
  for (const std::uint32_t support : supports_)
    sum += support;
  return sum;
}

bool
LaneProblem::isDefined () const
{
  return std::none_of (states_.begin (), states_.end (),
                       [] (erkpa::lanes::State state) { return state == erkpa::lanes::State::UNDEFINED; });
}

} // namespace bench
