// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "block_field.h"
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
  bool
  takeAnswers (const std::vector<BlockField::SideAnswer> &answers, std::size_t first, Question &question) const;

  LocalField local_;
  BlockField block_;
  bool uses_lanes_, has_block_ = false;
};

} // namespace erkpa
