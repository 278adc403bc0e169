// SPDX-License-Identifier: BSD-3-Clause
#include "orientation_facets.h"

#include "height_fit.h"
#include "noise.h"
#include "normal_smoothing.h"
#include "orientation_planes.h"
#include "threads.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace erkpa
{

namespace
{

constexpr std::size_t FEWEST = 5;         // points of a plane
constexpr double HIDDEN = 0.5;            // spacings of noise: faces cannot be told from few points
constexpr std::size_t FOR_A_QUADRIC = 10; // points: its six terms leave enough to tell whether it fits

class FacetFinder
{
public:
  FacetFinder (const OrientedPoints &points, const NeighborSearch &search, SurfaceKind kind, int k, int threads,
               const std::vector<Eigen::Vector3f> &normals)
      : points_ (points), search_ (search), kind_ (kind), k_ (k), threads_ (threads), normals_ (normals),
        spacing_ (measureSpacing (points.positions, search, threads))
  {
    if (!(spacing_ > 0.0))
      return; // points that lie upon each other
    OrientedPoints with_normals;
    with_normals.positions = points.positions;
    with_normals.normals = normals;
    double noise = positionNoise (search, spacing_, threads, with_normals);
    if (kind_ == SurfaceKind::CLOSED)
      noise = std::min (noise, noiseOfSheets (points, search, spacing_, threads));
    tolerance_ = noise + 0.04 * spacing_;
    if (kind_ == SurfaceKind::CLOSED && noise < 0.05 * spacing_)
      k_ = std::min (k_, CLEAN_SUPPORT); // more were chosen because two sheets looked like one noisy one
  }

  Facets
  run ()
  {
    fits_.assign (points_.size (), HeightFit ());
    smooth_.assign (points_.size (), 0);
    Facets facets;
    facets.of_node.resize (points_.size ());
    facets.spacing = spacing_;
    facets.tolerance = tolerance_;
    facets.kind = kind_;
    facets.k = k_;
    if (!(tolerance_ < HIDDEN * spacing_))
      return fromNormals ();
    const auto scratch = [] { return FacetNeighborhood (); };
    parallelFor (points_.size (), threads_, scratch,
                 [&] (FacetNeighborhood &near, std::size_t i) { fitAround (near, i); });
    parallelFor (points_.size (), threads_, scratch,
                 [&] (FacetNeighborhood &near, std::size_t i) { facets.of_node[i] = choose (near, i); });
    return facets;
  }

  /** \brief The estimated normals themselves: where noise hides the faces, fits to fewer points are worse. */
  Facets
  fromNormals () const
  {
    Facets facets;
    facets.kind = kind_;
    facets.k = k_;
    facets.spacing = spacing_ > 0.0 ? spacing_ : 1.0;
    facets.tolerance = spacing_ > 0.0 ? tolerance_ : 1.0;
    for (const Eigen::Vector3f &normal : normals_)
      facets.of_node.push_back ({normal, static_cast<float> (facets.tolerance), 0.0f});
    return facets;
  }

private:
  double
  atLeastTolerance (double deviation) const
  {
    return std::max (tolerance_, std::abs (deviation));
  }

  /** \brief The fit of all neighbours where they are a smooth surface, else of those on a plane through the point. */
  void
  fitAround (FacetNeighborhood &near, std::size_t i)
  {
    near.gatherAll (search_, points_.positions, i, k_);
    const Eigen::Vector3f &x = points_.positions[i], &side = normals_[i];
    if (near.nodes.size () < FEWEST)
      return;
    HeightFit &best = fits_[i];
    best = HeightFit (near.positions, near.weights, side, spacing_, tolerance_, near.nodes.size () >= FOR_A_QUADRIC);
    smooth_[i] = best.deviation () < 1.1 * tolerance_ && std::abs (best.distance (x)) < 3.0 * tolerance_;
    if (smooth_[i])
      return;
    near.sort (points_.positions, x);
    Eigen::Vector3f normal = fullestPlane (near, side);
    std::size_t on_it = weigh (
        near, [&] (const Eigen::Vector3f &p) { return normal.dot (p - x); }, 2.0 * tolerance_);
    constexpr int TURNS = 2;
    for (int turn = 0; turn < TURNS && on_it >= FEWEST; ++turn)
    {
      best = HeightFit (near.positions, near.weights, side, spacing_, tolerance_, on_it >= FOR_A_QUADRIC);
      on_it = weigh (
          near, [&] (const Eigen::Vector3f &p) { return best.distance (p); },
          2.0 * atLeastTolerance (best.deviation ()));
    }
  }

  /** \brief Sum over the neighbours of how nearly they lie on a plane through the first of them. */
  float
  fullness (const FacetNeighborhood::Ways &ways, const Eigen::Vector3f &normal) const
  {
    const auto per_square = static_cast<float> (0.25 / (tolerance_ * tolerance_));
    const auto heights = normal[0] * ways.col (0) + normal[1] * ways.col (1) + normal[2] * ways.col (2);
    return (1.0f + per_square * heights.square ()).inverse ().sum ();
  }

  /** \brief Normal of the plane through the first neighbour and two others that most of them lie on. */
  Eigen::Vector3f
  fullestPlane (FacetNeighborhood &near, const Eigen::Vector3f &estimated) const
  {
    constexpr float BETTER = 1.1f; // than the plane that was estimated from all
    FacetNeighborhood::Ways &ways = near.ways;
    ways.resize (static_cast<Eigen::Index> (near.positions.size ()), 3);
    for (std::size_t j = 0; j < near.positions.size (); ++j)
      ways.row (static_cast<Eigen::Index> (j)) = (near.positions[j] - near.positions.front ()).transpose ().array ();
    Eigen::Vector3f best = estimated;
    float most = BETTER * fullness (ways, estimated);
    visitPlanes (near, spacing_,
                 [&] (const Eigen::Vector3f &normal)
                 {
                   const float sum = fullness (ways, normal);
                   if (sum > most)
                     best = normal;
                   most = std::max (most, sum);
                 });
    return best;
  }

  template <typename DistanceT>
  static std::size_t
  weigh (FacetNeighborhood &near, DistanceT distance, double sigma)
  {
    std::size_t on_it = 0;
    for (std::size_t j = 0; j < near.positions.size (); ++j)
    {
      const auto share = static_cast<float> (distance (near.positions[j]) / sigma);
      near.weights[j] = share * share < 9.0f ? std::exp (-0.5f * share * share) : 0.0f;
      on_it += near.weights[j] > 0.3f;
    }
    return on_it;
  }

  /** \brief Of the fits around a point that is not on a smooth surface, the one that explains it best. */
  Facet
  choose (FacetNeighborhood &near, std::size_t i) const
  {
    const Eigen::Vector3f &x = points_.positions[i];
    const HeightFit *best = &fits_[i];
    double least = smooth_[i] ? 0.0 : HUGE_VAL;
    if (!smooth_[i])
      near.gatherAll (search_, points_.positions, i, k_);
    for (std::size_t j = 0; !smooth_[i] && j < near.nodes.size (); ++j)
    {
      const HeightFit &fit = fits_[static_cast<std::size_t> (near.nodes[j])];
      if (!(fit.weight () > 0.0))
        continue;
      const double deviation = atLeastTolerance (fit.deviation ()), distance = atLeastTolerance (fit.distance (x));
      const double reach = (x - fit.center ()).squaredNorm () / (spacing_ * spacing_);
      const double few = 10.0 / fit.weight ();
      const double misfit =
          (deviation * deviation + distance * distance) * (1.0 + 0.05 * reach) * (1.0 + few * few * few);
      if (misfit < least)
        best = &fit;
      least = std::min (least, misfit);
    }
    Facet facet;
    facet.normal = best->normal (x);
    facet.deviation =
        static_cast<float> (std::max (atLeastTolerance (best->deviation ()), std::abs (best->distance (x))));
    if (!(best->weight () > 0.0) || !facet.normal.allFinite ())
      return {normals_[i], static_cast<float> (spacing_), 0.0f};
    facet.bend = bendOf (*best, x, facet.normal);
    return facet;
  }

  /** \brief How far the fit's normal turns within a spacing, in the direction where it turns most. */
  float
  bendOf (const HeightFit &fit, const Eigen::Vector3f &x, const Eigen::Vector3f &normal) const
  {
    const Eigen::Vector3f u = normal.unitOrthogonal (), v = normal.cross (u);
    float bend = 0.0f;
    for (const Eigen::Vector3f &way :
         {u, v, Eigen::Vector3f (M_SQRT1_2 * (u + v)), Eigen::Vector3f (M_SQRT1_2 * (u - v))})
      bend = std::max (bend, (fit.normal (x + static_cast<float> (spacing_) * way) - normal).norm ());
    return bend;
  }

  const OrientedPoints &points_;
  const NeighborSearch &search_;
  const SurfaceKind kind_;
  int k_;
  const int threads_;
  const std::vector<Eigen::Vector3f> &normals_;
  const double spacing_;
  double tolerance_ = 0.0;
  std::vector<HeightFit> fits_; // around each point; no weight where unknown
  std::vector<char> smooth_;    // whether that is over all neighbours
};

} // namespace

Facets
findFacets (const OrientedPoints &points, const NeighborSearch &search, SurfaceKind kind, int k, int threads,
            const std::vector<Eigen::Vector3f> &normals)
{
  return FacetFinder (points, search, kind, k, threads, normals).run ();
}

Facets
facetsOfNormals (const OrientedPoints &points, const NeighborSearch &search, SurfaceKind kind, int k, int threads,
                 const std::vector<Eigen::Vector3f> &normals)
{
  return FacetFinder (points, search, kind, k, threads, normals).fromNormals ();
}

} // namespace erkpa
