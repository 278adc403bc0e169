// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lane_memory.h"
#include "lanes/lanes.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace erkpa
{

/** \brief Evaluation points and what the lanes find there, as arrays in the lanes' unit. Memory is kept. */
class BlockPoints
{
public:
  /** \param[in] channels of the nodes' attributes
   * \param[in] terms whose coefficients are wanted; 0: none
   * \param[in] wants_nearest whether the nearest nodes are wanted
   */
  BlockPoints (std::size_t channels, std::size_t terms, bool wants_nearest)
      : channels_ (channels), terms_ (terms), wants_nearest_ (wants_nearest)
  {
  }

  void
  clear ()
  {
    count_ = 0;
  }

  std::size_t
  size () const
  {
    return count_;
  }

  void
  add (const Eigen::Vector3f &x);

  Eigen::Vector3f
  position (std::size_t i) const
  {
    return {points_[0][i], points_[1][i], points_[2][i]};
  }

  /** \brief See lanes::Points; for all points, before run (). */
  void
  setRadius (std::size_t i, float radius, float guess)
  {
    bounds_[i] = radius;
    guesses_[i] = guess;
  }

  float
  bound (std::size_t i) const
  {
    return bounds_[i];
  }

  void
  setGrowth (std::size_t i, const Eigen::Vector3f &growth)
  {
    for (std::size_t a = 0; a < 3; ++a)
      growths_[a][i] = growth[static_cast<Eigen::Index> (a)];
  }

  /** \brief Evaluate at all points.
   * \param[in] growths whether setGrowth () was called
   * \param[in] sharp null: none
   */
  void
  run (const lanes::Engine &engine, const lanes::Settings &settings, const lanes::Nodes &nodes, bool growths,
       const lanes::SharpSurfaces *sharp = nullptr);

  /** \brief The same from moments that are interpolated between the points of a lattice. */
  void
  interpolate (const lanes::Engine &engine, const lanes::Settings &settings, const lanes::Lattice &lattice);

  /** \brief Let all points be open: State::UNSETTLED. */
  void
  leaveOpen ()
  {
    std::fill_n (states.begin (), count_, lanes::State::UNSETTLED);
    std::fill_n (supports.begin (), count_, 0u);
    std::fill_n (active.begin (), count_, 0u);
  }

  // What was found; see lanes::Samples. Points of faces have theirs written here afterwards.
  std::vector<float> values, radii, border_offsets, nearest_distances, asides;
  std::vector<std::uint8_t> in_reach;
  std::vector<lanes::State> states;
  std::vector<std::uint32_t> nearest, supports, active;
  std::array<std::vector<float>, 3> gradients, radius_gradients;

  /** \brief Whether a bound of ε was exceeded. */
  bool
  hasShort () const
  {
    return std::any_of (states.begin (), states.begin () + static_cast<std::ptrdiff_t> (count_),
                        [] (lanes::State state) { return state == lanes::State::SHORT; });
  }

  float
  attribute (std::size_t i, std::size_t channel) const
  {
    return attributes_[channel * stride () + i];
  }

  float
  coefficient (std::size_t i, std::size_t term) const
  {
    return coefficients_[term * stride () + i];
  }

private:
  std::size_t
  stride () const
  {
    return points_[0].size ();
  }

  void
  resize (std::size_t size);

  lanes::Points
  points (bool growths) const;

  lanes::Samples
  samples ();

  /** \brief The last vector is filled up with the last point. */
  void
  pad ();

  std::size_t channels_, terms_, count_ = 0;
  bool wants_nearest_;
  std::array<std::vector<float>, 3> points_, growths_;
  std::vector<float> bounds_, guesses_, attributes_, coefficients_;
  LaneMemory memory_;
};

} // namespace erkpa
