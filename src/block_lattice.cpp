// SPDX-License-Identifier: BSD-3-Clause
#include "block_lattice.h"

#include "block_nodes.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace erkpa
{

bool
BlockLattice::covers (const Eigen::Vector3d &x)
{
  if (lattice_ == nullptr)
    return false;
  // Next to a plane of the lattice floats may say the other cell, and the gradient is not that of both.
  constexpr double CLEAR = 1e-5;
  const Eigen::Array3d along = x.array () / lattice_->spacing (), share = along - along.floor ();
  if ((share < CLEAR).any () || (share > 1.0 - CLEAR).any ())
    return false;
  const Eigen::Array3i cell = lattice_->cellOf (x);
  if (last_ == nullptr || ((cell - last_->first) < 0).any () || ((cell - last_->first) >= MomentLattice::SIDE).any ())
    last_ = lattice_->brickOf (cell);
  return last_ != nullptr && (last_->cells & MomentLattice::bitOf (cell)) != 0;
}

void
BlockLattice::findBox (const Eigen::Vector3d &center, double unit, const BlockPoints &points, Box &box) const
{
  Eigen::AlignedBox3f of_points;
  for (std::size_t i = 0; i < points.size (); ++i)
    of_points.extend (points.position (i));
  const auto cell_of = [&] (const Eigen::Vector3f &x) { return lattice_->cellOf (center + unit * x.cast<double> ()); };
  box.low = cell_of (of_points.min ()) - 1;
  box.sides = cell_of (of_points.max ()) + 3 - box.low;
}

/** \brief Points of one brick that follow each other along x, and others after them, which do not count. */
void
BlockLattice::copyRow (const Eigen::Array3i &first, std::size_t place, const Eigen::Vector3d &center, double unit)
{
  constexpr std::size_t SIDE = MomentLattice::SIDE;
  const MomentLattice::Brick *brick = lattice_->brickOf (first);
  brick = brick != nullptr && brick->points != 0 ? brick : nullptr;
  const std::size_t from = MomentLattice::placeOf (first);
  for (std::size_t column = 0; column < lattice_->columns (); ++column)
  {
    float *const to = sums_.data () + column * stride_ + place;
    if (brick != nullptr)
      std::copy_n (brick->sums.data () + column * MomentLattice::POINTS + from, SIDE, to);
    else
      std::fill_n (to, SIDE, 0.0f);
  }
  const Eigen::Vector3f step =
      brick != nullptr ? Eigen::Vector3f (((center - brick->center) / unit).cast<float> ()) : Eigen::Vector3f::Zero ();
  for (std::size_t a = 0; a < 3; ++a)
    std::fill_n (steps_[a].data () + place, SIDE, step[static_cast<Eigen::Index> (a)]);
}

void
BlockLattice::copySums (const Eigen::Vector3d &center, double unit)
{
  const auto count = static_cast<std::size_t> (box_.sides.prod ());
  stride_ = (count / lanes::MAX_WIDTH + 1) * lanes::MAX_WIDTH + MomentLattice::SIDE;
  makeRoom (stride_ * lattice_->columns (), sums_);
  makeRoom (count * lattice_->columns (), records_);
  for (std::vector<float> &steps : steps_)
    makeRoom (stride_, steps);
  const Eigen::Array3i end = box_.low + box_.sides;
  std::size_t place = 0;
  Eigen::Array3i point;
  for (point[2] = box_.low[2]; point[2] < end[2]; ++point[2])
    for (point[1] = box_.low[1]; point[1] < end[1]; ++point[1])
      for (point[0] = box_.low[0]; point[0] < end[0];)
      {
        copyRow (point, place, center, unit);
        const int next = std::min ((point[0] | (MomentLattice::SIDE - 1)) + 1, end[0]);
        place += static_cast<std::size_t> (next - point[0]);
        point[0] = next;
      }
}

bool
BlockLattice::evaluate (const lanes::Settings &settings, const Eigen::Vector3d &center, double unit,
                        BlockPoints &points)
{
  Box box;
  findBox (center, unit, points, box);
  if ((box.sides > static_cast<int> (lanes::Lattice::MOST)).any ())
    return false;
  if (center != center_ || !box_.contains (box)) // a step of Newton's seldom leads out of the box
  {
    center_ = center;
    box_ = box;
    copySums (center, unit);
    const float *const steps[] = {steps_[0].data (), steps_[1].data (), steps_[2].data ()};
    engine_.lattice->shift (settings, channels_, steps, sums_.data (), static_cast<std::size_t> (box_.sides.prod ()),
                            stride_, records_.data ());
  }
  const Eigen::Vector3f first =
      ((lattice_->spacing () * box_.low.cast<double> ().matrix () - center) / unit).cast<float> ();
  lanes::Lattice lattice{};
  for (std::size_t a = 0; a < 3; ++a)
  {
    lattice.sides[a] = static_cast<std::size_t> (box_.sides[static_cast<Eigen::Index> (a)]);
    lattice.first[a] = first[static_cast<Eigen::Index> (a)];
  }
  lattice.spacing = static_cast<float> (lattice_->spacing () / unit);
  lattice.sums = records_.data ();
  lattice.record = lattice_->columns ();
  lattice.channels = settings.gradients ? channels_ : 0;
  points.interpolate (engine_, settings, lattice);
  return true;
}

} // namespace erkpa
