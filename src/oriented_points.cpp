// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/oriented_points.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>

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

/** \brief Drops points that are not finite, then all but the first of those with equal coordinates. */
void
dropUnusable (const PointView &view, std::vector<int> &chosen, PointCounts &counts)
{
  const auto finite_end =
      std::remove_if (chosen.begin (), chosen.end (), [&] (int i) { return !isFinite (at (view, view.position, i)); });
  counts.not_finite = static_cast<std::size_t> (chosen.end () - finite_end);
  chosen.erase (finite_end, chosen.end ());

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
  for (std::size_t i = 1; i < places.size (); ++i)
    if (places[i].x == places[i - 1].x && places[i].y == places[i - 1].y && places[i].z == places[i - 1].z)
    {
      repeated[static_cast<std::size_t> (places[i].rank)] = 1;
      ++counts.duplicate;
    }
  std::size_t kept = 0;
  for (std::size_t rank = 0; rank < chosen.size (); ++rank)
    if (!repeated[rank])
      chosen[kept++] = chosen[rank];
  chosen.resize (kept);
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

} // namespace

Outcome
collectPoints (const PointView &view, OrientedPoints &points, PointCounts &counts)
{
  points = OrientedPoints ();
  counts = PointCounts ();
  std::vector<int> chosen;
  Outcome outcome = chosenPoints (view, chosen);
  if (!outcome.ok ())
    return outcome;
  counts.read = chosen.size ();
  dropUnusable (view, chosen, counts);
  counts.used = chosen.size ();

  points.origin = middleOf (view, chosen);
  points.channels = view.channels;
  points.positions.reserve (chosen.size ());
  points.normals.reserve (chosen.size ());
  points.attributes.reserve (chosen.size () * static_cast<std::size_t> (view.channels));
  for (const int i : chosen)
  {
    const Eigen::Vector3d p = Eigen::Map<const Eigen::Vector3f> (at (view, view.position, i)).cast<double> ();
    points.positions.emplace_back ((p - points.origin).cast<float> ());
    points.normals.push_back (normalOf (view, i));
    counts.without_normal += points.normals.back ().isZero (0.0f) ? 1 : 0;
    for (int c = 0; c < view.channels; ++c)
      points.attributes.push_back (
          view.attributes[static_cast<std::size_t> (i) * static_cast<std::size_t> (view.channels) +
                          static_cast<std::size_t> (c)]);
  }
  return {};
}

} // namespace erkpa
