// SPDX-License-Identifier: BSD-3-Clause
#include "orientation_planes.h"

#include "noise.h"
#include "threads.h"

#include <cmath>

namespace erkpa
{

namespace
{

/** \brief How far a plane through the first neighbour must reach out for \a count of them. */
double
leastHeight (const FacetNeighborhood &near, double spacing, std::size_t count)
{
  float least = HUGE_VALF;
  std::vector<float> heights (near.positions.size ());
  visitPlanes (near, spacing,
               [&] (const Eigen::Vector3f &normal)
               {
                 for (std::size_t j = 0; j < heights.size (); ++j)
                   heights[j] = std::abs (normal.dot (near.positions[j] - near.positions.front ()));
                 const auto last = heights.begin () + static_cast<std::ptrdiff_t> (count - 1);
                 std::nth_element (heights.begin (), last, heights.end ());
                 least = std::min (least, *last);
               });
  return least;
}

} // namespace

double
noiseOfSheets (const OrientedPoints &points, const NeighborSearch &search, double spacing, int threads)
{
  constexpr std::size_t SAMPLE = 2000, ON_IT = 8;
  constexpr double EXPECTED = 0.33; // where the noise is 1: of the best plane of many
  const std::size_t step = std::max<std::size_t> (1, points.size () / SAMPLE);
  std::vector<double> heights (points.size () / step);
  parallelFor (
      heights.size (), threads, [] { return FacetNeighborhood (); },
      [&] (FacetNeighborhood &near, std::size_t i)
      {
        near.gatherAll (search, points.positions, i * step, CLEAN_SUPPORT);
        near.sort (points.positions, points.positions[i * step]);
        heights[i] = near.nodes.size () > ON_IT ? leastHeight (near, spacing, ON_IT) : 0.0;
      });
  if (heights.empty ())
    return 0.0;
  const auto middle = heights.begin () + static_cast<std::ptrdiff_t> (heights.size () / 2);
  std::nth_element (heights.begin (), middle, heights.end ());
  return *middle / EXPECTED;
}

} // namespace erkpa
