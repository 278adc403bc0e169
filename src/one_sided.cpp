// SPDX-License-Identifier: BSD-3-Clause
#include "one_sided.h"

#include "orientation_graph.h"
#include "orientation_links.h"
#include "orientation_planes.h"
#include "seen_side.h"

#include <cmath>
#include <cstddef>
#include <optional>

namespace erkpa
{

OneSided::OneSided (const OrientedPoints &points, const NeighborSearch &search, int k, const NormalOptions &options)
    : points_ (points), search_ (search), k_ (k), options_ (options)
{
}

const Facets &
OneSided::facetsOf (const std::vector<Eigen::Vector3f> &normals)
{
  if (facets_.of_node.empty ())
    facets_ = facetsOfNormals (points_, search_, SurfaceKind::OPEN, k_, options_.threads, normals);
  return facets_;
}

bool
OneSided::tellsWalls (const std::vector<Eigen::Vector3f> &normals)
{
  constexpr double ALIKE = 0.7; // noise of single sheets, beside that of all neighbours
  constexpr double CLEAN = 0.1; // spacings
  const Facets &facets = facetsOf (normals);
  return facets.tolerance < CLEAN * facets.spacing ||
         noiseOfSheets (points_, search_, facets.spacing, options_.threads) > ALIKE * facets.tolerance;
}

bool
OneSided::orient (std::vector<Eigen::Vector3f> &normals)
{
  if (was_asked_)
    return false; // as before
  was_asked_ = true;
  std::optional<Eigen::Vector3f> view_point;
  if (options_.has_view_point)
    view_point = (options_.view_point - points_.origin).cast<float> ();
  std::optional<Viewer> viewer = findViewer (points_, facetsOf (normals), view_point);
  if (!viewer || !agreesWithGiven (*viewer))
    return false;
  std::vector<signed char> sides = sidesOf (*viewer);
  decideRest (sides);
  for (std::size_t i = 0; i < normals.size (); ++i)
    if (sides[i] < 0)
      normals[i] = -normals[i];
  orientation_ = viewer->is_far ? Orientation::ONE_SIDE : Orientation::VIEW_POINT;
  return true;
}

/** \brief Whether given normals look at the viewer; one far out changes sides if they look away. */
bool
OneSided::agreesWithGiven (Viewer &viewer) const
{
  constexpr double NEARLY_ALL = 0.85;
  double given = 0.0, facing = 0.0;
  for (std::size_t i = 0; i < points_.size (); ++i)
    if (!points_.normals[i].isZero (0.0f))
    {
      given += 1.0;
      facing += points_.normals[i].dot (viewer.from (points_.positions[i])) >= 0.0f ? 1.0 : 0.0;
    }
  if (viewer.is_far && facing < (1.0 - NEARLY_ALL) * given)
  {
    viewer.place = -viewer.place;
    return true;
  }
  return facing >= NEARLY_ALL * given;
}

/** \brief For each node, whether its normal has the right sign, 1 or -1; 0 where someone far out cannot tell: on walls
 * along the line of sight. */
std::vector<signed char>
OneSided::sidesOf (const Viewer &viewer) const
{
  constexpr float STEEP = 0.4f; // cosine
  std::vector<signed char> sides (points_.size (), 1);
  for (std::size_t i = 0; i < sides.size (); ++i)
    if (points_.normals[i].isZero (0.0f))
    {
      const float cosine = facets_.of_node[i].normal.dot (viewer.from (points_.positions[i]));
      sides[i] = viewer.is_far && std::abs (cosine) < STEEP ? 0 : cosine < 0.0f ? -1 : 1;
    }
  return sides;
}

/** \brief Walls get their signs from the nodes around. */
void
OneSided::decideRest (std::vector<signed char> &sides) const
{
  std::vector<int> rest;
  for (std::size_t i = 0; i < sides.size (); ++i)
    if (sides[i] == 0)
      rest.push_back (static_cast<int> (i));
  if (rest.empty ())
    return;
  const auto decided = static_cast<int> (sides.size ()); // all of them are one node of the graph
  std::vector<SignedLink> links = linkNeighbors (points_, search_, facets_, rest, options_.threads);
  for (SignedLink &link : links)
    if (const signed char side = sides[static_cast<std::size_t> (link.to)]; side != 0)
      link = {link.from, decided, static_cast<float> (side) * link.weight};
  const std::vector<char> flips = agreeOnSigns (decided + 1, links, links.size (), options_.threads);
  for (const int node : rest)
    sides[static_cast<std::size_t> (node)] = flips[static_cast<std::size_t> (node)] == flips.back () ? 1 : -1;
}

} // namespace erkpa
