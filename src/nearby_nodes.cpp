// SPDX-License-Identifier: BSD-3-Clause
#include "nearby_nodes.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace erkpa
{

namespace
{

constexpr double ROUNDING = 1e-5; // searches measure in float

} // namespace

std::size_t
NearbyNodes::endOfRun (std::size_t first, std::size_t last) const
{
  const auto side = static_cast<float> (grid_.cell ());
  Eigen::AlignedBox3f box (positionAt (first));
  std::size_t end = first + 1;
  for (; end < last; ++end)
  {
    box.extend (positionAt (end));
    if (!(box.sizes ().maxCoeff () <= side))
      break;
  }
  return end;
}

void
NearbyNodes::findBall (std::size_t first, std::size_t last, Eigen::Vector3d &center, double &radius) const
{
  Eigen::AlignedBox3f box;
  for (std::size_t place = first; place < last; ++place)
    box.extend (positionAt (place));
  center = box.center ().cast<double> ();
  radius = 0.5 * static_cast<double> (box.diagonal ().norm ());
}

void
NearbyNodes::gather (std::size_t first, std::size_t last, double reach)
{
  Eigen::Vector3d center;
  double radius = 0.0;
  findBall (first, last, center, radius);
  const double exact = radius + reach, all = exact + ROUNDING * (exact + center.norm ());
  grid_.findWithin (center, all, found_);
  copyColumns ();
}

void
NearbyNodes::copyColumns ()
{
  for (std::vector<float> &column : columns_)
    column.resize (std::max (column.size (), found_.count));
  for (std::size_t i = 0; i < found_.count; ++i)
  {
    const Eigen::Vector3f &normal = points_.normals[static_cast<std::size_t> (node (i))];
    for (std::size_t a = 0; a < 3; ++a)
    {
      columns_[a][i] = grid_.coordinates (static_cast<int> (a))[found_.places[i]];
      columns_[3 + a][i] = normal[static_cast<Eigen::Index> (a)];
    }
  }
}

} // namespace erkpa
