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

constexpr double FEWEST_COLUMNS = 50.0; // that say something

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
  return COLUMN_WIDTH * spacing / std::max (static_cast<double> (*middle), spacing);
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

/** \brief What the columns along the lines of sight hold. */
struct ColumnSurvey
{
  ColumnCount single, several; ///< of one layer, and of more; those where layers cannot be counted are neither
  double points = 0.0;         ///< in all columns that were looked at

  double
  counted () const
  {
    return single.points + several.points;
  }

  /** \brief Whether there are as many points behind others as a surface has that turns back behind itself, or another
   * object: what a sensor sees through something shares the points that it gets there. */
  bool
  hasFullLayersBehind () const
  {
    constexpr double SOME = 0.005, ENOUGH = 10.0, AS_MANY = 1.5;
    return several.points > SOME * points && several.columns > ENOUGH &&
           several.pointsPerColumn () > AS_MANY * single.pointsPerColumn ();
  }
};

ColumnSurvey
surveyColumns (const OrientedPoints &points, const Facets &facets, const Viewer &viewer)
{
  constexpr std::size_t ENOUGH = 20000; // points
  ColumnSurvey survey;
  visitColumns (lookAtLayers (points, facets, viewer, columnWidth (points, facets.spacing, viewer),
                              std::max<std::uint64_t> (1, points.size () / ENOUGH)),
                [&] (const Crossing *begin, const Crossing *end)
                {
                  survey.points += static_cast<double> (end - begin);
                  if (const int layers = countLayers (begin, end, facets.spacing); layers > 0)
                    (layers == 1 ? survey.single : survey.several).add (end - begin);
                });
  return survey;
}

/** \brief Whether most of the surface lies across a direction. */
bool
liesAcross (const Facets &facets, const Eigen::Vector3f &way)
{
  constexpr double MOSTLY = 0.75; // mean cosine; half a sphere: 0.5
  double sum = 0.0;
  for (const Facet &facet : facets.of_node)
    sum += std::abs (static_cast<double> (facet.normal.dot (way)));
  return sum > MOSTLY * static_cast<double> (facets.of_node.size ());
}

/** \brief Whether a sensor at a known place sees all of the surface: one layer nearly everywhere where it does not look
 * along the surface. */
bool
isSeenFrom (const OrientedPoints &points, const Facets &facets, const Viewer &viewer)
{
  constexpr double NEARLY_ALL = 0.85, LEAST = 0.1; // across closed surfaces and from inside of them 0.7 at most
  const ColumnSurvey survey = surveyColumns (points, facets, viewer);
  return survey.counted () > LEAST * survey.points &&
         survey.single.columns + survey.several.columns >= FEWEST_COLUMNS && !survey.hasFullLayersBehind () &&
         survey.single.points > NEARLY_ALL * survey.counted ();
}

/** \brief Whether the surface looks as if it had been seen from far out: one layer nearly everywhere, or, if most of it
 * lies across the line of sight, in many places. */
bool
isSeenAlong (const OrientedPoints &points, const Facets &facets, const Eigen::Vector3f &way)
{
  constexpr double NEARLY_ALL = 0.85, MANY = 0.25; // of all points
  const ColumnSurvey survey = surveyColumns (points, facets, {way, true});
  return survey.single.columns + survey.several.columns >= FEWEST_COLUMNS && !survey.hasFullLayersBehind () &&
         survey.single.points > (liesAcross (facets, way) ? MANY : NEARLY_ALL) * survey.points;
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

/** \brief Whether the side that facets look to along \a way is the one to look at: towards the view point if that is on
 * the same side of nearly all of them, else where the surface bulges out, else up. */
bool
isOuterSide (const OrientedPoints &points, const Facets &facets, const Eigen::Vector3f &way,
             const std::optional<Eigen::Vector3f> &view_point)
{
  constexpr double BULGE = 0.25, NEARLY_ALL = 0.85; // half a sphere bulges by 0.5
  Eigen::Vector3d middle = Eigen::Vector3d::Zero ();
  for (const Eigen::Vector3f &x : points.positions)
    middle += x.cast<double> () / static_cast<double> (points.size ());
  double outwards = 0.0, distances = 0.0, to_view_point = 0.0;
  for (std::size_t i = 0; i < points.size (); ++i)
  {
    const Eigen::Vector3f &x = points.positions[i], &normal = facets.of_node[i].normal;
    const double side = normal.dot (way) < 0.0f ? -1.0 : 1.0;
    const Eigen::Vector3d from_middle = x.cast<double> () - middle;
    outwards += side * normal.cast<double> ().dot (from_middle);
    distances += from_middle.norm ();
    if (view_point)
      to_view_point += normal.dot (*view_point - x) < 0.0f ? -side : side;
  }
  if (std::abs (to_view_point) > (2.0 * NEARLY_ALL - 1.0) * static_cast<double> (points.size ()))
    return to_view_point > 0.0;
  return std::abs (outwards) > BULGE * distances ? outwards > 0.0 : way.z () >= 0.0f;
}

} // namespace

std::optional<Viewer>
findViewer (const OrientedPoints &points, const Facets &facets, const std::optional<Eigen::Vector3f> &view_point)
{
  constexpr float FAR = 1e4f; // diagonals of the cloud: floats cannot tell lines of sight from there
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f &x : points.positions)
    box.extend (x);
  const bool is_near = view_point && (*view_point - box.center ()).stableNorm () < FAR * box.diagonal ().stableNorm ();
  if (is_near && isSeenFrom (points, facets, {*view_point, false}))
    return Viewer{*view_point, false};
  const Eigen::Vector3f way = mainNormal (facets);
  if (!way.allFinite () || !isSeenAlong (points, facets, way))
    return std::nullopt;
  return Viewer{isOuterSide (points, facets, way, view_point) ? way : Eigen::Vector3f (-way), true};
}

} // namespace erkpa
