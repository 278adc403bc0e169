// SPDX-License-Identifier: BSD-3-Clause
#include "normal_smoothing.h"

#include "threads.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace erkpa
{

namespace
{

using Terms = Eigen::Matrix<double, 6, 1>;

Terms
termsAt (double x, double y)
{
  Terms terms;
  terms << 1.0, x, y, x * x, x * y, y * y;
  return terms;
}

/** \brief Weighted sums over points of what a HeightFit is from. */
struct HeightSums
{
  std::array<double, 15> powers{}; ///< x^a y^b for a + b = 0, 1 .. 4, each rising with b
  Terms of_heights = Terms::Zero ();
  double squares = 0.0; ///< of the heights
  double used = 0.0;    ///< number of points

  void
  add (const Eigen::Vector3d &p, double w)
  {
    const double x = p.x (), y = p.y (), xx = w * x * x, xy = w * x * y, yy = w * y * y;
    const std::array<double, 15> all{w,      w * x,  w * y,      xx,         xy,         yy,         xx * x,    xx * y,
                                     xy * y, yy * y, xx * x * x, xx * x * y, xx * y * y, xy * y * y, yy * y * y};
    for (std::size_t i = 0; i < all.size (); ++i)
      powers[i] += all[i];
    of_heights += w * p.z () * termsAt (x, y);
    squares += w * p.z () * p.z ();
    used += 1.0;
  }

  /** \brief The sums of products of the terms. */
  Eigen::Matrix<double, 6, 6>
  moments () const
  {
    constexpr std::array<std::size_t, 6> OF_X{0, 1, 0, 2, 1, 0}, OF_Y{0, 0, 1, 0, 1, 2}; // exponents in the terms
    Eigen::Matrix<double, 6, 6> moments;
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j)
      {
        const std::size_t b = OF_Y[i] + OF_Y[j], degree = OF_X[i] + OF_X[j] + b;
        moments (static_cast<Eigen::Index> (i), static_cast<Eigen::Index> (j)) = powers[degree * (degree + 1) / 2 + b];
      }
    return moments;
  }
};

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

HeightFit::HeightFit (const std::vector<Eigen::Vector3f> &points, const std::vector<float> &weights,
                      const Eigen::Vector3f &side, double spacing, double noise, bool curved)
{
  constexpr double BEND = 0.15; // expected second derivative, in 1 / spacing
  const double ridge = std::pow (noise / (BEND * spacing), 2) + 1e-6;
  setFrame (points, weights, side);
  HeightSums sums;
  for (std::size_t i = 0; i < points.size (); ++i)
    if (weights[i] > 0.0f)
      sums.add ((frame_ * (points[i] - center_)).cast<double> () / spacing, static_cast<double> (weights[i]));
  Eigen::Matrix<double, 6, 6> moments = sums.moments (); // lengths in spacings
  const double total = moments (0, 0);
  moments.diagonal ().head<3> ().array () += 1e-9 * total;
  moments.diagonal ().tail<3> ().array () += ridge;
  const int count = curved ? 6 : 3;
  Terms heights = Terms::Zero ();
  heights.head (count) = moments.topLeftCorner (count, count)
                             .selfadjointView<Eigen::Lower> ()
                             .ldlt ()
                             .solve (sums.of_heights.head (count));
  const double left = sums.squares - heights.dot (sums.of_heights) - ridge * heights.tail<3> ().squaredNorm ();
  const double freedom = std::max (0.5, sums.used - count) * total / std::max (1.0, sums.used);
  deviation_ = static_cast<float> (spacing * std::sqrt (std::max (0.0, left / freedom)));
  weight_ = static_cast<float> (total);
  heights[0] *= spacing;
  heights.tail<3> () /= spacing;
  heights_ = heights.cast<float> ();
}

void
HeightFit::setFrame (const std::vector<Eigen::Vector3f> &points, const std::vector<float> &weights,
                     const Eigen::Vector3f &side)
{
  Eigen::Vector3d mean = Eigen::Vector3d::Zero ();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero ();
  double total = 0.0;
  const Eigen::Vector3f &first = points.front ();
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    const Eigen::Vector3d p = (points[i] - first).cast<double> ();
    total += weights[i];
    mean += weights[i] * p;
    products += weights[i] * p * p.transpose ();
  }
  mean /= total;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect (products / total - mean * mean.transpose ());
  Eigen::Vector3f z = solver.eigenvectors ().col (0).cast<float> ().normalized ();
  if (!z.allFinite ())
    z = side;
  if (z.dot (side) < 0.0f)
    z = -z;
  center_ = first + mean.cast<float> ();
  frame_.row (2) = z.transpose ();
  frame_.row (0) = z.unitOrthogonal ().transpose ();
  frame_.row (1) = z.cross (z.unitOrthogonal ()).transpose ();
}

double
HeightFit::distance (const Eigen::Vector3f &x) const
{
  const Eigen::Vector3f p = frame_ * (x - center_);
  const float height = heights_[0] + heights_[1] * p.x () + heights_[2] * p.y () + heights_[3] * p.x () * p.x () +
                       heights_[4] * p.x () * p.y () + heights_[5] * p.y () * p.y ();
  const Eigen::Vector2f slope = slopeAt (p);
  return (p.z () - height) / std::sqrt (1.0f + slope.squaredNorm ());
}

Eigen::Vector3f
HeightFit::normal (const Eigen::Vector3f &x) const
{
  const Eigen::Vector3f p = frame_ * (x - center_);
  const Eigen::Vector2f slope = slopeAt (p);
  return frame_.transpose () * Eigen::Vector3f (-slope.x (), -slope.y (), 1.0f).normalized ();
}

Eigen::Vector2f
HeightFit::slopeAt (const Eigen::Vector3f &p) const
{
  return {heights_[1] + 2.0f * heights_[3] * p.x () + heights_[4] * p.y (),
          heights_[2] + heights_[4] * p.x () + 2.0f * heights_[5] * p.y ()};
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
