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
  std::vector<std::size_t> firsts{0}; // answer of each question, where it has any
  block_.clearPoints ();
  for (const Question &question : questions)
  {
    const bool is_asked = has_block_ && block_.addSides (question.x, *question.sides);
    firsts.push_back (firsts.back () + (is_asked ? question.sides->size () : 0));
  }
  std::vector<BlockField::SideAnswer> answers;
  if (firsts.back () > 0)
    block_.sampleSides (slope, answers);
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
