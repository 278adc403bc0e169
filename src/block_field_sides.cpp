// SPDX-License-Identifier: BSD-3-Clause
//
// What BlockField says on either side of creases; see local_field_sides.cpp.
#include "block_field.h"

namespace erkpa
{

bool
BlockField::canSampleSides (const ImplicitField &field)
{
  return field.faces () != nullptr && canEvaluate (field) && BlockFaces::canEvaluate (field);
}

bool
BlockField::addSidePoint (const Eigen::Vector3d &x)
{
  if ((x - center_).norm () > extent_ || !enrichment_.isAbsentAt (x, enrichment_.isEmpty () ? 0.0 : reachAt (x)))
    return false;
  addPlain (x, has_separations_ && faces_.groups ().hasSeparationAt (x));
  return true;
}

void
BlockField::sampleSides (const std::vector<SideQuestion> &questions, LocalField::Slope slope,
                         std::vector<SideAnswer> &answers)
{
  settings_.gradients = slope == LocalField::Slope::EXACT;
  evaluations_ += size ();
  runAll ();
  for (std::size_t i = 0; i < plain_.size (); ++i)
    support_nodes_ += plain_.supports[i];
  refuseUncovered (plain_);
  std::vector<BlockFaces::Question> of_faces;
  for (const SideQuestion &question : questions)
    if (places_[question.point].at_faces >= 0 && isSettled (question.point))
      of_faces.push_back ({static_cast<std::uint32_t> (placeOf (question.point)), question.face});
  std::vector<BlockParts::Part> parts;
  const bool are_told = of_faces.empty () || faces_.sampleSides (settings_, at_faces_, plain_, of_faces, parts);
  answers.clear ();
  auto part = parts.begin ();
  for (const SideQuestion &question : questions)
  {
    const bool is_of_faces = places_[question.point].at_faces >= 0 && isSettled (question.point);
    answers.push_back (answerOf (question.point, is_of_faces ? &*part++ : nullptr, slope));
    answers.back ().is_settled = answers.back ().is_settled && (!is_of_faces || are_told);
  }
}

/** \param[in] part the piece of f on the side; null, or of no faces: that of all nodes */
BlockField::SideAnswer
BlockField::answerOf (std::size_t point, const BlockParts::Part *part, LocalField::Slope slope) const
{
  const std::size_t i = placeOf (point);
  SideAnswer answer;
  const bool is_of_faces = part != nullptr && part->faces != 0;
  const lanes::State state = is_of_faces ? part->state : plain_.states[i];
  answer.is_settled = state == lanes::State::DEFINED || (is_of_faces && state == lanes::State::UNDEFINED);
  if (state != lanes::State::DEFINED)
    return answer;
  answer.sample.value = unit_ * static_cast<double> (is_of_faces ? part->value : plain_.values[i]);
  Eigen::Vector3f gradient;
  if (slope == LocalField::Slope::EXACT)
    gradient = is_of_faces ? part->gradient
                           : Eigen::Vector3f (plain_.gradients[0][i], plain_.gradients[1][i], plain_.gradients[2][i]);
  else if (is_of_faces)
    gradient = Eigen::Vector3f (part->coefficients[1], part->coefficients[2], part->coefficients[3]) / part->radius;
  else
    gradient = Eigen::Vector3f (plain_.coefficient (i, 1), plain_.coefficient (i, 2), plain_.coefficient (i, 3)) /
               plain_.radii[i];
  answer.sample.gradient = gradient.cast<double> ();
  return answer;
}

} // namespace erkpa
