// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/oriented_points.h>

#include "parallel_collect.h"
#include "repeated_points.h"
#include "text.h"

#include <Eigen/SVD>

#include <algorithm>
#include <atomic>
#include <cmath>
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
dropIf (std::vector<int> &chosen, int threads, TestT is_bad)
{
  std::vector<int> kept =
      parallelCollect<std::vector<int>> (chosen.size (), threads,
                                         [&] (std::size_t first, std::size_t last, std::vector<int> &part)
                                         {
                                           part.reserve (last - first);
                                           for (std::size_t rank = first; rank < last; ++rank)
                                             if (!is_bad (chosen[rank]))
                                               part.push_back (chosen[rank]);
                                         });
  const std::size_t count = chosen.size () - kept.size ();
  chosen.swap (kept);
  return count;
}

Eigen::Vector3f
positionOf (const PointView &view, int index)
{
  return Eigen::Map<const Eigen::Vector3f> (at (view, view.position, index));
}

/** \brief Of points with equal coordinates drops all but the first; returns how many. */
std::size_t
dropRepeated (const PointView &view, int threads, std::vector<int> &chosen)
{
  std::vector<Eigen::Vector3f> positions (chosen.size ());
  parallelRanges (chosen.size (), threads,
                  [&] (std::size_t first, std::size_t last)
                  {
                    for (std::size_t rank = first; rank < last; ++rank)
                      positions[rank] = positionOf (view, chosen[rank]);
                  });
  const std::vector<int> repeated = findRepeated (positions, threads);
  for (std::size_t i = 0; i < repeated.size (); ++i)
  {
    const auto first = static_cast<std::ptrdiff_t> (repeated[i]) + 1;
    const auto last = static_cast<std::ptrdiff_t> (i + 1 < repeated.size () ? static_cast<std::size_t> (repeated[i + 1])
                                                                            : chosen.size ());
    std::copy (chosen.begin () + first, chosen.begin () + last,
               chosen.begin () + first - static_cast<std::ptrdiff_t> (i) - 1);
  }
  chosen.resize (chosen.size () - repeated.size ());
  return repeated.size ();
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
middleOf (const PointView &view, int threads, const std::vector<int> &chosen)
{
  struct Box
  {
    Eigen::Array3f low = Eigen::Array3f::Constant (HUGE_VALF), high = -low;
  };
  if (chosen.empty ())
    return Eigen::Vector3d::Zero ();
  constexpr std::size_t STRETCH = 16384;
  Box box;
  parallelFor ((chosen.size () + STRETCH - 1) / STRETCH, threads, [] { return Box (); },
               [&] (Box &part, std::size_t s)
               {
                 for (std::size_t rank = s * STRETCH; rank < std::min (chosen.size (), (s + 1) * STRETCH); ++rank)
                 {
                   const Eigen::Array3f p = positionOf (view, chosen[rank]);
                   part.low = part.low.min (p);
                   part.high = part.high.max (p);
                 }
               },
               [&box] (const Box &part)
               {
                 box.low = box.low.min (part.low);
                 box.high = box.high.max (part.high);
               });
  return 0.5 * (box.low.cast<double> () + box.high.cast<double> ());
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

/** \brief The values that all points have of one kind, \a count per point, for the chosen ones. */
template <typename T>
std::vector<T>
choose (const std::vector<T> &values, std::size_t count, const std::vector<int> &chosen)
{
  std::vector<T> result;
  if (values.empty ())
    return result;
  result.reserve (count * chosen.size ());
  for (const int i : chosen)
  {
    const auto first = values.begin () + static_cast<std::ptrdiff_t> (count) * i;
    result.insert (result.end (), first, first + static_cast<std::ptrdiff_t> (count));
  }
  return result;
}

/** \brief Fill in the chosen points; returns how many have no normal. */
std::size_t
fillIn (const PointView &view, int threads, const std::vector<int> &chosen, OrientedPoints &points)
{
  points.positions.resize (chosen.size ());
  points.normals.resize (chosen.size ());
  std::atomic<std::size_t> without_normal{0};
  parallelRanges (chosen.size (), threads,
                  [&] (std::size_t first, std::size_t last)
                  {
                    std::size_t without = 0;
                    for (std::size_t i = first; i < last; ++i)
                    {
                      const Eigen::Vector3d p = positionOf (view, chosen[i]).cast<double> ();
                      points.positions[i] = (p - points.origin).cast<float> ();
                      points.normals[i] = normalOf (view, chosen[i]);
                      without += points.normals[i].isZero (0.0f) ? 1 : 0;
                    }
                    without_normal += without;
                  });
  points.attributes = choose (view.attributes, static_cast<std::size_t> (view.channels), chosen);
  points.confidences = choose (view.confidences, 1, chosen);
  points.radii = choose (view.radii, 1, chosen);
  points.shapes = choose (view.shapes, 1, chosen);
  return without_normal;
}

} // namespace

Outcome
collectPoints (const PointView &view, OrientedPoints &points, PointCounts &counts, int threads)
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
  counts.not_finite = dropIf (chosen, threads, [&] (int i) { return !isFinite (at (view, view.position, i)); });
  if (!view.confidences.empty ())
    counts.no_confidence = dropIf (chosen, threads,
                                   [&] (int i)
                                   {
                                     const float confidence = view.confidences[static_cast<std::size_t> (i)];
                                     return !(confidence > 0.0f) || !std::isfinite (confidence);
                                   });
  counts.duplicate = dropRepeated (view, threads, chosen);
  outcome = checkRadii (view, chosen);
  if (outcome.ok ())
    outcome = checkShapes (view, chosen);
  if (!outcome.ok ())
    return outcome;
  counts.used = chosen.size ();

  points.origin = middleOf (view, threads, chosen);
  points.channels = view.channels;
  counts.without_normal = fillIn (view, threads, chosen, points);
  return {};
}

} // namespace erkpa
