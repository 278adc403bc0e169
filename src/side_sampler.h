// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "block_field.h"
#include "crease_solver.h"
#include "local_field.h"

#include <cstddef>
#include <vector>

namespace erkpa
{

/** \brief Asks for the pieces of f on the sides of creases at many points of one ball, in lanes where they can tell
 * them. One object per thread. */
class SideSampler
{
public:
  explicit SideSampler (const ImplicitField &field)
      : local_ (field), block_ (field), uses_lanes_ (BlockField::canSampleSides (field))
  {
  }

  /** \brief Prepare for points within \a extent of \a center. */
  void
  gather (const Eigen::Vector3d &center, double extent);

  /** \brief See LocalField::keepsApart (). */
  bool
  keepsApart (int face, int other, const Eigen::Vector3d &x) const
  {
    return has_block_ ? block_.keepsApart (face, other, x) : local_.keepsApart (face, other, x);
  }

  /** \brief What LocalField::sampleOnSides () is asked, and its answer: values and gradients, the rest may be missing.
   */
  struct Question
  {
    Eigen::Vector3d x;
    const std::vector<Side> *sides;
    std::vector<LocalSample> samples;
  };

  void
  sample (std::vector<Question> &questions, LocalField::Slope slope);

  /** \brief What the field itself, as which no wall is thickened, is at a point. */
  struct Look
  {
    Eigen::Vector3d x;
    double value; ///< NaN where undefined
    int face;     ///< see LocalField::face ()
  };

  /** \brief Look at the field at points near those gathered for. */
  void
  look (std::vector<Look> &looks);

  /** \brief The field itself at a point near those gathered for; then its attributes may be asked for. */
  LocalSample
  sample (const Eigen::Vector3d &x);

  /** \brief See LocalField::blendAttributes (). */
  void
  blendAttributes (float *attributes) const
  {
    local_.blendAttributes (attributes);
  }

  std::size_t
  evaluations () const
  {
    return local_.evaluations () + block_.evaluations ();
  }

  std::size_t
  supportNodes () const
  {
    return local_.supportNodes () + block_.supportNodes ();
  }

private:
  LocalField &
  localAt (const Eigen::Vector3d &x);

  bool
  takeAnswers (const std::vector<BlockField::SideAnswer> &answers, std::size_t first, Question &question) const;

  LocalField local_;
  BlockField block_;
  bool uses_lanes_, has_block_ = false;
};

/** \brief Go on with solvers near points gathered for, together, until none is at work. */
void
solveTogether (SideSampler &sampler, std::vector<CreaseSolver *> solvers);

} // namespace erkpa
