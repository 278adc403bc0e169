// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/oriented_points.h>

#include "text.h"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>
#include <utility>

namespace erkpa
{

namespace
{

const float *
at (const PointView &view, const float *first, int index)
{
  return reinterpret_cast<const float *> (reinterpret_cast<const char *> (first) +
                                          static_cast<std::size_t> (index) * view.stride);
}

bool
isFinite (const float *p)
{
  return std::isfinite (p[0]) && std::isfinite (p[1]) && std::isfinite (p[2]);
}

Outcome
chosenPoints (const PointView &view, std::vector<int> &chosen)
{
  if (view.indices == nullptr)
  {
    chosen.resize (view.size);
    std::iota (chosen.begin (), chosen.end (), 0);
    return {};
  }
  for (const int index : *view.indices)
    if (index < 0 || static_cast<std::size_t> (index) >= view.size)
      return {Status::BAD_INDICES, "index " + std::to_string (index) + " is outside the input cloud of " +
                                       std::to_string (view.size) + " points: check setIndices ()"};
  chosen = *view.indices;
  return {};
}

/** \brief Drops the chosen points for which \a is_bad; returns how many. */
template <typename TestT>
std::size_t
dropIf (std::vector<int> &chosen, TestT is_bad)
{
  const auto end = std::remove_if (chosen.begin (), chosen.end (), is_bad);
  const auto count = static_cast<std::size_t> (chosen.end () - end);
  chosen.erase (end, chosen.end ());
  return count;
}

/** \brief Of points with equal coordinates drops all but the first; returns how many. */
std::size_t
dropRepeated (const PointView &view, std::vector<int> &chosen)
{
  struct Place
  {
    float x, y, z;
    int rank; // in chosen
  };
  std::vector<Place> places (chosen.size ());
  for (std::size_t rank = 0; rank < chosen.size (); ++rank)
  {
    const float *p = at (view, view.position, chosen[rank]);
    places[rank] = {p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f, static_cast<int> (rank)}; // -0 becomes 0
  }
  const auto before = [] (const Place &a, const Place &b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z != b.z ? a.z < b.z : a.rank < b.rank;
  };
  std::sort (places.begin (), places.end (), before);
  std::vector<char> repeated (chosen.size (), 0);
  std::size_t count = 0;
  for (std::size_t i = 1; i < places.size (); ++i)
    if (places[i].x == places[i - 1].x && places[i].y == places[i - 1].y && places[i].z == places[i - 1].z)
    {
      repeated[static_cast<std::size_t> (places[i].rank)] = 1;
      ++count;
    }
  std::size_t kept = 0;
  for (std::size_t rank = 0; rank < chosen.size (); ++rank)
    if (!repeated[rank])
      chosen[kept++] = chosen[rank];
  chosen.resize (kept);
  return count;
}

/** \brief Whether what the view gives per point is given for all points. */
Outcome
checkCounts (const PointView &view)
{
  const std::pair<const char *, std::size_t> counts[] = {
      {"confidences", view.confidences.size ()}, {"radii", view.radii.size ()}, {"shapes", view.shapes.size ()}};
  for (const auto &[name, count] : counts)
    if (count != 0 && count != view.size)
      return {Status::INVALID_SETTING, std::to_string (count) + " " + name + " are given for an input cloud of " +
                                           std::to_string (view.size) + " points: give one for each"};
  return {};
}

Outcome
checkRadii (const PointView &view, const std::vector<int> &chosen)
{
  for (const int i : chosen)
  {
    const float radius = view.radii.empty () ? 1.0f : view.radii[static_cast<std::size_t> (i)];
    if (!(radius > 0.0f) || !std::isfinite (radius))
      return {Status::INVALID_SETTING, "point " + std::to_string (i) + " has the support radius " + toText (radius) +
                                           ": every radius must be positive and finite"};
  }
  return {};
}

/** \brief A support may be narrower than the ball of its radius, not wider: the search does not look further. */
Outcome
checkShapes (const PointView &view, const std::vector<int> &chosen)
{
  constexpr double ROUNDING = 1e-4;
  for (const int i : chosen)
  {
    if (view.shapes.empty ())
      return {};
    const Eigen::Matrix3d shape = view.shapes[static_cast<std::size_t> (i)].cast<double> ();
    if (!shape.allFinite () || !(Eigen::JacobiSVD<Eigen::Matrix3d> (shape).singularValues ()[2] >= 1.0 - ROUNDING))
      return {Status::INVALID_SETTING,
              "the support of point " + std::to_string (i) +
                  " reaches beyond its radius: a shape must not have a singular value below 1"};
  }
  return {};
}

Eigen::Vector3d
middleOf (const PointView &view, const std::vector<int> &chosen)
{
  Eigen::Array3d low = Eigen::Array3d::Constant (HUGE_VAL), high = -low;
  for (const int i : chosen)
  {
    const Eigen::Array3d p = Eigen::Map<const Eigen::Array3f> (at (view, view.position, i)).cast<double> ();
    low = low.min (p);
    high = high.max (p);
  }
  return chosen.empty () ? Eigen::Vector3d (Eigen::Vector3d::Zero ()) : Eigen::Vector3d (0.5 * (low + high));
}

/** \brief The unit normal of a point, or zero where it has none. */
Eigen::Vector3f
normalOf (const PointView &view, int index)
{
  if (view.normal == nullptr || !isFinite (at (view, view.normal, index)))
    return Eigen::Vector3f::Zero ();
  const Eigen::Vector3d n = Eigen::Map<const Eigen::Vector3f> (at (view, view.normal, index)).cast<double> ();
  const double length = n.norm ();
  return length > 1e-12 ? Eigen::Vector3f ((n / length).cast<float> ()) : Eigen::Vector3f (Eigen::Vector3f::Zero ());
}

/** \brief Appends point \a i of the cloud. */
void
append (const PointView &view, int i, OrientedPoints &points)
{
  const Eigen::Vector3d p = Eigen::Map<const Eigen::Vector3f> (at (view, view.position, i)).cast<double> ();
  points.positions.emplace_back ((p - points.origin).cast<float> ());
  points.normals.push_back (normalOf (view, i));
  const auto index = static_cast<std::size_t> (i), channels = static_cast<std::size_t> (view.channels);
  for (std::size_t c = 0; c < channels; ++c)
    points.attributes.push_back (view.attributes[index * channels + c]);
  if (!view.confidences.empty ())
    points.confidences.push_back (view.confidences[index]);
  if (!view.radii.empty ())
    points.radii.push_back (view.radii[index]);
  if (!view.shapes.empty ())
    points.shapes.push_back (view.shapes[index]);
}

} // namespace

Outcome
collectPoints (const PointView &view, OrientedPoints &points, PointCounts &counts)
{
  points = OrientedPoints ();
  counts = PointCounts ();
  std::vector<int> chosen;
  Outcome outcome = checkCounts (view);
  if (outcome.ok ())
    outcome = chosenPoints (view, chosen);
  if (!outcome.ok ())
    return outcome;
  counts.read = chosen.size ();
  counts.not_finite = dropIf (chosen, [&] (int i) { return !isFinite (at (view, view.position, i)); });
  if (!view.confidences.empty ())
    counts.no_confidence = dropIf (chosen,
                                   [&] (int i)
                                   {
                                     const float confidence = view.confidences[static_cast<std::size_t> (i)];
                                     return !(confidence > 0.0f) || !std::isfinite (confidence);
                                   });
  counts.duplicate = dropRepeated (view, chosen);
  outcome = checkRadii (view, chosen);
  if (outcome.ok ())
    outcome = checkShapes (view, chosen);
  if (!outcome.ok ())
    return outcome;
  counts.used = chosen.size ();

  points.origin = middleOf (view, chosen);
  points.channels = view.channels;
  points.positions.reserve (chosen.size ());
  points.normals.reserve (chosen.size ());
  points.attributes.reserve (chosen.size () * static_cast<std::size_t> (view.channels));
  for (const int i : chosen)
    append (view, i, points);
  for (const Eigen::Vector3f &normal : points.normals)
    counts.without_normal += normal.isZero (0.0f) ? 1 : 0;
  return {};
}

} // namespace erkpa
