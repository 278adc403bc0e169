// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cmath>
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
  distance (const Eigen::Vector3f &x) const
  {
    Eigen::Vector3f normal;
    return distance (x, normal);
  }

  /** \param[out] normal see normal () */
  double
  distance (const Eigen::Vector3f &x, Eigen::Vector3f &normal) const
  {
    const Eigen::Vector3f p = frame_ * (x - center_);
    const Eigen::Vector2f slope = slopeAt (p);
    const float height = heights_[0] + heights_[1] * p.x () + heights_[2] * p.y () + heights_[3] * p.x () * p.x () +
                         heights_[4] * p.x () * p.y () + heights_[5] * p.y () * p.y ();
    const float inverse = 1.0f / std::sqrt (1.0f + slope.squaredNorm ());
    normal = inverse * (frame_.row (2) - slope.x () * frame_.row (0) - slope.y () * frame_.row (1)).transpose ();
    return (p.z () - height) * inverse;
  }

  /** \brief Unit normal of the surface below \a x. */
  Eigen::Vector3f
  normal (const Eigen::Vector3f &x) const
  {
    Eigen::Vector3f normal;
    distance (x, normal);
    return normal;
  }

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
  slopeAt (const Eigen::Vector3f &p) const
  {
    return {heights_[1] + 2.0f * heights_[3] * p.x () + heights_[4] * p.y (),
            heights_[2] + heights_[4] * p.x () + 2.0f * heights_[5] * p.y ()};
  }

  void
  setFrame (const std::vector<Eigen::Vector3f> &points, const std::vector<float> &weights, const Eigen::Vector3f &side);

  Eigen::Vector3f center_ = Eigen::Vector3f::Zero ();
  Eigen::Matrix3f frame_ = Eigen::Matrix3f::Identity (); // rows: x, y, z of the plane
  Eigen::Matrix<float, 6, 1> heights_ = Eigen::Matrix<float, 6, 1>::Zero ();
  float deviation_ = 0.0f;
  float weight_ = 0.0f;
};

} // namespace erkpa
