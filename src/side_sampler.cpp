// SPDX-License-Identifier: BSD-3-Clause
#include "side_sampler.h"

namespace erkpa
{

void
SideSampler::gather (const Eigen::Vector3d &center, double extent)
{
  has_block_ = uses_lanes_ && block_.gather (center, extent, true);
  if (!has_block_)
    local_.gather (center, extent);
}

LocalSample
SideSampler::sample (const Eigen::Vector3d &x)
{
  if (has_block_)
    local_.gather (x, 0.0);
  return local_.sample (x);
}

void
SideSampler::sample (std::vector<Question> &questions, LocalField::Slope slope)
{
  std::vector<BlockField::SideQuestion> asked;
  std::vector<std::size_t> firsts; // of the questions, among those asked
  block_.clearPoints ();
  for (const Question &question : questions)
  {
    firsts.push_back (asked.size ());
    if (has_block_ && block_.addSidePoint (question.x))
      for (const Side &side : *question.sides)
        asked.push_back ({block_.size () - 1, side.face});
  }
  firsts.push_back (asked.size ());
  std::vector<BlockField::SideAnswer> answers;
  if (!asked.empty ())
    block_.sampleSides (asked, slope, answers);
  for (std::size_t i = 0; i < questions.size (); ++i)
    if (firsts[i] == firsts[i + 1] || !takeAnswers (answers, firsts[i], questions[i]))
      local_.sampleOnSides (questions[i].x, *questions[i].sides, questions[i].samples, slope);
}

/** \return false where LocalField has to be asked */
bool
SideSampler::takeAnswers (const std::vector<BlockField::SideAnswer> &answers, std::size_t first,
                          Question &question) const
{
  question.samples.assign (question.sides->size (), LocalSample ());
  for (std::size_t i = 0; i < question.samples.size (); ++i)
  {
    if (!answers[first + i].is_settled)
      return false;
    static_cast<FieldSample &> (question.samples[i]) = answers[first + i].sample;
  }
  return true;
}

} // namespace erkpa
