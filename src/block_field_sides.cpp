// SPDX-License-Identifier: BSD-3-Clause
//
// What BlockField says on either side of creases; see local_field_sides.cpp.
#include "block_field.h"

namespace erkpa
{

bool
BlockField::canSampleSides (const ImplicitField &field)
{
  return canEvaluate (field) && field.options ().order != Order::CONSTANT && BlockEnrichment::canEvaluate (field) &&
         (field.faces () == nullptr || BlockFaces::canEvaluate (field));
}

bool
BlockField::addSides (const Eigen::Vector3d &x, const std::vector<Side> &sides)
{
  if (!covers (x))
    return false;
  const bool is_at_faces = has_separations_ && faces_.groups ().hasSeparationAt (x);
  const double reach = enrichment_.isEmpty () ? 0.0 : reachAt (x, is_at_faces);
  const bool is_enriched = !enrichment_.isAbsentAt (x, reach);
  if (is_enriched && (is_at_faces || !enrichment_.canEvaluateAt (x, reach)))
    return false;
  if (!is_enriched)
    addPlain (x, is_at_faces);
  for (const Side &side : sides)
  {
    if (is_enriched)
    {
      addEnriched (x, reach);
      seen_from_.push_back (side.place);
    }
    side_questions_.push_back ({size () - 1, side.face});
  }
  return true;
}

void
BlockField::sampleSides (LocalField::Slope slope, std::vector<SideAnswer> &answers)
{
  settings_.gradients = slope == LocalField::Slope::EXACT;
  evaluations_ += size ();
  runAll (false);
  for (std::size_t i = 0; i < size (); ++i)
    support_nodes_ += at (i).supports[placeOf (i)];
  refuseUncovered (plain_);
  refuseUncovered (enriched_);
  std::vector<BlockFaces::Question> of_faces;
  for (const SideQuestion &question : side_questions_)
    if (isOfFaces (question))
      of_faces.push_back ({static_cast<std::uint32_t> (placeOf (question.point)), question.face});
  std::vector<BlockParts::Part> parts;
  const bool are_told = of_faces.empty () || faces_.sampleSides (settings_, at_faces_, plain_, of_faces, parts);
  answers.clear ();
  auto part = parts.begin ();
  for (const SideQuestion &question : side_questions_)
    if (isOfFaces (question))
    {
      answers.push_back (answerOf (question.point, &*part++, slope));
      answers.back ().is_settled = answers.back ().is_settled && are_told;
    }
    else
      answers.push_back (answerOf (question.point, nullptr, slope));
}

/** \param[in] part the piece of f on the side; null, or of no faces: that of all nodes */
BlockField::SideAnswer
BlockField::answerOf (std::size_t point, const BlockParts::Part *part, LocalField::Slope slope) const
{
  const BlockPoints &points = at (point);
  const std::size_t i = placeOf (point);
  const bool is_of_faces = part != nullptr && part->faces != 0;
  const lanes::State state = is_of_faces ? part->state : points.states[i];
  SideAnswer answer;
  answer.is_settled = state == lanes::State::DEFINED || (is_of_faces && state == lanes::State::UNDEFINED);
  if (state != lanes::State::DEFINED)
    return answer;
  answer.sample.value = unit_ * static_cast<double> (is_of_faces ? part->value : points.values[i]);
  Eigen::Vector3f gradient;
  if (slope == LocalField::Slope::EXACT)
    gradient = is_of_faces ? part->gradient
                           : Eigen::Vector3f (points.gradients[0][i], points.gradients[1][i], points.gradients[2][i]);
  else if (is_of_faces)
    gradient = Eigen::Vector3f (part->coefficients[1], part->coefficients[2], part->coefficients[3]) / part->radius;
  else
    gradient = Eigen::Vector3f (points.coefficient (i, 1), points.coefficient (i, 2), points.coefficient (i, 3)) /
               points.radii[i];
  answer.sample.gradient = gradient.cast<double> ();
  return answer;
}

} // namespace erkpa
