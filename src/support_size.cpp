// SPDX-License-Identifier: BSD-3-Clause
#include "support_size.h"

#include "found_nodes.h"
#include "threads.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief The ramp as a function over the nodes' extent, local frame; it stays at its ends beyond them. */
RadiusFunction
functionOf (const RadiusRamp &ramp, const OrientedPoints &points)
{
  float low = std::numeric_limits<float>::max (), high = -low;
  for (const Eigen::Vector3f &p : points.positions)
  {
    low = std::min (low, p[ramp.axis]);
    high = std::max (high, p[ramp.axis]);
  }
  const double start = low, length = std::max (static_cast<double> (high) - start, 1e-30);
  return [ramp, start, length] (const Eigen::Vector3d &x)
  {
    const double share = std::clamp ((x[ramp.axis] - start) / length, 0.0, 1.0);
    return ramp.from + share * (ramp.to - ramp.from);
  };
}

template <typename RadiusOfT>
double
medianRadius (const OrientedPoints &points, RadiusOfT radius_of)
{
  constexpr std::size_t SAMPLE = 1000;
  const std::size_t step = std::max<std::size_t> (1, points.size () / SAMPLE);
  std::vector<double> radii;
  for (std::size_t i = 0; i < points.size (); i += step)
  {
    const double radius = radius_of (i);
    radii.push_back (radius > 0.0 ? radius : 0.0); // nothing that is no number must be sorted
  }
  const auto middle = radii.begin () + static_cast<std::ptrdiff_t> (radii.size () / 2);
  std::nth_element (radii.begin (), middle, radii.end ());
  return *middle;
}

} // namespace

SupportSize::Kind
SupportSize::kindOf (const OrientedPoints &points, const FieldOptions &options)
{
  if (!points.radii.empty ())
    return Kind::PER_NODE;
  if (options.radius_function || options.radius_ramp.axis >= 0)
    return Kind::FUNCTION;
  return options.radius > 0.0 ? Kind::CONSTANT : Kind::NEAREST;
}

SupportSize::SupportSize (const OrientedPoints &points, const FieldOptions &options, double spacing)
    : points_ (points), kind_ (kindOf (points, options)), k_ (options.k), radius_ (options.radius)
{
  switch (kind_)
  {
    case Kind::NEAREST:
      typical_ = spacing * std::sqrt (k_ / M_PI);
      break;
    case Kind::CONSTANT:
      typical_ = radius_;
      break;
    case Kind::FUNCTION:
      if (options.radius_function)
        function_ = [user = options.radius_function, origin = points.origin] (const Eigen::Vector3d &x)
        { return user (x + origin); };
      else
        function_ = functionOf (options.radius_ramp, points);
      typical_ =
          medianRadius (points_, [&] (std::size_t i) { return radiusAt (points_.positions[i].cast<double> ()); });
      break;
    case Kind::PER_NODE:
      typical_ = medianRadius (points_, [&] (std::size_t i) { return static_cast<double> (points_.radii[i]); });
      sortIntoOctaves ();
      break;
  }
}

double
SupportSize::radiusAt (const Eigen::Vector3d &x) const
{
  return kind_ == Kind::FUNCTION ? function_ (x) : radius_;
}

Eigen::Vector3d
SupportSize::radiusGradientAt (const Eigen::Vector3d &x) const
{
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero ();
  if (kind_ != Kind::FUNCTION)
    return gradient;
  const double step = 1e-4 * function_ (x);
  for (int a = 0; a < 3; ++a)
  {
    const Eigen::Vector3d to = step * Eigen::Vector3d::Unit (a);
    gradient[a] = (function_ (x + to) - function_ (x - to)) / (2.0 * step);
  }
  return gradient;
}

std::vector<float>
SupportSize::radiiOfNodes (const NeighborSearch &search, int threads) const
{
  if (kind_ == Kind::PER_NODE)
    return points_.radii;
  std::vector<float> radii (points_.size ());
  parallelFor (
      radii.size (), threads, [] { return FoundNodes (); },
      [&] (FoundNodes &found, std::size_t i)
      {
        if (kind_ != Kind::NEAREST)
        {
          radii[i] = static_cast<float> (radiusAt (points_.positions[i].cast<double> ()));
          return;
        }
        search.nearestK (points_.positions[i], k_, found.nodes, found.squared);
        radii[i] = found.squared.empty ()
                       ? 0.0f
                       : std::sqrt (*std::max_element (found.squared.begin (), found.squared.end ()));
      });
  return radii;
}

void
SupportSize::sortIntoOctaves ()
{
  std::map<int, Octave> octaves;
  for (std::size_t i = 0; i < points_.size (); ++i)
  {
    const auto radius = static_cast<double> (points_.radii[i]);
    Octave &octave = octaves[std::ilogb (radius)];
    octave.nodes.push_back (static_cast<int> (i));
    octave.largest = std::max (octave.largest, radius);
  }
  for (auto &[exponent, octave] : octaves)
  {
    std::vector<Eigen::Vector3f> positions;
    for (const int node : octave.nodes)
      positions.push_back (points_.positions[static_cast<std::size_t> (node)]);
    octave.search = makeKdTreeSearch (positions);
    octaves_.push_back (std::move (octave));
  }
}

void
SupportSize::nodesReaching (const Eigen::Vector3d &center, double extent, std::vector<int> &nodes) const
{
  nodes.clear ();
  std::vector<int> found;
  std::vector<float> squared;
  for (const Octave &octave : octaves_)
  {
    constexpr double ROUNDING = 1e-5; // searches measure in float
    const double rounding = ROUNDING * (octave.largest + extent + center.norm ());
    octave.search->withinRadius (center.cast<float> (), octave.largest + extent + rounding, found, squared);
    for (std::size_t i = 0; i < found.size (); ++i)
    {
      const int node = octave.nodes[static_cast<std::size_t> (found[i])];
      const double reach = static_cast<double> (points_.radii[static_cast<std::size_t> (node)]) + extent + rounding;
      if (static_cast<double> (squared[i]) <= reach * reach)
        nodes.push_back (node);
    }
  }
}

} // namespace erkpa
