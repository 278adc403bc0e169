// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "height_fit.h"
#include "neighborhood.h"
#include "normal_sharpening.h"
#include "normal_smoothing.h"
#include "threads.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace erkpa
{

constexpr std::size_t FEWEST = 6;         // points of a plane
constexpr std::size_t FOR_A_QUADRIC = 10; // points: its six terms leave enough to tell whether it fits

inline double
angleBetween (const Eigen::Vector3f &a, const Eigen::Vector3f &b)
{
  return std::atan2 (a.cross (b).norm (), a.dot (b));
}

/** \brief The work behind sharpenNormals. */
class NormalSharpener
{
public:
  NormalSharpener (const NeighborSearch &search, const NormalScale &scale, int threads, const OrientedPoints &points)
      : search_ (search), spacing_ (scale.spacing), threads_ (threads), points_ (points),
        tolerance_ (scale.noise + 0.01 * scale.spacing),
        k_ (static_cast<int> (scale.k * (1.0 + std::min (0.5, 5.0 * scale.noise / scale.spacing))))
  {
  }

  /** \brief The new normals. */
  std::vector<Eigen::Vector3f>
  run ()
  {
    fits_.assign (points_.size (), HeightFit ());
    smooth_.assign (points_.size (), 1);
    forEachPoint ([this] (Neighborhood &near, std::size_t i) { fitAround (near, i); });
    chosen_ = fits_;
    forEachPoint ([this] (Neighborhood &near, std::size_t i) { choose (near, i); });
    takeNormals ();
    constexpr int ROUNDS = 2;
    for (int round = 0; round < ROUNDS; ++round)
    {
      forEachPoint ([this] (Neighborhood &near, std::size_t i) { refineByNormals (near, i); });
      takeNormals ();
    }
    return normals_;
  }

  /** \brief How far the neighbours of a point are from a smooth surface, in tolerances; 0 where they make one. */
  double
  roughness (Neighborhood &near, std::size_t i) const
  {
    gather (near, i, k_);
    if (near.nodes.size () < FEWEST)
      return 0.0;
    const HeightFit fit = fitAll (near, i);
    return isSmooth (fit) ? 0.0 : fit.deviation () / tolerance_;
  }

  /** \brief After run(): how far the given normal of a point leans to the other face of an edge it is close to.
   *
   * As a share of the angle between the faces; negative if it leans away. Zero and \a known false far from edges.
   */
  double
  leanOf (Neighborhood &near, std::size_t i, bool &known) const
  {
    constexpr int CLOSE = 6;
    constexpr double SHARP = 0.5; // radians
    gather (near, i, CLOSE);
    double sharpest = SHARP, lean = 0.0;
    known = false;
    for (const int j : near.nodes)
    {
      const Eigen::Vector3f &own = normals_[i], &other = normals_[static_cast<std::size_t> (j)];
      const double angle = angleBetween (own, other);
      if (smooth_[i] || !(angle > sharpest))
        continue;
      const Eigen::Vector3f to_other = (other - own.dot (other) * own).normalized ();
      const Eigen::Vector3f &given = points_.normals[i];
      lean = std::atan2 (given.dot (to_other), given.dot (own)) / angle;
      sharpest = angle;
      known = true;
    }
    return lean;
  }

  /** \brief Whether a point at an edge has neighbours whose normals are half way between its own and another face's.
   *
   * \a known is false where all normals are alike.
   */
  bool
  isBlended (Neighborhood &near, std::size_t i, bool &known) const
  {
    constexpr double SHARP = 0.35, MARGIN = 0.25; // radians; share of the angle
    gather (near, i, k_);
    const Eigen::Vector3f &own = points_.normals[i];
    const auto normal = [this] (int j) -> const Eigen::Vector3f &
    { return points_.normals[static_cast<std::size_t> (j)]; };
    const auto farther = [&] (int a, int b) { return own.dot (normal (a)) > own.dot (normal (b)); };
    const auto farthest = std::max_element (near.nodes.begin (), near.nodes.end (), farther);
    const double angle = farthest == near.nodes.end () ? 0.0 : angleBetween (own, normal (*farthest));
    known = angle > SHARP;
    const auto is_between = [angle] (double turn) { return turn > MARGIN * angle && turn < (1.0 - MARGIN) * angle; };
    return known && std::any_of (near.nodes.begin (), near.nodes.end (),
                                 [&] (int j) {
                                   return is_between (angleBetween (own, normal (j))) &&
                                          is_between (angleBetween (normal (*farthest), normal (j)));
                                 });
  }

  template <typename WorkT>
  void
  forEachPoint (WorkT work)
  {
    parallelFor (
        points_.size (), threads_, [] { return Neighborhood (); }, work);
  }

private:
  void
  gather (Neighborhood &near, std::size_t i, int k) const
  {
    constexpr float OPPOSITE = -0.3f; // cosine: the other side of a thin plate, even if smeared over its rim
    near.gather (search_, points_.positions, points_.positions[i], k,
                 [&] (std::size_t node) { return points_.normals[node].dot (points_.normals[i]) >= OPPOSITE; });
  }

  /** \brief Below the tolerance one deviation is as good as the other. */
  double
  atLeastTolerance (double deviation) const
  {
    return std::max (tolerance_, std::abs (deviation));
  }

  HeightFit
  fitAll (const Neighborhood &near, std::size_t i) const
  {
    return {near.positions, near.weights, points_.normals[i],
            spacing_,       tolerance_,   near.nodes.size () >= FOR_A_QUADRIC};
  }

  bool
  isSmooth (const HeightFit &fit) const
  {
    return fit.deviation () < 1.1 * tolerance_;
  }

  /** \brief The fit of a point's neighbours: of all of them where that is a smooth surface, else of fewer if better. */
  void
  fitAround (Neighborhood &near, std::size_t i)
  {
    gather (near, i, k_);
    if (near.nodes.size () < FEWEST)
      return; // keeps its normal
    const Eigen::Vector3f &side = points_.normals[i];
    HeightFit &best = fits_[i];
    best = fitAll (near, i);
    smooth_[i] = isSmooth (best);
    if (smooth_[i])
      return;
    near.sort (points_.positions, points_.positions[i]);
    for (const double share : {0.6, 0.4})
    {
      const auto fewer = static_cast<std::size_t> (share * k_);
      if (fewer < FEWEST || fewer >= near.nodes.size ())
        continue;
      near.positions.resize (fewer);
      near.weights.assign (fewer, 1.0f);
      near.nodes.resize (fewer);
      for (const bool curved : {true, false})
      {
        if (curved && fewer < FOR_A_QUADRIC + 2)
          continue;
        const HeightFit fit (near.positions, near.weights, side, spacing_, tolerance_, curved);
        if (atLeastTolerance (fit.deviation ()) < 0.8 * atLeastTolerance (best.deviation ()))
          best = fit;
      }
    }
  }

  /** \brief Of the fits around a point that is not on a smooth surface, the one that explains it best. */
  void
  choose (Neighborhood &near, std::size_t i)
  {
    if (smooth_[i])
      return;
    gather (near, i, k_ + k_ / 2);
    const Eigen::Vector3f &x = points_.positions[i];
    const HeightFit *best = &fits_[i];
    double least = HUGE_VAL;
    for (const int j : near.nodes)
    {
      const HeightFit &fit = fits_[static_cast<std::size_t> (j)];
      if (!(fit.weight () > 0.0))
        continue;
      const double deviation = atLeastTolerance (fit.deviation ()), distance = atLeastTolerance (fit.distance (x));
      const double reach = (x - fit.center ()).squaredNorm () / (spacing_ * spacing_);
      // The last two factors decide between equals: the closer one, and the one over more points.
      const double misfit =
          (deviation * deviation + distance * distance) * (1.0 + 0.01 * reach) * (1.0 + 10.0 / fit.weight ());
      if (misfit < least)
        best = &fit;
      least = std::min (least, misfit);
    }
    chosen_[i] = *best;
    refine (near, i, false);
  }

  /** \brief The same once more, by what the normals have become. */
  void
  refineByNormals (Neighborhood &near, std::size_t i)
  {
    if (smooth_[i])
      return;
    gather (near, i, k_ + k_ / 2);
    refine (near, i, true);
  }

  /** \brief Fits the chosen surface again, to the neighbours on it. */
  void
  refine (Neighborhood &near, std::size_t i, bool by_normals)
  {
    constexpr int TURNS = 2;
    constexpr float SETTLED = 1e-3f; // radians
    const Eigen::Vector3f &x = points_.positions[i];
    for (int turn = 0; turn < TURNS; ++turn)
    {
      const HeightFit &before = chosen_[i];
      const std::size_t on_it = weigh (near, before, by_normals);
      if (on_it < FEWEST)
        return;
      const HeightFit fit (near.positions, near.weights, before.normal (x), spacing_, tolerance_,
                           on_it >= FOR_A_QUADRIC);
      const double deviation = atLeastTolerance (fit.deviation ());
      if (std::abs (fit.distance (x)) > 3.0 * deviation || deviation > 1.2 * atLeastTolerance (before.deviation ()))
        return;
      const bool is_settled = (fit.normal (x) - before.normal (x)).norm () < SETTLED;
      chosen_[i] = fit;
      if (is_settled)
        return;
    }
  }

  /** \brief Weights of neighbours by their distance from a surface, and by their normals' angle with it if asked for.
   * \return how many lie on the surface
   */
  std::size_t
  weigh (Neighborhood &near, const HeightFit &surface, bool by_normals) const
  {
    constexpr float ANGLE = 0.18f; // radians
    const double sigma = 1.5 * atLeastTolerance (surface.deviation ());
    std::size_t on_it = 0;
    for (std::size_t j = 0; j < near.nodes.size (); ++j)
    {
      Eigen::Vector3f normal;
      const auto distance = static_cast<float> (surface.distance (near.positions[j], normal) / sigma);
      float squares = distance * distance;
      if (by_normals)
        squares += (normal - normals_[static_cast<std::size_t> (near.nodes[j])]).squaredNorm () / (ANGLE * ANGLE);
      near.weights[j] = squares < 9.0f ? std::exp (-0.5f * squares) : 0.0f;
      on_it += near.weights[j] > 0.3f;
    }
    return on_it;
  }

  void
  takeNormals ()
  {
    normals_ = points_.normals;
    for (std::size_t i = 0; i < points_.size (); ++i)
    {
      const Eigen::Vector3f normal = chosen_[i].normal (points_.positions[i]);
      if (chosen_[i].weight () > 0.0 && normal.allFinite ())
        normals_[i] = normal;
    }
  }

  const NeighborSearch &search_;
  const double spacing_;
  const int threads_;
  const OrientedPoints &points_;
  const double tolerance_;               // of what counts as lying on a surface, input's unit of length
  const int k_;                          // neighbours of a fit
  std::vector<HeightFit> fits_, chosen_; // of each point: around it, and that it lies on; no weight where unknown
  std::vector<char> smooth_;             // whether the former is the latter
  std::vector<Eigen::Vector3f> normals_; // new ones
};

} // namespace erkpa
