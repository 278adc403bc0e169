// SPDX-License-Identifier: BSD-3-Clause
#include "flaps.h"

#include "edge_places.h"
#include "local_field.h"
#include "parallel_collect.h"
#include "point_grid.h"
#include "stage_clock.h"
#include "threads.h"

#include <erkpa/point_layout.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace erkpa
{

namespace
{

using Positions = std::vector<Eigen::Vector3d>;

/** \brief For the vertices at the border of a mesh the direction away from it; zero for others. */
std::vector<Eigen::Vector3f>
findOutwards (const TriangleMesh &mesh)
{
  struct Side
  {
    std::pair<int, int> ends;
    int across;
  };
  std::vector<Side> sides;
  sides.reserve (3 * mesh.triangles.size ());
  for (const auto &triangle : mesh.triangles)
    for (std::size_t c = 0; c < 3; ++c)
      sides.push_back ({std::minmax (triangle[c], triangle[(c + 1) % 3]), triangle[(c + 2) % 3]});
  std::sort (sides.begin (), sides.end (), [] (const Side &one, const Side &other) { return one.ends < other.ends; });
  std::vector<Eigen::Vector3f> outwards (mesh.vertices.size (), Eigen::Vector3f::Zero ());
  const auto at = [&mesh] (int v) { return mesh.vertices[static_cast<std::size_t> (v)]; };
  for (std::size_t first = 0, last = 0; first < sides.size (); first = last)
  {
    while (last < sides.size () && sides[last].ends == sides[first].ends)
      ++last;
    const auto [a, b] = sides[first].ends;
    if (last - first == 1)
      for (const int end : {a, b})
        outwards[static_cast<std::size_t> (end)] += 0.5f * (at (a) + at (b)) - at (sides[first].across);
  }
  for (Eigen::Vector3f &outward : outwards)
    outward.normalize (); // zeros stay
  return outwards;
}

/** \brief Asks the surface without edges about places, in the local frame. */
class SmoothSurface
{
public:
  /** \param[in] limit border offset at which it ends */
  SmoothSurface (const ImplicitField &field, double limit) : field_ (field), limit_ (limit), local_ (field) {}

  /** \brief Whether it is elsewhere than a place far from the points: not so in a gap between them. */
  bool
  isOff (const Eigen::Vector3d &x)
  {
    constexpr double OFF = 0.5; // of the distance from the points
    const PointGrid &grid = *field_.layout ().grid;
    const std::size_t nearest = grid.index ()[grid.nearest (x)];
    const double distance = (field_.points ().positions[nearest].cast<double> () - x).norm ();
    const LocalSample sample = sampleAt (x);
    return !(std::abs (sample.value) <= OFF * distance * sample.gradient.norm ());
  }

  /** \brief Whether it does not end where it is nearest to a place. */
  bool
  goesOnAt (const Eigen::Vector3d &x)
  {
    constexpr int STEPS = 3;
    constexpr double CLEARLY = 0.5; // of the limit
    Eigen::Vector3d foot = x;
    LocalSample sample = sampleAt (foot);
    for (int step = 0; step < STEPS && sample.isDefined () && !sample.gradient.isZero (0.0); ++step)
    {
      foot -= sample.value / sample.gradient.squaredNorm () * sample.gradient;
      sample = sampleAt (foot);
    }
    return sample.isDefined () && sample.border_offset < CLEARLY * limit_;
  }

private:
  LocalSample
  sampleAt (const Eigen::Vector3d &x)
  {
    local_.gather (x, 0.0);
    return local_.sample (x);
  }

  const ImplicitField &field_;
  double limit_;
  LocalField local_;
};

/** \brief Finds the vertices of flaps. */
class FlapFinder
{
public:
  FlapFinder (const ImplicitField &field, const Options &options, const TriangleMesh &mesh, const Report &report)
      : field_ (field), options_ (options), mesh_ (mesh), threads_ (options.polygonizer.threads),
        reach_ (REACH * std::max (field.spacing (), report.polygonizer.voxel_size)),
        outwards_ (report.topology.boundary_edges > 0 ? findOutwards (mesh) : std::vector<Eigen::Vector3f> ())
  {
  }

  Positions
  find (const EdgePlaces &edges) const
  {
    const std::vector<std::size_t> candidates = listCandidates (edges);
    if (candidates.empty ())
      return {};
    const ImplicitField::ConstPtr smooth = field_.remade (options_.field, threads_);
    std::vector<char> is_flap (candidates.size (), 0);
    parallelFor (
        candidates.size (), threads_, [&] { return SmoothSurface (*smooth, options_.polygonizer.border_offset); },
        [&] (SmoothSurface &surface, std::size_t c)
        {
          const std::size_t v = candidates[c];
          const Eigen::Vector3d x = at (v) - field_.points ().origin;
          is_flap[c] = (isFar (v) && surface.isOff (x)) || (isBorder (v) && surface.goesOnAt (beyond (v))) ? 1 : 0;
        });
    Positions flaps;
    for (std::size_t c = 0; c < candidates.size (); ++c)
      if (is_flap[c] != 0)
        flaps.push_back (at (candidates[c]));
    return withOthers (flaps);
  }

private:
  static constexpr double REACH = 1.75; // spacings or voxels: farther from the points there is no surface

  Eigen::Vector3d
  at (std::size_t v) const
  {
    return mesh_.vertices[v].cast<double> ();
  }

  bool
  isBorder (std::size_t v) const
  {
    return !outwards_.empty () && !outwards_[v].isZero (0.0f);
  }

  /** \brief A place beyond the border, where data that end there end for the surface without edges, too. */
  Eigen::Vector3d
  beyond (std::size_t v) const
  {
    return at (v) - field_.points ().origin + 0.6 * reach_ * outwards_[v].cast<double> ();
  }

  bool
  isFar (std::size_t v) const
  {
    return !field_.layout ().grid->hasWithin (at (v) - field_.points ().origin, reach_);
  }

  /** \brief The vertices near edges that are at a border or far from the points. */
  std::vector<std::size_t>
  listCandidates (const EdgePlaces &edges) const
  {
    constexpr std::size_t STRETCH = 4096;
    return parallelCollect<std::vector<std::size_t>> (
        mesh_.vertices.size (), threads_,
        [&] (std::size_t first, std::size_t last, std::vector<std::size_t> &candidates)
        {
          for (std::size_t v = first; v < last; ++v)
            if ((isBorder (v) || isFar (v)) && edges.reach (at (v)))
              candidates.push_back (v);
        },
        STRETCH);
  }

  /** \brief Those of some places that others are near: single vertices off the surface are no flap. */
  Positions
  withOthers (const Positions &places) const
  {
    constexpr std::size_t FEWEST = 4; // with itself
    if (places.size () < FEWEST)
      return {};
    std::vector<Eigen::Vector3f> positions;
    for (const Eigen::Vector3d &place : places)
      positions.push_back ((place - field_.points ().origin).cast<float> ());
    const double near = 2.0 * reach_;
    const PointGrid grid (positions, near, threads_);
    PointGrid::Places found;
    Positions kept;
    for (const Eigen::Vector3d &place : places)
    {
      grid.findWithin (place - field_.points ().origin, near, found);
      if (found.count >= FEWEST)
        kept.push_back (place);
    }
    return kept;
  }

  const ImplicitField &field_;
  const Options &options_;
  const TriangleMesh &mesh_;
  int threads_;
  double reach_;
  std::vector<Eigen::Vector3f> outwards_; // of the vertices; empty where the mesh is closed
};

} // namespace

bool
mendFlaps (const Options &options, const TriangleMesh &mesh, FlapEdges which, Report &report,
           ImplicitField::ConstPtr &field)
{
  const StageClock total (report.seconds_total), clock (report.seconds_sharp);
  constexpr double SHORTEST = 2.0; // spacings
  const int threads = options.polygonizer.threads;
  EdgePlaces edges (report.sharp_surfaces, field->points ().origin, threads);
  const Positions flaps = FlapFinder (*field, options, mesh, report).find (edges);
  for (const Eigen::Vector3d &flap : flaps)
    if (which == FlapEdges::OF_FACE)
      edges.clearFaceAt (flap);
    else
      edges.clearAllAt (flap, which == FlapEdges::SMALL_WHOLLY);
  std::vector<SharpSurface::ConstPtr> rest = edges.rest (SHORTEST * field->spacing ());
  if (rest == report.sharp_surfaces)
    return false;
  report.sharp_surfaces = std::move (rest);
  FieldOptions mended = options.field;
  mended.sharp_surfaces.insert (mended.sharp_surfaces.end (), report.sharp_surfaces.begin (),
                                report.sharp_surfaces.end ());
  field = field->remade (mended, threads);
  return true;
}

} // namespace erkpa
