// SPDX-License-Identifier: BSD-3-Clause
#include "surface_feet.h"

#include "block_evaluator.h"
#include "point_groups.h"
#include "threads.h"

#include <cmath>
#include <cstddef>

namespace erkpa
{

namespace
{

class FootFinder
{
public:
  FootFinder (const PolygonizerOptions &options, double voxel, std::vector<Eigen::Vector3d> &points)
      : options_ (options), voxel_ (voxel), points_ (points), states_ (points.size (), State::ON_ITS_WAY)
  {
    for (std::size_t i = 0; i < points.size (); ++i)
      waiting_.push_back (i);
  }

  std::vector<char>
  run (const ImplicitField &field, const MomentLattice *lattice, PolygonizerReport &report)
  {
    constexpr int STEPS = 4;
    for (int step = 0; step < STEPS && !waiting_.empty (); ++step)
    {
      const std::vector<PointGroup> groups = groupPoints (
          waiting_.size (), voxel_, [this] (std::size_t w) -> const Eigen::Vector3d & { return points_[waiting_[w]]; });
      parallelFor (
          groups.size (), options_.threads, [&] { return GridField (field, options_, voxel_, lattice); },
          [&] (GridField &worker, std::size_t g) { stepTogether (worker, groups[g]); },
          [&report] (const GridField &worker) { worker.addTo (report); });
      std::vector<std::size_t> left;
      for (const std::size_t i : waiting_)
        if (states_[i] == State::ON_ITS_WAY)
          left.push_back (i);
      waiting_.swap (left);
    }
    std::vector<char> has_foot;
    for (const State state : states_)
      has_foot.push_back (state == State::ARRIVED ? 1 : 0);
    return has_foot;
  }

private:
  enum class State : char
  {
    ON_ITS_WAY,
    ARRIVED,
    LOST
  };

  void
  stepTogether (GridField &worker, const PointGroup &group)
  {
    BlockField &block = worker.block;
    std::vector<std::size_t> together;
    if (block.gather (group.center, group.extent))
      for (std::size_t w = group.first; w < group.last; ++w)
        if (const std::size_t i = waiting_[w]; block.addPoint (points_[i]))
          together.push_back (i);
    block.evaluate (true);
    std::size_t taken = 0;
    for (std::size_t w = group.first; w < group.last; ++w)
    {
      const std::size_t i = waiting_[w];
      const bool is_together = taken < together.size () && together[taken] == i;
      const std::size_t at = is_together ? taken++ : 0;
      if (!is_together || block.isUnsettled (at))
        stepAlone (worker.local, i);
      else if (!block.isSettled (at) || !block.isInReach (at))
        states_[i] = State::LOST;
      else
        move (i, block.value (at), block.gradient (at), block.radius (at), 1.0);
    }
  }

  void
  stepAlone (LocalField &local, std::size_t i)
  {
    local.gather (points_[i], 0.0);
    const LocalSample sample = local.sample (points_[i]);
    if (!sample.isDefined () || !isInReach (local, options_, voxel_))
      states_[i] = State::LOST;
    else
      move (i, sample.value, sample.gradient, sample.radius, local.unwarpedLength (1.0));
  }

  /** \param[in] unwarped_length what a unit of length there was before the warp */
  void
  move (std::size_t i, double value, const Eigen::Vector3d &gradient, double radius, double unwarped_length)
  {
    constexpr double NEAR = 0.1; // voxels
    const double slope = gradient.squaredNorm ();
    const Eigen::Vector3d way = (options_.iso_level - value) / slope * gradient;
    if (!(slope > 0.0) || !(unwarped_length * way.norm () < radius + std::abs (options_.iso_level)))
    {
      states_[i] = State::LOST;
      return;
    }
    points_[i] += way;
    if (way.norm () < NEAR * voxel_)
      states_[i] = State::ARRIVED;
  }

  const PolygonizerOptions &options_;
  double voxel_;
  std::vector<Eigen::Vector3d> &points_;
  std::vector<State> states_;
  std::vector<std::size_t> waiting_; // those on their way
};

} // namespace

std::vector<char>
findFeet (const ImplicitField &field, const PolygonizerOptions &options, double voxel, const MomentLattice *lattice,
          std::vector<Eigen::Vector3d> &points, PolygonizerReport &report)
{
  return FootFinder (options, voxel, points).run (field, lattice, report);
}

} // namespace erkpa
