// SPDX-License-Identifier: BSD-3-Clause
#include "edge_places.h"

#include "face_map.h"

#include <erkpa/face_of_points.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>

namespace erkpa
{

namespace
{

/** \brief Whether a face has so few points that it is in doubt as a whole. */
bool
isSmall (const SharpSurface &face)
{
  constexpr std::size_t FEW = 40;
  const FacePoints *points = pointsBehind (face);
  return points != nullptr && points->positions.size () < FEW;
}

} // namespace

EdgePlaces::EdgePlaces (const std::vector<SharpSurface::ConstPtr> &edges, const Eigen::Vector3d &origin, int threads)
    : origin_ (origin)
{
  for (const SharpSurface::ConstPtr &surface : edges)
    addEdge (surface);
  std::vector<Eigen::Vector3f> positions;
  for (const auto &[e, p] : places_)
    positions.push_back ((edges_[e].places[p] - origin_).cast<float> ());
  if (!positions.empty ())
    grid_ = PointGrid (positions, reach_, threads);
}

void
EdgePlaces::addEdge (const SharpSurface::ConstPtr &surface)
{
  Edge edge;
  edge.whole = surface;
  Extent::ConstPtr extent;
  if (separatesFaces (*surface) && facesBehind (*surface, edge.face, edge.other, extent))
  {
    const ExtentParts parts = extent->parts ();
    edge.places = parts.points;
    edge.reach = parts.length;
  }
  for (std::size_t p = 0; p < edge.places.size (); ++p)
    places_.emplace_back (edges_.size (), p);
  edge.is_kept.assign (edge.places.size (), 1);
  reach_ = std::max (reach_, edge.reach);
  edges_.push_back (std::move (edge));
}

bool
EdgePlaces::reach (const Eigen::Vector3d &x) const
{
  return !places_.empty () && grid_.hasWithin (x - origin_, reach_);
}

void
EdgePlaces::findAround (const Eigen::Vector3d &x)
{
  around_.clear ();
  if (places_.empty ())
    return;
  grid_.withinRadius (x - origin_, reach_, found_.nodes, found_.squared);
  for (const int found : found_.nodes)
    around_.push_back (places_[static_cast<std::size_t> (found)]);
}

void
EdgePlaces::clearFaceAt (const Eigen::Vector3d &x)
{
  findAround (x);
  const SharpSurface *face = faceAt (x);
  for (const auto &[e, p] : around_)
    if (edges_[e].face.get () == face || edges_[e].other.get () == face)
      edges_[e].is_kept[p] = 0;
}

void
EdgePlaces::clearAllAt (const Eigen::Vector3d &x, bool small_wholly)
{
  findAround (x);
  for (const auto &[e, p] : around_)
    if (small_wholly && (isSmall (*edges_[e].face) || isSmall (*edges_[e].other)))
      std::fill (edges_[e].is_kept.begin (), edges_[e].is_kept.end (), 0);
    else
      edges_[e].is_kept[p] = 0;
}

const SharpSurface *
EdgePlaces::faceAt (const Eigen::Vector3d &x) const
{
  std::map<const SharpSurface *, double> heights;
  const SharpSurface *nearest = nullptr;
  for (const auto &[e, p] : around_)
    for (const SharpSurface *face : {edges_[e].face.get (), edges_[e].other.get ()})
    {
      const auto [height, is_new] = heights.try_emplace (face, 0.0);
      if (!is_new)
        continue;
      height->second = std::abs (face->theta (x));
      if (nearest == nullptr || height->second < heights.at (nearest))
        nearest = face;
    }
  return nearest;
}

std::vector<SharpSurface::ConstPtr>
EdgePlaces::rest (double shortest) const
{
  std::vector<SharpSurface::ConstPtr> surfaces;
  for (const Edge &edge : edges_)
    if (SharpSurface::ConstPtr surface = restOf (edge, shortest))
      surfaces.push_back (std::move (surface));
  return surfaces;
}

SharpSurface::ConstPtr
EdgePlaces::restOf (const Edge &edge, double shortest) const
{
  std::vector<Eigen::Vector3d> kept;
  Eigen::AlignedBox3d box;
  for (std::size_t p = 0; p < edge.places.size (); ++p)
    if (edge.is_kept[p] != 0)
    {
      kept.push_back (edge.places[p]);
      box.extend (kept.back ());
    }
  if (kept.size () == edge.places.size ())
    return edge.whole;
  Extent::ConstPtr extent;
  if (kept.empty () || box.diagonal ().norm () < shortest || !makePointsExtent (kept, edge.reach, extent).ok ())
    return nullptr;
  return makeLimited (makeSharpBetween (edge.face, edge.other), extent);
}

} // namespace erkpa
