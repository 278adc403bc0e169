// SPDX-License-Identifier: BSD-3-Clause
#include "side_sampler.h"

#include <algorithm>

namespace erkpa
{

void
SideSampler::gather (const Eigen::Vector3d &center, double extent)
{
  has_block_ = uses_lanes_ && block_.gather (center, extent, true);
  if (!has_block_)
    local_.gather (center, extent);
}

LocalField &
SideSampler::localAt (const Eigen::Vector3d &x)
{
  if (has_block_)
    local_.gather (x, 0.0);
  return local_;
}

LocalSample
SideSampler::sample (const Eigen::Vector3d &x)
{
  return localAt (x).sample (x);
}

void
SideSampler::look (std::vector<Look> &looks)
{
  block_.clearPoints ();
  std::vector<Look *> together, alone;
  for (Look &at : looks)
    (has_block_ && block_.covers (at.x) && block_.addPoint (at.x) ? together : alone).push_back (&at);
  block_.evaluate (false);
  for (std::size_t i = 0; i < together.size (); ++i)
    if (block_.isUnsettled (i))
      alone.push_back (together[i]);
    else
      *together[i] = {together[i]->x, block_.value (i), block_.face (i)};
  for (Look *const at : alone)
  {
    at->value = localAt (at->x).value (at->x);
    at->face = local_.face ();
  }
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

void
solveTogether (SideSampler &sampler, std::vector<CreaseSolver *> solvers)
{
  const auto is_done = [] (const CreaseSolver *solver) { return !solver->isAtWork (); };
  for (;;)
  {
    solvers.erase (std::remove_if (solvers.begin (), solvers.end (), is_done), solvers.end ());
    if (solvers.empty ())
      return;
    std::vector<SideSampler::Question> questions;
    questions.reserve (solvers.size ());
    for (const CreaseSolver *const solver : solvers)
      questions.push_back ({solver->position (), &solver->sides (), {}});
    sampler.sample (questions, LocalField::Slope::EXACT);
    for (std::size_t i = 0; i < solvers.size (); ++i)
      solvers[i]->step (questions[i].samples);
  }
}

} // namespace erkpa
