// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "local_field.h"

#include <vector>

namespace erkpa
{

/** \brief Moves a point to where the pieces of f on several sides have the value iso: one for a surface, two for a
 * crease, three for a corner.
 *
 * Newton steps of least norm, so that pieces that say the same do no harm.
 */
class CreaseSolver
{
public:
  /** \param[in] sides one or more
   * \param[in] start where it starts from
   * \param[in] reach how far the point may move, a length
   * \param[in] tolerance it ends when steps get shorter than this, a length
   */
  CreaseSolver (std::vector<Side> sides, const Eigen::Vector3d &start, double iso, double reach, double tolerance);

  const std::vector<Side> &
  sides () const
  {
    return sides_;
  }

  /** \brief Whether the pieces of f at position () are wanted, for step (). */
  bool
  isAtWork () const
  {
    return state_ == State::AT_WORK;
  }

  /** \brief Whether there is such a place within reach, and position () is there. */
  bool
  hasArrived () const
  {
    return state_ == State::ARRIVED;
  }

  const Eigen::Vector3d &
  position () const
  {
    return position_;
  }

  /** \brief Of the pieces there, all but for the last short step. */
  const std::vector<Eigen::Vector3d> &
  gradients () const
  {
    return gradients_;
  }

  /** \param[in] samples the pieces of f at position (), one per side */
  void
  step (const std::vector<LocalSample> &samples);

private:
  enum class State
  {
    AT_WORK,
    ARRIVED,
    LOST
  };

  std::vector<Side> sides_;
  Eigen::Vector3d start_, position_;
  double iso_, reach_, tolerance_;
  State state_ = State::AT_WORK;
  int steps_ = 0;
  double before_ = 0.0; // length of the last step; 0: none yet
  std::vector<Eigen::Vector3d> gradients_;
};

} // namespace erkpa
