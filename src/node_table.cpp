// SPDX-License-Identifier: BSD-3-Clause
#include "node_table.h"

#include "noise.h"
#include "threads.h"

#include <cmath>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief The spacing of points that cover the surface of the box around them. */
double
guessSpacing (const std::vector<Eigen::Vector3f> &positions)
{
  Eigen::Array3f low = positions.front ().array (), high = low;
  for (const Eigen::Vector3f &p : positions)
  {
    low = low.min (p.array ());
    high = high.max (p.array ());
  }
  const Eigen::Array3d size = (high - low).cast<double> ();
  const double area = 2.0 * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]);
  const double by_area = std::sqrt (area / static_cast<double> (positions.size ()));
  return std::max (by_area, 1e-6 * size.maxCoeff ());
}

} // namespace

NodeTable::NodeTable (const OrientedPoints &points, std::shared_ptr<const PointGrid> point_grid, int threads)
    : grid (std::move (point_grid))
{
  const LargeVector<std::uint32_t> &index = grid->index ();
  for (LargeVector<float> &component : normals)
    component.resize (index.size ());
  confidences.resize (points.confidences.empty () ? 0 : index.size ());
  parallelRanges (index.size (), threads,
                  [&] (std::size_t first, std::size_t last)
                  {
                    for (std::size_t place = first; place < last; ++place)
                    {
                      for (int a = 0; a < 3; ++a)
                        normals[static_cast<std::size_t> (a)][place] = points.normals[index[place]][a];
                      if (!confidences.empty ())
                        confidences[place] = points.confidences[index[place]];
                    }
                  });
}

std::shared_ptr<const PointGrid>
makePointGrid (const std::vector<Eigen::Vector3f> &positions, int threads, double &spacing)
{
  constexpr double CELL = 2.5, WIDE = 1.6; // spacings: the support of clean points; how far off does no harm
  const double guess = guessSpacing (positions);
  auto grid = std::make_shared<const PointGrid> (positions, CELL * guess, threads);
  spacing = measureSpacing (positions, *makeGridSearch (grid), threads);
  if (spacing > 0.0 && std::abs (std::log (spacing / guess)) > std::log (WIDE))
    grid = std::make_shared<const PointGrid> (positions, CELL * spacing, threads);
  return grid;
}

NeighborSearch::ConstPtr
makeGridSearch (const std::vector<Eigen::Vector3f> &positions, int threads)
{
  double spacing = 0.0;
  return makeGridSearch (makePointGrid (positions, threads, spacing));
}

} // namespace erkpa
