// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/neighbor_search.h>
#include <erkpa/oriented_points.h>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief A piece of surface as a height over a plane: z = c0 + c1 x + c2 y + c3 x² + c4 xy + c5 y². */
class HeightFit
{
public:
  HeightFit () = default;

  /** \brief Least squares over points with weights (those of zero weight are left out).
   *
   * The plane is that of the weighted points. Second derivatives are expected to be about 0.15 / spacing at most, the
   * more so the more noise there is (a ridge): a few points, or points on a line, do not bend the fit.
   * \param[in] side the fit's normal points to this side
   * \param[in] noise standard deviation of the points about the surface, input's unit of length
   * \param[in] curved false for a plane
   */
  HeightFit (const std::vector<Eigen::Vector3f> &points, const std::vector<float> &weights, const Eigen::Vector3f &side,
             double spacing, double noise, bool curved);

  /** \brief Distance of \a x from the surface (to first order), positive on the normal's side. */
  double
  distance (const Eigen::Vector3f &x) const;

  /** \brief Unit normal of the surface below \a x. */
  Eigen::Vector3f
  normal (const Eigen::Vector3f &x) const;

  /** \brief Standard deviation of the points about the surface: Σ w d² over the weight beyond what the terms take. */
  double
  deviation () const
  {
    return deviation_;
  }

  /** \brief Sum of the weights, the greatest of which counts as 1. */
  double
  weight () const
  {
    return weight_;
  }

  /** \brief Where the plane's coordinates are zero: the middle of the points. */
  const Eigen::Vector3f &
  center () const
  {
    return center_;
  }

private:
  /** \brief The slopes of the height along x and y of the plane, at a point in its frame. */
  Eigen::Vector2f
  slopeAt (const Eigen::Vector3f &p) const;

  void
  setFrame (const std::vector<Eigen::Vector3f> &points, const std::vector<float> &weights, const Eigen::Vector3f &side);

  Eigen::Vector3f center_ = Eigen::Vector3f::Zero ();
  Eigen::Matrix3f frame_ = Eigen::Matrix3f::Identity (); // rows: x, y, z of the plane
  Eigen::Matrix<float, 6, 1> heights_ = Eigen::Matrix<float, 6, 1>::Zero ();
  float deviation_ = 0.0f;
  float weight_ = 0.0f;
};

/** \brief Some numbers below \a size, evenly spread: enough for a quantile that does not depend on which they are. */
std::vector<std::size_t>
spreadSample (std::size_t size);

/** \brief Bilateral filter of normals (Zheng et al. 2011, on points): means over neighbours that are near and alike.
 * \param[in] spacing measureSpacing: the weight falls with the distance as a Gaussian of 1.5 spacings
 * \param[in] passes how often; each reads the normals that the one before has left
 * \param[in] neighbors how many points a mean is over, its own among them
 * \param[in] sigma_degrees the weight falls with the angle between the normals as a Gaussian of this width
 */
void
smoothNormals (const NeighborSearch &search, double spacing, int passes, int neighbors, double sigma_degrees,
               int threads, OrientedPoints &points);

/** \brief Random error of the normals, root mean square angle in degrees.
 *
 * From what is left of a normal when the linear function of the position that fits its neighbours' normals is taken
 * off: the median over the points, so that what happens at sharp edges does not count. Sees no error that neighbours
 * share.
 */
double
normalNoise (const NeighborSearch &search, double spacing, int threads, const OrientedPoints &points);

/** \brief Standard deviation of the points about the surface along its normal, input's unit of length.
 *
 * What is left of small neighbourhoods beside a quadric, in the flatter part of them; edges do not count.
 */
double
positionNoise (const NeighborSearch &search, double spacing, int threads, const OrientedPoints &points);

} // namespace erkpa
