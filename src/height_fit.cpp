// SPDX-License-Identifier: BSD-3-Clause
#include "height_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>

namespace erkpa
{

namespace
{

constexpr int TERMS = 6;

using Terms = Eigen::Matrix<double, TERMS, 1>;
using Products = Eigen::Matrix<double, TERMS, TERMS>;

/** \brief Weighted sums over points of what a HeightFit is from, of two points at a time, as vectors of doubles hold.
 */
class HeightSums
{
public:
  HeightSums ()
  {
    powers_.fill (Pair::Zero ());
    of_heights_.fill (Pair::Zero ());
  }

  void
  add (const Eigen::Vector3f &p, double scale, float weight)
  {
    const auto place = static_cast<Eigen::Index> (used_++ % 2);
    for (std::size_t a = 0; a < 3; ++a)
      waiting_[a][place] = static_cast<double> (p[static_cast<Eigen::Index> (a)]) * scale;
    waiting_[3][place] = static_cast<double> (weight);
    if (place == 1)
      addPair ();
  }

  /** \brief After the last point. */
  void
  complete ()
  {
    if (used_ % 2 == 0)
      return;
    for (Pair &pair : waiting_)
      pair[1] = 0.0;
    addPair ();
  }

  /** \brief Number of points. */
  double
  used () const
  {
    return static_cast<double> (used_);
  }

  /** \brief The sums of products of the terms. */
  Products
  products () const
  {
    constexpr std::array<std::size_t, TERMS> OF_X{0, 1, 0, 2, 1, 0}, OF_Y{0, 0, 1, 0, 1, 2}; // exponents in the terms
    Products products;
    for (std::size_t i = 0; i < TERMS; ++i)
      for (std::size_t j = 0; j < TERMS; ++j)
      {
        const std::size_t b = OF_Y[i] + OF_Y[j], degree = OF_X[i] + OF_X[j] + b;
        products (static_cast<Eigen::Index> (i), static_cast<Eigen::Index> (j)) =
            powers_[degree * (degree + 1) / 2 + b].sum ();
      }
    return products;
  }

  /** \brief The sums of the terms times the heights. */
  Terms
  ofHeights () const
  {
    Terms sums;
    for (std::size_t i = 0; i < TERMS; ++i)
      sums[static_cast<Eigen::Index> (i)] = of_heights_[i].sum ();
    return sums;
  }

  /** \brief The sum of the squares of the heights. */
  double
  squares () const
  {
    return squares_.sum ();
  }

private:
  using Pair = Eigen::Array2d;

  void
  addPair ()
  {
    const auto &[x, y, z, w] = waiting_;
    const Pair wx = w * x, wy = w * y, xx = wx * x, xy = wx * y, yy = wy * y, xxx = xx * x, xxy = xx * y, xyy = xy * y,
               yyy = yy * y;
    const std::array<Pair, 15> all{w,   wx,  wy,      xx,      xy,      yy,      xxx,    xxy,
                                   xyy, yyy, xxx * x, xxx * y, xxy * y, xyy * y, yyy * y};
    for (std::size_t i = 0; i < all.size (); ++i)
      powers_[i] += all[i];
    for (std::size_t i = 0; i < TERMS; ++i)
      of_heights_[i] += all[i] * z;
    squares_ += w * z * z;
  }

  std::size_t used_ = 0;
  std::array<Pair, 4> waiting_; // x, y, z and the weight
  std::array<Pair, 15> powers_; // x^a y^b for a + b = 0, 1 .. 4, each rising with b
  std::array<Pair, TERMS> of_heights_;
  Pair squares_ = Pair::Zero ();
};

} // namespace

HeightFit::HeightFit (const std::vector<Eigen::Vector3f> &points, const std::vector<float> &weights,
                      const Eigen::Vector3f &side, double spacing, double noise, bool curved)
{
  constexpr double BEND = 0.15; // expected second derivative, in 1 / spacing
  const double ridge = std::pow (noise / (BEND * spacing), 2) + 1e-6;
  setFrame (points, weights, side);
  HeightSums sums;
  for (std::size_t i = 0; i < points.size (); ++i)
    if (weights[i] > 0.0f)
      sums.add (frame_ * (points[i] - center_), 1.0 / spacing, weights[i]);
  sums.complete ();
  Products products = sums.products ();
  const Terms of_heights = sums.ofHeights ();
  const double total = products (0, 0);
  products.diagonal ().head<3> ().array () += 1e-9 * total;
  products.diagonal ().tail<3> ().array () += ridge;
  Terms heights = Terms::Zero ();
  if (curved)
    heights = products.llt ().solve (of_heights);
  else
    heights.head<3> () = Eigen::Matrix3d (products.topLeftCorner<3, 3> ()).llt ().solve (of_heights.head<3> ());
  const double left = sums.squares () - heights.dot (of_heights) - ridge * heights.tail<3> ().squaredNorm ();
  const double freedom = std::max (0.5, sums.used () - (curved ? TERMS : 3)) * total / std::max (1.0, sums.used ());
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
  double total = 0.0, x = 0.0, y = 0.0, z = 0.0, xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
  const Eigen::Vector3f &first = points.front ();
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    const Eigen::Vector3d p = (points[i] - first).cast<double> ();
    const auto w = static_cast<double> (weights[i]);
    const double wx = w * p.x (), wy = w * p.y (), wz = w * p.z ();
    total += w;
    x += wx;
    y += wy;
    z += wz;
    xx += wx * p.x ();
    xy += wx * p.y ();
    xz += wx * p.z ();
    yy += wy * p.y ();
    yz += wy * p.z ();
    zz += wz * p.z ();
  }
  const Eigen::Vector3d mean = Eigen::Vector3d (x, y, z) / total;
  Eigen::Matrix3d products;
  products << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect (products / total - mean * mean.transpose ());
  Eigen::Vector3f normal = solver.eigenvectors ().col (0).cast<float> ().normalized ();
  if (!normal.allFinite ())
    normal = side;
  if (normal.dot (side) < 0.0f)
    normal = -normal;
  center_ = first + mean.cast<float> ();
  frame_.row (2) = normal.transpose ();
  frame_.row (0) = normal.unitOrthogonal ().transpose ();
  frame_.row (1) = normal.cross (normal.unitOrthogonal ()).transpose ();
}

} // namespace erkpa
