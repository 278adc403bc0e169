// SPDX-License-Identifier: BSD-3-Clause
#include "normal_smoothing.h"

#include "height_fit.h"
#include "threads.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace erkpa
{

namespace
{

double
radians (double degrees)
{
  return degrees * M_PI / 180.0;
}

/** \brief Scratch memory of a neighbour query. */
struct Query
{
  std::vector<int> indices;
  std::vector<float> squared;
};

/** \brief The value that a share of the values stays below; they may be negative where unknown and then do not count.
 */
double
quantile (std::vector<double> values, double share)
{
  values.erase (std::remove_if (values.begin (), values.end (), [] (double v) { return !(v >= 0.0); }), values.end ());
  if (values.empty ())
    return 0.0;
  const auto at = values.begin () + static_cast<std::ptrdiff_t> (share * static_cast<double> (values.size () - 1));
  std::nth_element (values.begin (), at, values.end ());
  return *at;
}

/** \brief Angle between the normal of node \a i and what a linear fit of its neighbours' normals says, in radians.
 *
 * Scaled by how uncertain that prediction is beside the normal itself; negative where it cannot be told.
 */
double
normalResidual (const OrientedPoints &points, std::size_t i, double spacing, const std::vector<int> &neighbors)
{
  const Eigen::Vector3d normal = points.normals[i].cast<double> ();
  Eigen::Matrix3d plane;
  plane.col (0) = normal.unitOrthogonal ();
  plane.col (1) = normal.cross (plane.col (0));
  plane.col (2).setZero ();
  Eigen::Matrix3d moments = 1e-3 * Eigen::Matrix3d::Identity (), sums = Eigen::Matrix3d::Zero ();
  int count = 0;
  for (const int j : neighbors)
  {
    const auto neighbor = static_cast<std::size_t> (j);
    if (neighbor == i || points.normals[neighbor].dot (points.normals[i]) < 0.0f)
      continue;
    Eigen::Vector3d terms =
        plane.transpose () * (points.positions[neighbor] - points.positions[i]).cast<double> () / spacing;
    terms[2] = 1.0;
    moments += terms * terms.transpose ();
    sums += terms * points.normals[neighbor].cast<double> ().transpose ();
    ++count;
  }
  if (count < 5)
    return -1.0;
  const Eigen::LDLT<Eigen::Matrix3d> solver (moments);
  const Eigen::Vector3d weights = solver.solve (Eigen::Vector3d::UnitZ ());
  const Eigen::Vector3d predicted = sums.transpose () * weights;
  const double angle = std::atan2 (predicted.cross (normal).norm (), predicted.dot (normal));
  return angle / std::sqrt (1.0 + std::max (0.0, weights[2]));
}

} // namespace

std::vector<std::size_t>
spreadSample (std::size_t size)
{
  constexpr std::size_t COUNT = 1200;
  const std::size_t step = std::max<std::size_t> (1, size / COUNT);
  std::vector<std::size_t> sample;
  for (std::size_t i = 0; i < size; i += step)
    sample.push_back (i);
  return sample;
}

void
smoothNormals (const NeighborSearch &search, double spacing, int passes, int neighbors, double sigma_degrees,
               int threads, OrientedPoints &points)
{
  const double by_distance = -0.5 / std::pow (1.5 * spacing, 2),
               by_angle = -0.5 / std::pow (radians (sigma_degrees), 2);
  for (int pass = 0; pass < passes; ++pass)
  {
    std::vector<Eigen::Vector3f> smoothed (points.size ());
    parallelFor (
        points.size (), threads, [] { return Query (); },
        [&] (Query &query, std::size_t i)
        {
          search.nearestK (points.positions[i], neighbors, query.indices, query.squared);
          Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
          for (std::size_t j = 0; j < query.indices.size (); ++j)
          {
            const Eigen::Vector3f &normal = points.normals[static_cast<std::size_t> (query.indices[j])];
            const double angle = std::acos (std::clamp (points.normals[i].dot (normal), -1.0f, 1.0f));
            sum += std::exp (by_distance * query.squared[j] + by_angle * angle * angle) * normal.cast<double> ();
          }
          smoothed[i] = sum.norm () > 0.0 ? Eigen::Vector3f (sum.normalized ().cast<float> ()) : points.normals[i];
        });
    points.normals.swap (smoothed);
  }
}

double
normalNoise (const NeighborSearch &search, double spacing, int threads, const OrientedPoints &points)
{
  constexpr int NEIGHBORS = 10;
  constexpr double MEDIAN = 0.8326; // of the angle, where its root mean square is 1: sqrt (ln 2)
  const std::vector<std::size_t> sample = spreadSample (points.size ());
  std::vector<double> angles (sample.size ());
  parallelFor (
      sample.size (), threads, [] { return Query (); },
      [&] (Query &query, std::size_t s)
      {
        search.nearestK (points.positions[sample[s]], NEIGHBORS, query.indices, query.squared);
        angles[s] = normalResidual (points, sample[s], spacing, query.indices);
      });
  return quantile (angles, 0.5) / MEDIAN * 180.0 / M_PI;
}

double
positionNoise (const NeighborSearch &search, double spacing, int threads, const OrientedPoints &points)
{
  constexpr int NEIGHBORS = 18;
  constexpr double SHARE = 0.3, EXPECTED = 0.88; // quantile of the deviation's estimate with 12 degrees of freedom
  const std::vector<std::size_t> sample = spreadSample (points.size ());
  std::vector<double> deviations (sample.size ());
  parallelFor (
      sample.size (), threads, [] { return Query (); },
      [&] (Query &query, std::size_t s)
      {
        const Eigen::Vector3f &normal = points.normals[sample[s]];
        search.nearestK (points.positions[sample[s]], NEIGHBORS, query.indices, query.squared);
        std::vector<Eigen::Vector3f> near;
        for (const int j : query.indices)
          if (normal.dot (points.normals[static_cast<std::size_t> (j)]) > -0.3f)
            near.push_back (points.positions[static_cast<std::size_t> (j)]);
        if (static_cast<int> (near.size ()) < NEIGHBORS - 4)
          deviations[s] = -1.0;
        else
          deviations[s] =
              HeightFit (near, std::vector<float> (near.size (), 1.0f), normal, spacing, 0.0, true).deviation ();
      });
  return quantile (deviations, SHARE) / EXPECTED;
}

} // namespace erkpa
