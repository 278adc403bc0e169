// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/space_warp.h>

#include <Eigen/LU>

#include <utility>

namespace erkpa
{

namespace
{

class FunctionWarp : public SpaceWarp
{
public:
  using Map = std::function<Eigen::Vector3d (const Eigen::Vector3d &)>;
  using Jacobian = std::function<Eigen::Matrix3d (const Eigen::Vector3d &)>;

  FunctionWarp (Map map, Jacobian jacobian) : map_ (std::move (map)), jacobian_ (std::move (jacobian)) {}

  Eigen::Vector3d
  map (const Eigen::Vector3d &x) const override
  {
    return map_ (x);
  }

  Eigen::Matrix3d
  jacobian (const Eigen::Vector3d &x) const override
  {
    return jacobian_ (x);
  }

private:
  Map map_;
  Jacobian jacobian_;
};

} // namespace

bool
SpaceWarp::invert (const Eigen::Vector3d &y, Eigen::Vector3d &x, double tolerance) const
{
  constexpr int STEPS = 30, HALVINGS = 12;
  Eigen::Vector3d miss = y - map (x);
  for (int step = 0; step < STEPS; ++step)
  {
    const Eigen::Vector3d move = jacobian (x).partialPivLu ().solve (miss);
    double share = 1.0;
    Eigen::Vector3d next = x, next_miss = miss;
    for (int halving = 0; halving < HALVINGS; ++halving, share *= 0.5)
    {
      next = x + share * move;
      next_miss = y - map (next);
      if (next_miss.norm () < miss.norm ())
        break;
    }
    if (!(next_miss.norm () < miss.norm ()))
      break; // as near as rounding allows, or stuck
    x = next;
    miss = next_miss;
  }
  return miss.norm () <= tolerance;
}

SpaceWarp::ConstPtr
makeSpaceWarp (std::function<Eigen::Vector3d (const Eigen::Vector3d &)> map,
               std::function<Eigen::Matrix3d (const Eigen::Vector3d &)> jacobian)
{
  return std::make_shared<FunctionWarp> (std::move (map), std::move (jacobian));
}

} // namespace erkpa
