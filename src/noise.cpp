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

/** \brief Whether a node is on the same side of thin walls as another, as far as normals are known. */
bool
looksTheSameWay (const OrientedPoints &points, int node, int other)
{
  return points.normals.empty () ||
         points.normals[static_cast<std::size_t> (node)].dot (points.normals[static_cast<std::size_t> (other)]) >= 0.0f;
}

/** \brief Standard deviation of the nearest \a most neighbours along their thinnest direction, but for the other sides
 * of thin walls, which are no noise. */
double
thicknessOf (const OrientedPoints &points, const SortedNeighbors &neighbors, std::size_t most)
{
  const int first = neighbors.front ().second;
  const Eigen::Vector3f &node = points.positions[static_cast<std::size_t> (first)];
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < neighbors.size () && used.size () < most; ++i)
    if (looksTheSameWay (points, first, neighbors[i].second))
      used.push_back (static_cast<std::size_t> (neighbors[i].second));
  const auto count = static_cast<double> (used.size ());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero ();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero ();
  for (const std::size_t neighbor : used)
  {
    const Eigen::Vector3d p = (points.positions[neighbor] - node).cast<double> ();
    mean += p / count;
    products += p * p.transpose () / count;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver (products - mean * mean.transpose (),
                                                               Eigen::EigenvaluesOnly);
  return std::sqrt (std::max (0.0, solver.eigenvalues ()[0]));
}

constexpr std::array<int, 7> SIZES{CLEAN_SUPPORT, 28, 40, 56, 80, 112, 160};

/** \brief What supports of those sizes make at a node; negative where there are fewer neighbours. */
struct SizesAtNode
{
  SizesAtNode ()
  {
    tilts.fill (-1.0);
    own.fill (-1.0);
  }

  std::array<double, SIZES.size ()> tilts; ///< radians
  std::array<double, SIZES.size ()> own;   ///< neighbours on the same side of thin walls
};

SizesAtNode
measureSizes (const OrientedPoints &points, const SortedNeighbors &neighbors)
{
  SizesAtNode sizes;
  const double noise = thicknessOf (points, neighbors, 10);
  std::size_t seen = 0, own = 0;
  for (std::size_t i = 0; i < SIZES.size () && SIZES[i] <= static_cast<int> (neighbors.size ()); ++i)
  {
    for (; seen < static_cast<std::size_t> (SIZES[i]); ++seen)
      own += looksTheSameWay (points, neighbors.front ().second, neighbors[seen].second) ? 1 : 0;
    sizes.own[i] = static_cast<double> (own);
    sizes.tilts[i] = noise / std::sqrt (static_cast<double> (neighbors[seen - 1].first) * SIZES[i]);
  }
  return sizes;
}

double
medianOf (const std::vector<SizesAtNode> &nodes, std::array<double, SIZES.size ()> SizesAtNode::*what, std::size_t size)
{
  std::vector<double> values;
  values.reserve (nodes.size ());
  for (const SizesAtNode &node : nodes)
    values.push_back ((node.*what)[size]);
  return median (std::move (values));
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
  constexpr double LEAST_OWN = 0.8;                    // of CLEAN_SUPPORT
  const std::vector<SizesAtNode> nodes =
      measureSample (points.positions, search, 400, SIZES.back (), threads, SizesAtNode (),
                     [&] (const SortedNeighbors &neighbors) { return measureSizes (points, neighbors); });
  const auto least = [&] (double most_tilt)
  {
    for (std::size_t i = 0; i + 1 < SIZES.size (); ++i)
    {
      const bool has_next = static_cast<std::size_t> (SIZES[i + 1]) <= points.size (); // that nodes have neighbours for
      if (!has_next || (medianOf (nodes, &SizesAtNode::tilts, i) <= most_tilt &&
                        medianOf (nodes, &SizesAtNode::own, i) >= LEAST_OWN * CLEAN_SUPPORT))
        return SIZES[i];
    }
    return SIZES.back ();
  };
  return {least (TILT), least (WITHIN_FACES)};
}

} // namespace erkpa
