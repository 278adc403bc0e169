// SPDX-License-Identifier: BSD-3-Clause
//
// What LocalField says on either side of creases, beyond which its pieces go on smoothly.
#include "local_field.h"

#include <algorithm>
#include <cmath>

namespace erkpa
{

void
LocalField::sampleOnSides (const Eigen::Vector3d &x, const std::vector<Side> &sides, std::vector<LocalSample> &samples,
                           Slope slope)
{
  samples.assign (sides.size (), LocalSample ());
  Eigen::Vector3d unwarped = x;
  if (warp_ != nullptr && !unwarp (x, unwarped))
    return;
  const Eigen::Matrix3d unwarping = unwarping_;
  if ((unwarped - ball_center_).norm () > ball_extent_ || !support_.covers (unwarped))
    gatherUnwarped (unwarped, 0.0);
  if (!support_.select (unwarped))
    return;
  const bool has_faces = selectGroups (unwarped);
  std::vector<char> is_done (sides.size (), 0);
  for (std::size_t i = 0; i < sides.size (); ++i)
  {
    const int group = has_faces ? groups_.groupOf (sides[i].face) : -1;
    std::vector<std::size_t> of;
    places_.clear ();
    for (std::size_t j = i; j < sides.size (); ++j)
    {
      Eigen::Vector3d place = sides[j].place;
      if (is_done[j] || (has_faces && (group < 0 || groups_.groupOf (sides[j].face) != group)))
        continue;
      is_done[j] = 1;
      if (warp_ != nullptr && !unwarp (sides[j].place, place))
        continue;
      of.push_back (j);
      places_.push_back (place + field_.points ().origin);
    }
    unwarping_ = unwarping; // of x
    sampleTogether (unwarped, group, of, slope == Slope::EXACT ? Task::SIDES : Task::SLOPES_OF_SIDES, samples);
  }
}

void
LocalField::sampleTogether (const Eigen::Vector3d &x, int group, const std::vector<std::size_t> &of, Task task,
                            std::vector<LocalSample> &samples)
{
  result_ = FieldSample ();
  side_results_.clear ();
  if (of.empty () || (group >= 0 && !support_.selectPart (x, groups_.groupsOfSlots (), group)))
    return;
  fitSelected (x, task);
  for (std::size_t i = 0; i < side_results_.size (); ++i)
  {
    LocalSample &sample = samples[of[i]];
    static_cast<FieldSample &> (sample) = side_results_[i];
    sample.radius = support_.radius ();
    if (warp_ != nullptr)
      sample.gradient = unwarping_.transpose () * sample.gradient;
  }
}

int
LocalField::sharpSurfaceAt (const Eigen::Vector3d &x)
{
  Eigen::Vector3d unwarped = x;
  if (warp_ != nullptr && !unwarp (x, unwarped))
    return -1;
  gatherUnwarped (unwarped, 0.0);
  if (!support_.select (unwarped))
    return -1;
  const bool has_faces = selectGroups (unwarped);
  enrichment_.select (support_, unwarped);
  double least = 0.0;
  int best = enrichment_.nearestSurface (least);
  best = best < 0 ? -1 : field_.placeOfEnriching (best);
  if (!has_faces)
    return best;
  std::vector<LocalSample> samples;
  for (const Meeting *meeting : groups_.separationsAt (unwarped))
  {
    sampleOnSides (x, {{meeting->face, x}, {meeting->other, x}}, samples, Slope::OF_THE_FIT);
    const LocalSample &one = samples.front (), &other = samples.back ();
    const double miss = std::max (std::abs (one.value), std::abs (other.value));
    if (one.isDefined () && other.isDefined () && (best < 0 || miss < least))
    {
      least = miss;
      best = meeting->surface;
    }
  }
  return best;
}

} // namespace erkpa
