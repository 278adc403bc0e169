// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace erkpa
{

/** \brief The point nearest to several planes n·x = d, in the least squares, and of these points the one nearest to the
 * origin. */
class PlaneMeeting
{
public:
  void
  add (const Eigen::Vector3d &normal, double distance)
  {
    products_ += normal * normal.transpose ();
    sums_ += distance * normal;
  }

  /** \param[in] parallel planes that turn against each other by less than about twice this sine count as one */
  Eigen::Vector3d
  point (double parallel) const
  {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver (products_);
    const double least = parallel * parallel * solver.eigenvalues ()[2];
    Eigen::Vector3d point = Eigen::Vector3d::Zero ();
    for (int i = 0; i < 3; ++i)
      if (const double square = solver.eigenvalues ()[i]; square > least)
        point += solver.eigenvectors ().col (i).dot (sums_) / square * solver.eigenvectors ().col (i);
    return point;
  }

private:
  Eigen::Matrix3d products_ = Eigen::Matrix3d::Zero ();
  Eigen::Vector3d sums_ = Eigen::Vector3d::Zero ();
};

} // namespace erkpa
