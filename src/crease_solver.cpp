// SPDX-License-Identifier: BSD-3-Clause
#include "crease_solver.h"

#include <Eigen/SVD>

namespace erkpa
{

bool
moveToCrease (LocalField &local, const std::vector<Side> &sides, double iso, double reach, double tolerance,
              Eigen::Vector3d &x, std::vector<Eigen::Vector3d> *gradients_there)
{
  constexpr int STEPS = 10;
  constexpr double PARALLEL = 0.05; // sine of about half the angle at which pieces count as one
  const Eigen::Vector3d start = x;
  const auto count = static_cast<Eigen::Index> (sides.size ());
  if (gradients_there != nullptr)
    gradients_there->resize (sides.size ());
  Eigen::MatrixXd gradients (count, 3);
  Eigen::VectorXd values (count);
  for (int step = 0; step < STEPS; ++step)
  {
    for (Eigen::Index i = 0; i < count; ++i)
    {
      const LocalSample sample = local.sampleOnSide (x, sides[static_cast<std::size_t> (i)]);
      if (!sample.isDefined ())
        return false;
      values[i] = iso - sample.value;
      gradients.row (i) = sample.gradient.transpose ();
    }
    Eigen::JacobiSVD<Eigen::MatrixXd> svd (gradients, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold (PARALLEL);
    const Eigen::Vector3d move = svd.solve (values);
    if (!((x + move - start).norm () < reach))
      return false;
    x += move;
    if (gradients_there != nullptr)
      for (Eigen::Index i = 0; i < count; ++i)
        (*gradients_there)[static_cast<std::size_t> (i)] = gradients.row (i).transpose ();
    if (move.norm () < tolerance)
      return true;
  }
  return values.norm () < 1e3 * tolerance;
}

} // namespace erkpa
