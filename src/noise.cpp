// SPDX-License-Identifier: BSD-3-Clause
#include "noise.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace erkpa
{

namespace
{

/** \brief Calls visit (neighbours sorted by distance, squared distances) for nodes spread over the cloud. */
template <typename VisitT>
void
visitSample (const std::vector<Eigen::Vector3f> &positions, const NeighborSearch &search, std::size_t count, int k,
             VisitT visit)
{
  const std::size_t step = std::max<std::size_t> (1, positions.size () / count);
  std::vector<int> indices;
  std::vector<float> squared;
  for (std::size_t i = 0; i < positions.size (); i += step)
  {
    search.nearestK (positions[i], k, indices, squared);
    std::vector<std::pair<float, int>> order;
    for (std::size_t j = 0; j < indices.size (); ++j)
      order.emplace_back (squared[j], indices[j]);
    std::sort (order.begin (), order.end ());
    if (!order.empty ())
      visit (order);
  }
}

double
median (std::vector<double> &values)
{
  if (values.empty ())
    return 0.0;
  const auto middle = values.begin () + static_cast<std::ptrdiff_t> (values.size () / 2);
  std::nth_element (values.begin (), middle, values.end ());
  return *middle;
}

/** \brief Standard deviation of the nearest \a count neighbours along their thinnest direction. */
double
thicknessOf (const OrientedPoints &points, const std::vector<std::pair<float, int>> &neighbors, std::size_t count)
{
  count = std::min (count, neighbors.size ());
  const Eigen::Vector3f &node = points.positions[static_cast<std::size_t> (neighbors.front ().second)];
  Eigen::Vector3d mean = Eigen::Vector3d::Zero ();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero ();
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto neighbor = static_cast<std::size_t> (neighbors[i].second);
    const Eigen::Vector3d p = (points.positions[neighbor] - node).cast<double> ();
    mean += p / static_cast<double> (count);
    products += p * p.transpose () / static_cast<double> (count);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver (products - mean * mean.transpose (),
                                                               Eigen::EigenvaluesOnly);
  return std::sqrt (std::max (0.0, solver.eigenvalues ()[0]));
}

} // namespace

double
measureSpacing (const std::vector<Eigen::Vector3f> &positions, const NeighborSearch &search)
{
  constexpr int NEIGHBORS = 8;
  std::vector<double> spacings;
  visitSample (positions, search, 2000, NEIGHBORS + 1,
               [&] (const auto &neighbors)
               {
                 const double others =
                     std::max (1.0, static_cast<double> (neighbors.size ()) - 1.0); // the first is the node
                 spacings.push_back (std::sqrt (M_PI * neighbors.back ().first / others));
               });
  return median (spacings);
}

int
chooseSupportSize (const OrientedPoints &points, const NeighborSearch &search)
{
  constexpr double TILT = 0.01; // radians
  constexpr std::array<int, 7> SIZES{CLEAN_SUPPORT, 28, 40, 56, 80, 112, 160};
  std::array<std::vector<double>, SIZES.size ()> tilts;
  visitSample (points.positions, search, 400, SIZES.back (),
               [&] (const auto &neighbors)
               {
                 const double noise = thicknessOf (points, neighbors, 10);
                 for (std::size_t i = 0; i < SIZES.size () && SIZES[i] <= static_cast<int> (neighbors.size ()); ++i)
                 {
                   const double radius = std::sqrt (neighbors[static_cast<std::size_t> (SIZES[i] - 1)].first);
                   tilts[i].push_back (noise / (radius * std::sqrt (SIZES[i])));
                 }
               });
  for (std::size_t i = 0; i < SIZES.size (); ++i)
    if (tilts[i].empty () || median (tilts[i]) <= TILT)
      return SIZES[i];
  return SIZES.back ();
}

} // namespace erkpa
