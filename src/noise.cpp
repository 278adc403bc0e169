// SPDX-License-Identifier: BSD-3-Clause
#include "noise.h"

#include "threads.h"

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

using SortedNeighbors = std::vector<std::pair<float, int>>; ///< squared distance, node

/** \brief The values of measure (sorted neighbours) for nodes spread over the cloud.
 * \param[in] none what there is where a node has no neighbours
 */
template <typename ValueT, typename MeasureT>
std::vector<ValueT>
measureSample (const std::vector<Eigen::Vector3f> &positions, const NeighborSearch &search, std::size_t count, int k,
               int threads, const ValueT &none, MeasureT measure)
{
  const std::size_t step = std::max<std::size_t> (1, positions.size () / count);
  std::vector<ValueT> values ((positions.size () + step - 1) / step, none);
  struct Query
  {
    std::vector<int> indices;
    std::vector<float> squared;
    SortedNeighbors order;
  };
  parallelFor (
      values.size (), threads, [] { return Query (); },
      [&] (Query &query, std::size_t i)
      {
        search.nearestK (positions[i * step], k, query.indices, query.squared);
        query.order.clear ();
        for (std::size_t j = 0; j < query.indices.size (); ++j)
          query.order.emplace_back (query.squared[j], query.indices[j]);
        std::sort (query.order.begin (), query.order.end ());
        if (!query.order.empty ())
          values[i] = measure (query.order);
      });
  return values;
}

/** \brief The median of the values that are known; negative ones are not. */
double
median (std::vector<double> values)
{
  values.erase (std::remove_if (values.begin (), values.end (), [] (double v) { return v < 0.0; }), values.end ());
  if (values.empty ())
    return 0.0;
  const auto middle = values.begin () + static_cast<std::ptrdiff_t> (values.size () / 2);
  std::nth_element (values.begin (), middle, values.end ());
  return *middle;
}

/** \brief Standard deviation of the nearest \a count neighbours along their thinnest direction. */
double
thicknessOf (const OrientedPoints &points, const SortedNeighbors &neighbors, std::size_t count)
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
measureSpacing (const std::vector<Eigen::Vector3f> &positions, const NeighborSearch &search, int threads)
{
  constexpr int NEIGHBORS = 8;
  return median (measureSample (positions, search, 2000, NEIGHBORS + 1, threads, -1.0,
                                [] (const SortedNeighbors &neighbors)
                                {
                                  const double others = std::max (1.0, static_cast<double> (neighbors.size ()) -
                                                                           1.0); // the first is the node
                                  return std::sqrt (M_PI * neighbors.back ().first / others);
                                }));
}

SupportSizes
chooseSupportSizes (const OrientedPoints &points, const NeighborSearch &search, int threads)
{
  constexpr double TILT = 0.01, WITHIN_FACES = 0.0085; // radians
  constexpr std::array<int, 7> SIZES{CLEAN_SUPPORT, 28, 40, 56, 80, 112, 160};
  using Tilts = std::array<double, SIZES.size ()>; // negative where there are fewer neighbours
  Tilts none;
  none.fill (-1.0);
  const std::vector<Tilts> tilts = measureSample (
      points.positions, search, 400, SIZES.back (), threads, none,
      [&] (const SortedNeighbors &neighbors)
      {
        Tilts of_node = none;
        const double noise = thicknessOf (points, neighbors, 10);
        for (std::size_t i = 0; i < SIZES.size () && SIZES[i] <= static_cast<int> (neighbors.size ()); ++i)
        {
          const double radius = std::sqrt (neighbors[static_cast<std::size_t> (SIZES[i] - 1)].first);
          of_node[i] = noise / (radius * std::sqrt (SIZES[i]));
        }
        return of_node;
      });
  std::array<double, SIZES.size ()> medians{};
  for (std::size_t i = 0; i < SIZES.size (); ++i)
  {
    std::vector<double> of_size;
    of_size.reserve (tilts.size ());
    for (const Tilts &of_node : tilts)
      of_size.push_back (of_node[i]);
    medians[i] = median (of_size);
  }
  const auto least_below = [&] (double tilt)
  {
    for (std::size_t i = 0; i + 1 < SIZES.size (); ++i)
      if (medians[i] <= tilt)
        return SIZES[i];
    return SIZES.back ();
  };
  return {least_below (TILT), least_below (WITHIN_FACES)};
}

} // namespace erkpa
