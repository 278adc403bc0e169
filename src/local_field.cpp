// SPDX-License-Identifier: BSD-3-Clause
#include "local_field.h"

#include "field_fit.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

namespace erkpa
{

void
LocalField::gather (const Eigen::Vector3d &center, double extent)
{
  if (warp_ == nullptr)
  {
    gatherUnwarped (center, extent);
    return;
  }
  startGuess (center);
  constexpr double MARGIN = 1.5; // the Jacobian changes over the ball; points beyond gather for themselves
  const double stretch = Eigen::JacobiSVD<Eigen::Matrix3d> (unwarping_).singularValues ()[0];
  gatherUnwarped (guess_ + unwarping_ * (center - warped_center_), MARGIN * stretch * extent);
}

void
LocalField::gatherUnwarped (const Eigen::Vector3d &center, double extent)
{
  ball_center_ = center;
  ball_extent_ = extent;
  support_.gather (center, extent, groups_.gather (center, extent));
  groups_.assign (support_.points ().size (), [this] (std::size_t slot) { return support_.points ()[slot].node; });
  enrichment_.gather (support_);
}

/** \brief Points near \a center are sought from where its nearest node comes from. */
void
LocalField::startGuess (const Eigen::Vector3d &center)
{
  std::vector<int> nearest;
  std::vector<float> squared;
  field_.surfaceSearch ().nearestK (center.cast<float> (), 1, nearest, squared);
  if (nearest.empty ())
    return;
  const auto node = static_cast<std::size_t> (nearest.front ());
  guess_ = field_.points ().positions[node].cast<double> ();
  warped_center_ = field_.surfacePositions ()[node].cast<double> ();
  unwarping_ = warp_->jacobian (guess_ + field_.points ().origin).inverse ();
}

bool
LocalField::unwarp (const Eigen::Vector3d &x, Eigen::Vector3d &unwarped)
{
  const Eigen::Vector3d &origin = field_.points ().origin;
  constexpr double TOLERANCE = 1e-6; // of the nodes' spacing; the method stops far below where it can
  Eigen::Vector3d position = guess_ + origin;
  if (!warp_->invert (x + origin, position, TOLERANCE * field_.spacing ()))
    return false;
  unwarping_ = warp_->jacobian (position).inverse ();
  unwarped = position - origin;
  return unwarped.allFinite () && unwarping_.allFinite ();
}

double
LocalField::value (const Eigen::Vector3d &x)
{
  evaluate (x, Task::VALUE);
  return result_.value;
}

LocalSample
LocalField::sample (const Eigen::Vector3d &x)
{
  LocalSample sample;
  if (evaluate (x, Task::GRADIENT))
    static_cast<FieldSample &> (sample) = result_;
  sample.radius = support_.radius ();
  sample.border_offset = borderOffset ();
  if (warp_ != nullptr)
    sample.gradient = unwarping_.transpose () * sample.gradient; // of f (warp^-1 (x))
  return sample;
}

std::vector<ShapeFunction>
LocalField::shapeFunctions (const Eigen::Vector3d &x)
{
  shape_functions_.clear ();
  evaluate (x, Task::SHAPE_FUNCTIONS);
  return shape_functions_;
}

bool
LocalField::evaluate (const Eigen::Vector3d &x, Task task)
{
  result_ = FieldSample ();
  if (warp_ == nullptr)
    return evaluateUnwarped (x, task);
  Eigen::Vector3d unwarped;
  if (!unwarp (x, unwarped))
    return false;
  if ((unwarped - ball_center_).norm () > ball_extent_)
    gatherUnwarped (unwarped, 0.0);
  return evaluateUnwarped (unwarped, task);
}

bool
LocalField::evaluateUnwarped (const Eigen::Vector3d &x, Task task)
{
  has_face_centroid_ = runs_out_ = false;
  if (!support_.covers (x))
    gatherUnwarped (x, 0.0);
  if (!support_.select (x))
    return false;
  // At creases both faces are close: there sampleOnSides () makes no such exception.
  const bool is_one_face = groups_.hasMeetings () &&
                           FaceVote::isOneFaceEnough (support_.nearestDistance (), support_.radius (), least_wall_) &&
                           holdsOneFace ();
  if (!is_one_face && selectGroups (x))
    return evaluateFaces (x, task);
  face_ = nearestFace ();
  thickening_ = 0.0;
  const bool is_defined = fitSelected (x, task);
  side_key_ = sideKeyOf (face_, enrichment_.sideKey ());
  return is_defined;
}

/** \brief Whether the nodes close to x are of one face. */
bool
LocalField::holdsOneFace ()
{
  support_.listWithin (FaceGroups::CLOSE * support_.radius (), slots_near_);
  const auto is_off = [this] (int slot) { return support_.points ()[static_cast<std::size_t> (slot)].side != 0; };
  slots_near_.erase (std::remove_if (slots_near_.begin (), slots_near_.end (), is_off), slots_near_.end ());
  return groups_.areOfOneFace (slots_near_);
}

/** \brief Group the nodes around x by their faces; false where no two groups are kept apart. */
bool
LocalField::selectGroups (const Eigen::Vector3d &x)
{
  if (!groups_.hasMeetings ())
    return false;
  support_.listWithin (FaceGroups::REACH * support_.radius (), slots_near_);
  places_near_.clear ();
  for (const int slot : slots_near_)
    places_near_.push_back (groups_.placeOfSlot (slot));
  return groups_.select (x, places_near_);
}

bool
LocalField::fitSelected (const Eigen::Vector3d &x, Task task)
{
  ++evaluations_;
  support_nodes_ += support_.nodes ().size ();
  enrichment_.select (support_, x);
  switch (field_.options ().order)
  {
    case Order::CONSTANT:
      fit<ConstantBasis> (task);
      break;
    case Order::LINEAR:
      fit<LinearBasis> (task);
      break;
    case Order::AUTOMATIC: // settled by the field
    case Order::SPHERICAL:
      fit<SphericalBasis> (task);
      break;
    case Order::QUADRATIC:
      fit<QuadraticBasis> (task);
      break;
  }
  return result_.isDefined ();
}

/** \brief The nodes near x that belong to a face have a say in how the faces combine. */
void
LocalField::startVote (const Eigen::Vector3d &x, int groups)
{
  vote_.start (support_.radius ());
  for (const int near : slots_near_)
  {
    const auto slot = static_cast<std::size_t> (near);
    const double t = std::sqrt (support_.squaredDistance (slot)) / (FaceGroups::REACH * vote_.radius ());
    const int group = t < 1.0 ? groups_.groupOfSlot (near) : -1;
    if (group >= 0 && group < groups && support_.points ()[slot].side == 0)
      vote_.addVoter ({near, (support_.position (slot) - x) / vote_.radius (), 1.0 - t});
  }
}

bool
LocalField::evaluateFaces (const Eigen::Vector3d &x, Task task)
{
  const int count = std::min (groups_.count (), FaceTree::MAX_FACES);
  const double spacing = support_.radius () * std::sqrt (M_PI / static_cast<double> (support_.nodes ().size ()));
  startVote (x, count);
  const std::vector<int> &parts = groups_.groupsOfSlots ();
  for (int group = 0; group < count; ++group)
    if (support_.selectPart (x, parts, group) && fitSelected (x, Task::HEIGHTS))
      vote_.addFace (group, result_.value, slope_, nearestInSupport (), heights_);
  vote_.dropFarFaces ();
  result_ = FieldSample ();
  thickening_ = 0.0;
  if (vote_.size () > 0)
  {
    const FaceTree &tree = vote_.electTree ();
    const std::size_t winner = vote_.winnerOf (tree);
    thickening_ = vote_.thickening (tree, least_wall_);
    support_.selectPart (x, parts, vote_.groupOf (winner));
    face_ = nearestFace ();
    face_centroid_ = supportCentroid ();
    has_face_centroid_ = true;
    runs_out_ = vote_.isInThinWall (tree, spacing);
    if (task != Task::VALUE)
      fitSelected (x, task);
    side_key_ = sideKeyOf (face_, enrichment_.sideKey ());
    result_.value = vote_.valueOf (winner) - thickening_;
  }
  support_.select (x);
  return result_.isDefined ();
}

double
LocalField::nearestInSupport () const
{
  double nearest = HUGE_VAL;
  for (const SupportNode &node : support_.nodes ())
    nearest = std::min (nearest, node.u.squaredNorm ());
  return std::sqrt (nearest) * support_.radius ();
}

/** \brief Face of the nearest node in the support selected. */
int
LocalField::nearestFace () const
{
  if (field_.faces () == nullptr)
    return -1;
  double nearest = HUGE_VAL;
  int face = -1;
  for (const SupportNode &node : support_.nodes ())
    if (groups_.faceOfSlot (node.slot) >= 0 && node.u.squaredNorm () < nearest)
    {
      nearest = node.u.squaredNorm ();
      face = groups_.faceOfSlot (node.slot);
    }
  return face;
}

template <typename BasisT>
void
LocalField::fit (Task task)
{
  if (enrichment_.size () == 0)
    fitWith<BasisT, BasisT::SIZE, BasisT::SIZE> (task);
  else
    fitWith<BasisT, Eigen::Dynamic, BasisT::SIZE + Enrichment::MAX_TERMS> (task);
}

template <typename BasisT, int Size, int MaxSize>
void
LocalField::fitWith (Task task)
{
  FieldFit<BasisT, Size, MaxSize> fit (field_.points (), field_.options ().constraint, support_, enrichment_);
  if (task == Task::SIDES || task == Task::SLOPES_OF_SIDES)
  {
    for (const Eigen::Vector3d &place : places_)
    {
      enrichment_.lookFrom (&place);
      fit.lookAgain ();
      result_.gradient = task == Task::SIDES ? fit.gradient () : fit.slope ();
      result_.value = fit.value ();
      side_results_.push_back (result_);
    }
    return;
  }
  result_.value = fit.value ();
  if (task == Task::HEIGHTS)
  {
    slope_ = fit.slope ();
    heights_.clear ();
    for (const FaceVote::Voter &voter : vote_.voters ())
      heights_.push_back (fit.heightAt (voter.slot, voter.u * (vote_.radius () / support_.radius ())));
  }
  if (task == Task::GRADIENT)
    result_.gradient = fit.gradient ();
  else if (task == Task::SHAPE_FUNCTIONS)
    fit.shapeFunctions (shape_functions_);
}

Eigen::Vector3d
LocalField::supportCentroid () const
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  double total = 0.0;
  for (const SupportNode &node : support_.nodes ())
  {
    sum += node.weight * node.u;
    total += node.weight;
  }
  return total > 0.0 ? Eigen::Vector3d (sum / total) : Eigen::Vector3d::Constant (HUGE_VAL);
}

double
LocalField::borderOffset () const
{
  const Eigen::Vector3d aside = centroid ();
  const double slope = result_.gradient.norm ();
  if (!aside.allFinite () || !(slope > 0.0))
    return HUGE_VAL;
  const Eigen::Vector3d normal = result_.gradient / slope;
  return (aside - aside.dot (normal) * normal).norm ();
}

void
LocalField::blendAttributes (float *attributes) const
{
  const OrientedPoints &points = field_.points ();
  const auto channels = static_cast<std::size_t> (points.channels);
  double total = 0.0;
  std::vector<double> sums (channels, 0.0);
  for (const SupportNode &node : support_.nodes ())
  {
    const auto i = static_cast<std::size_t> (support_.pointOf (node).node);
    total += node.weight;
    for (std::size_t c = 0; c < channels; ++c)
      sums[c] += node.weight * static_cast<double> (points.attributes[i * channels + c]);
  }
  for (std::size_t c = 0; c < channels; ++c)
    attributes[c] = total > 0.0 ? static_cast<float> (sums[c] / total) : 0.0f;
}

} // namespace erkpa
