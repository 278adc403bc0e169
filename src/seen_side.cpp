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

/** \brief Width of columns in which a layer that is there has a point. */
double
columnWidth (const OrientedPoints &points, double spacing, const Viewer &viewer)
{
  if (viewer.is_far)
    return COLUMN_WIDTH * spacing;
  std::vector<float> distances;
  distances.reserve (points.size ());
  for (const Eigen::Vector3f &x : points.positions)
    distances.push_back (viewer.from (x).norm ());
  const auto middle = distances.begin () + static_cast<std::ptrdiff_t> (distances.size () / 2);
  std::nth_element (distances.begin (), middle, distances.end ());
  return COLUMN_WIDTH * spacing / static_cast<double> (*middle);
}

/** \brief Columns of a kind, and the points in them. */
struct ColumnCount
{
  double columns = 0.0, points = 0.0;

  void
  add (std::ptrdiff_t count)
  {
    columns += 1.0;
    points += static_cast<double> (count);
  }

  double
  pointsPerColumn () const
  {
    return points / std::max (1.0, columns);
  }
};

/** \brief Whether the surface lies across the line of sight, mostly. */
bool
liesAcross (const OrientedPoints &points, const Facets &facets, const Viewer &viewer)
{
  constexpr double MOSTLY = 0.75; // mean cosine; half a sphere: 0.5
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size (); ++i)
    sum +=
        std::abs (static_cast<double> (facets.of_node[i].normal.dot (viewer.from (points.positions[i]).normalized ())));
  return sum > MOSTLY * static_cast<double> (points.size ());
}

/** \brief Whether the points are what a sensor sees from a place: one layer nearly everywhere, or, where it sees some
 * things through others, no more points in columns of several layers than in those of one. */
bool
isSeenBy (const OrientedPoints &points, const Facets &facets, const Viewer &viewer)
{
  constexpr double NEARLY_ALL = 0.85; // a sensor: 0.95; across closed surfaces and from inside of them 0.4 at most
  constexpr double FEW = 0.25, AS_MANY = 1.5;
  constexpr std::size_t ENOUGH = 20000; // points
  ColumnCount single, several;
  std::ptrdiff_t all = 0;
  visitColumns (lookAtLayers (points, facets, viewer, columnWidth (points, facets.spacing, viewer),
                              std::max<std::uint64_t> (1, points.size () / ENOUGH)),
                [&] (const Crossing *begin, const Crossing *end)
                {
                  all += end - begin;
                  if (const int layers = countLayers (begin, end, facets.spacing); layers > 0)
                    (layers == 1 ? single : several).add (end - begin);
                });
  const double share = single.points / static_cast<double> (std::max<std::ptrdiff_t> (1, all));
  return share > NEARLY_ALL || (share > FEW && several.pointsPerColumn () < AS_MANY * single.pointsPerColumn () &&
                                liesAcross (points, facets, viewer));
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
  if (view_point && isSeenBy (points, facets, {*view_point, false}))
    return Viewer{*view_point, false};
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f &x : points.positions)
    box.extend (x);
  if (!view_point && !box.contains (origin) && isSeenBy (points, facets, {origin, false}))
    return Viewer{origin, false};
  const Eigen::Vector3f way = mainNormal (facets);
  if (!way.allFinite () || !isSeenBy (points, facets, {way, true}))
    return std::nullopt;
  return Viewer{isOuterSide (points, facets, way) ? way : Eigen::Vector3f (-way), true};
}

} // namespace erkpa
