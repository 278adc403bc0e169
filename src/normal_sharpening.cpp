// SPDX-License-Identifier: BSD-3-Clause
#include "normal_sharpening.h"

#include "normal_smoothing.h"
#include "threads.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace erkpa
{

namespace
{

double env (const char *n, double d) { const char *v = std::getenv (n); return v ? std::atof (v) : d; }

struct Scratch
{
  std::vector<int> indices;
  std::vector<float> squared;
  std::vector<std::pair<float, int>> order;
  std::vector<Eigen::Vector3f> points;
  std::vector<int> nodes;
  std::vector<float> weights;
};

class Sharpener
{
public:
  Sharpener (const NeighborSearch &search, double spacing, int k, int threads, const OrientedPoints &points)
      : search_ (search), points_ (points), spacing_ (spacing), k_ (k), threads_ (threads),
        noise_ (positionNoise (search, spacing, threads, points)), floor_ (noise_ + env ("FLOOR", 0.01) * spacing)
  {
  }

  void
  run (std::vector<Eigen::Vector3f> &normals)
  {
    k_ = k_ * (1.0 + std::min (env ("KM", 0.5), env ("KN", 5) * noise_ / spacing_));
    const std::size_t n = points_.size ();
    fits_.resize (n);
    smooth_.assign (n, 0);
    normals = points_.normals;
    parallelFor (n, threads_, [] { return Scratch (); }, [&] (Scratch &s, std::size_t i) { fitNode (s, i); });
    refined_ = fits_;
    parallelFor (n, threads_, [] { return Scratch (); }, [&] (Scratch &s, std::size_t i) { choose (s, i); });
    const int passes = env ("PASSES", 2);
    for (std::size_t i = 0; i < n; ++i)
      normals[i] = refined_[i].normal (points_.positions[i]);
    for (int p = 0; p < passes; ++p)
    {
      now_ = normals;
      parallelFor (n, threads_, [] { return Scratch (); }, [&] (Scratch &s, std::size_t i) { agree (s, i); });
      for (std::size_t i = 0; i < n; ++i)
        normals[i] = refined_[i].normal (points_.positions[i]);
    }
  }

  std::vector<char> smooth_;

private:
  /** \brief Neighbours sorted by distance whose normals are not opposite. */
  void
  gather (Scratch &s, std::size_t i, int k) const
  {
    search_.nearestK (points_.positions[i], k, s.indices, s.squared);
    s.order.clear ();
    for (std::size_t j = 0; j < s.indices.size (); ++j)
      s.order.emplace_back (s.squared[j], s.indices[j]);
    std::sort (s.order.begin (), s.order.end ());
    s.points.clear ();
    s.nodes.clear ();
    for (const auto &[d, j] : s.order)
      if (points_.normals[std::size_t (j)].dot (points_.normals[i]) > -0.3f)
      {
        s.points.push_back (points_.positions[std::size_t (j)]);
        s.nodes.push_back (j);
      }
    s.weights.assign (s.points.size (), 1.0f);
  }

  double cost (double deviation) const { return std::max (deviation, floor_); }

  void
  fitNode (Scratch &s, std::size_t i)
  {
    gather (s, i, k_);
    if (s.points.size () < 6) { fits_[i] = HeightFit (s.points, s.weights, points_.normals[i], spacing_, floor_, false); smooth_[i] = 1; return; }
    const Eigen::Vector3f &side = points_.normals[i];
    fits_[i] = HeightFit (s.points, s.weights, side, spacing_, floor_, s.points.size () > 9);
    smooth_[i] = fits_[i].deviation () < env ("SMOOTH", 1.5) * floor_;
    if (smooth_[i])
      return;
    for (const double share : {env ("SH1", 0.6), env ("SH2", 0.4)})
    {
      const std::size_t count = std::size_t (share * k_);
      if (s.points.size () <= count)
        continue;
      std::vector<Eigen::Vector3f> p (s.points.begin (), s.points.begin () + count);
      std::vector<float> w (count, 1.0f);
      for (bool curved : {true, false})
      {
        if (curved && count < 12) continue;
        const HeightFit f (p, w, side, spacing_, floor_, curved);
        if (cost (f.deviation ()) < env ("PREF", 0.8) * cost (fits_[i].deviation ()))
          fits_[i] = f;
      }
    }
  }

  void
  choose (Scratch &s, std::size_t i)
  {
    if (smooth_[i])
      return;
    gather (s, i, k_ * env ("K1", 1));
    double best = 1e300;
    const Eigen::Vector3f &x = points_.positions[i];
    for (const int j : s.nodes)
    {
      const HeightFit &f = fits_[std::size_t (j)];
      const double e = cost (f.deviation ()), d = cost (std::abs (f.distance (x)));
      const double reach = (x - f.center ()).squaredNorm () / (spacing_ * spacing_);
      double m = 0.0;
      if (env ("MSAC", 0) > 0)
      {
        const double sg = 2.0 * floor_;
        double ws = 0;
        for (std::size_t l = 0; l < s.points.size (); ++l)
        {
          const double q = f.distance (s.points[l]) / sg;
          const double w = std::exp (-0.5 * (s.points[l] - x).squaredNorm () / std::pow (env ("MW", 1.5) * spacing_, 2));
          m += w * std::min (1.0, q * q);
          ws += w;
        }
        m *= env ("MSAC", 0) * floor_ * floor_ / ws;
      }
      const double c = (e * e + d * d + m) * (1.0 + env ("REACH", 0.1) * reach) * (1.0 + env ("W", 4) / f.weight ());
      if (c < best)
      {
        best = c;
        refined_[i] = f;
      }
    }
    refine (s, i, false);
  }

  void
  refine (Scratch &s, std::size_t i, bool normals)
  {
    const Eigen::Vector3f &x = points_.positions[i];
    for (int it = 0; it < int (env ("IT", 3)); ++it)
    {
      const HeightFit &f = refined_[i];
      const double sigma = env ("SG", 2.0) * cost (f.deviation ());
      float total = 0.0f;
      for (std::size_t j = 0; j < s.nodes.size (); ++j)
      {
        const double d = f.distance (s.points[j]) / sigma;
        double e = d * d;
        if (normals)
        {
          const Eigen::Vector3f n = f.normal (s.points[j]);
          e += (n - now_[std::size_t (s.nodes[j])]).squaredNorm () / std::pow (env ("NS", 0.25), 2);
        }
        s.weights[j] = std::exp (-0.5 * e);
        if (s.weights[j] < 0.01f) s.weights[j] = 0;
        total += s.weights[j];
      }
      int used = 0;
      for (float w : s.weights) used += w > 0.3f;
      if (used < 6) return;
      const HeightFit g (s.points, s.weights, f.normal (x), spacing_, floor_, used >= 10);
      if (std::abs (g.distance (x)) > 3.0 * cost (g.deviation ())) return;
      if (cost (g.deviation ()) > 1.2 * cost (f.deviation ())) return;
      refined_[i] = g;
    }
  }

  void
  agree (Scratch &s, std::size_t i)
  {
    if (smooth_[i])
      return;
    gather (s, i, k_ * env ("K2", 1));
    double best = 1e300;
    const Eigen::Vector3f &x = points_.positions[i];
    HeightFit chosen = refined_[i];
    for (const int j : s.nodes)
    {
      const HeightFit &f = fits_[std::size_t (j)];
      (void) f; (void) best; (void) x;
    }
    refined_[i] = chosen;
    refine (s, i, true);
  }

  const NeighborSearch &search_;
  const OrientedPoints &points_;
  double spacing_;
  int k_, threads_;
  double noise_, floor_;
  std::vector<HeightFit> fits_, refined_;
  std::vector<Eigen::Vector3f> now_;
};

} // namespace

void
sharpenNormals (const NeighborSearch &search, double spacing, int k, int threads, OrientedPoints &points)
{
  Sharpener s (search, spacing, k, threads, points);
  std::vector<Eigen::Vector3f> normals;
  s.run (normals);
  points.normals.swap (normals);
}

bool
areNormalsSmeared (const NeighborSearch &, double, int, int, const OrientedPoints &)
{
  return false;
}

} // namespace erkpa
