// SPDX-License-Identifier: BSD-3-Clause
#include "seen_side.h"

#include "layer_columns.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace erkpa
{

namespace
{

/** \brief Share of the points that are in the only layer of their column. */
double
shareInSingleLayers (const OrientedPoints &points, const Facets &facets, const Viewer &viewer)
{
  double width = COLUMN_WIDTH * facets.spacing;
  if (!viewer.is_far)
  {
    std::vector<float> distances;
    distances.reserve (points.size ());
    for (const Eigen::Vector3f &x : points.positions)
      distances.push_back (viewer.from (x).norm ());
    const auto middle = distances.begin () + static_cast<std::ptrdiff_t> (distances.size () / 2);
    std::nth_element (distances.begin (), middle, distances.end ());
    width /= static_cast<double> (*middle);
  }
  std::ptrdiff_t single = 0;
  visitColumns (lookAtLayers (points, facets, viewer, width), [&] (const Crossing *begin, const Crossing *end)
                { single += countLayers (begin, end, facets.spacing) == 1 ? end - begin : 0; });
  return static_cast<double> (single) / static_cast<double> (points.size ());
}

bool
seesNearlyAll (const OrientedPoints &points, const Facets &facets, const Viewer &viewer)
{
  constexpr double NEARLY_ALL = 0.85; // a sensor: 0.95; across closed surfaces and from inside of them 0.4 at most
  return shareInSingleLayers (points, facets, viewer) > NEARLY_ALL;
}

/** \brief The direction that most facets look to, or away from. */
Eigen::Vector3f
mainNormal (const Facets &facets)
{
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero ();
  for (const Facet &facet : facets.of_node)
    products += (facet.normal * facet.normal.transpose ()).cast<double> ();
  const Eigen::Vector3f axis =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> (products).eigenvectors ().col (2).cast<float> ();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  for (const Facet &facet : facets.of_node)
    sum += (axis.dot (facet.normal) < 0.0f ? -1.0 : 1.0) * facet.normal.cast<double> ();
  return sum.normalized ().cast<float> ();
}

/** \brief Whether the surface lies across a direction, mostly. */
bool
liesAcross (const Facets &facets, const Eigen::Vector3f &way)
{
  constexpr double MOSTLY = 0.75; // mean cosine; half a sphere: 0.5
  double sum = 0.0;
  for (const Facet &facet : facets.of_node)
    sum += std::abs (static_cast<double> (facet.normal.dot (way)));
  return sum > MOSTLY * static_cast<double> (facets.of_node.size ());
}

/** \brief Whether the side that facets look to along \a way is the outer one: where the surface bulges out, else up. */
bool
isOuterSide (const OrientedPoints &points, const Facets &facets, const Eigen::Vector3f &way)
{
  constexpr double BULGE = 0.25; // half a sphere: 0.5
  Eigen::Vector3d middle = Eigen::Vector3d::Zero ();
  for (const Eigen::Vector3f &x : points.positions)
    middle += x.cast<double> () / static_cast<double> (points.size ());
  double outwards = 0.0, distances = 0.0;
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    const Eigen::Vector3d from_middle = points.positions[i].cast<double> () - middle,
                          normal = facets.of_node[i].normal.cast<double> ();
    outwards += (normal.dot (way.cast<double> ()) < 0.0 ? -1.0 : 1.0) * normal.dot (from_middle);
    distances += from_middle.norm ();
  }
  return std::abs (outwards) > BULGE * distances ? outwards > 0.0 : way.z () >= 0.0f;
}

} // namespace

std::optional<Viewer>
findViewer (const OrientedPoints &points, const Facets &facets, const std::optional<Eigen::Vector3f> &view_point,
            const Eigen::Vector3f &origin)
{
  if (view_point && seesNearlyAll (points, facets, {*view_point, false}))
    return Viewer{*view_point, false};
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f &x : points.positions)
    box.extend (x);
  if (!view_point && !box.contains (origin) && seesNearlyAll (points, facets, {origin, false}))
    return Viewer{origin, false};
  const Eigen::Vector3f way = mainNormal (facets);
  if (!way.allFinite () || !(liesAcross (facets, way) || seesNearlyAll (points, facets, {way, true})))
    return std::nullopt;
  return Viewer{isOuterSide (points, facets, way) ? way : Eigen::Vector3f (-way), true};
}

} // namespace erkpa
