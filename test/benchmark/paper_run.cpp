// SPDX-License-Identifier: BSD-3-Clause
#include "paper_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <memory>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace paper
{

namespace
{

using Clock = std::chrono::steady_clock;

/** \brief Starts the measurement of the peak anew; where the system cannot, it is that of the whole program. */
void
resetPeakMemory ()
{
#ifdef __GLIBC__
  malloc_trim (0); // what earlier rows have freed is not this one's
#endif
  std::ofstream ("/proc/self/clear_refs") << "5";
}

double
peakMemory ()
{
  std::ifstream status ("/proc/self/status");
  std::string name;
  double kilobytes = 0.0;
  while (status >> name)
    if (name == "VmHWM:" && status >> kilobytes)
      break;
  return kilobytes / 1024.0;
}

erkpa::PointView
viewOf (const std::vector<Node> &nodes)
{
  erkpa::PointView view;
  view.size = nodes.size ();
  view.stride = sizeof (Node);
  view.position = nodes.front ().position.data ();
  view.normal = nodes.front ().normal.data ();
  return view;
}

/** \brief Finds the settings of a row and runs it. */
class RowRunner
{
public:
  RowRunner (const Row &row, const Model &model, Method method, int threads) : row_ (row), model_ (model)
  {
    options_.polygonizer.threads = threads;
    if (method == Method::FUNCTIONAL)
    {
      options_.field.constraint = erkpa::Constraint::FUNCTIONAL;
      options_.field.order = erkpa::Order::LINEAR;
      options_.field.kernel = erkpa::KernelType::PAPER;
    }
    std::vector<Eigen::Vector3f> positions;
    for (const Node &node : model.nodes)
      positions.push_back (node.position);
    search_ = erkpa::makeKdTreeSearch (positions);
  }

  Result
  run ()
  {
    if (!explore ())
      return result_;
    for (const Eigen::Vector4d &plane : model_.planes)
    {
      const double length = plane.head<3> ().norm ();
      options_.field.sharp_surfaces.push_back (
          std::make_shared<erkpa::SharpPlane> (plane.head<3> () / length, plane[3] / length));
    }
    // Rehearsals on coarse grids: the wide support is smoother than the narrow one explored with, and evaluations do
    // not lie quite where its mesh was.
    for (const double coarse : {4.0, 2.0})
      if (!reconstruct (coarse) || !correct (coarse))
        return result_;
    constexpr int TRIES = 2; // the fine grid may still differ
    for (int i = 0; i < TRIES && reconstruct (1.0) && !isClose (); ++i)
      if (i + 1 < TRIES && !correct (1.0))
        break;
    return result_;
  }

private:
  /** \brief Where the surface is and how many triangles it takes, from a support of few nodes. */
  bool
  explore ()
  {
    options_.field.k = 20;
    if (!reconstruct (1.0))
      return false;
    options_.field.k = 0;
    const erkpa::Report &report = result_.report;
    voxel_ = report.polygonizer.voxel_size * std::sqrt (static_cast<double> (report.triangles) / row_.triangles);
    constexpr std::size_t SAMPLES = 300;
    const std::size_t step = mesh_.vertices.size () / SAMPLES + 1;
    for (std::size_t i = 0; i < mesh_.vertices.size (); i += step)
      samples_.push_back (mesh_.vertices[i]); // spread evenly over the surface, however the points are
    wanted_nodes_ = row_.nodes;
    options_.field.radius = radiusFor (wanted_nodes_, report.spacing);
    return true;
  }

  double
  meanNodesWithin (double radius) const
  {
    std::vector<int> found;
    std::vector<float> squared;
    std::size_t total = 0;
    for (const Eigen::Vector3f &x : samples_)
    {
      search_->withinRadius (x, radius, found, squared);
      total += found.size ();
    }
    return static_cast<double> (total) / static_cast<double> (samples_.size ());
  }

  /** \brief The radius within which there are so many nodes, on average over the surface. */
  double
  radiusFor (double nodes, double guess) const
  {
    nodes = std::min (nodes, 0.99 * static_cast<double> (model_.nodes.size ()));
    double low = guess, high = guess;
    while (meanNodesWithin (high) < nodes)
      high *= 1.5;
    while (meanNodesWithin (low) > nodes)
      low /= 1.5;
    while (high > 1.002 * low)
    {
      const double middle = 0.5 * (low + high);
      (meanNodesWithin (middle) < nodes ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  /** \brief One reconstruction with cells of \a coarse times the voxel. */
  bool
  reconstruct (double coarse)
  {
    options_.polygonizer.voxel_size = coarse * voxel_;
    result_ = Result ();
    result_.radius = options_.field.radius;
    resetPeakMemory ();
    const auto start = Clock::now ();
    const std::clock_t cpu_start = std::clock ();
    erkpa::ImplicitField::ConstPtr field;
    result_.outcome = erkpa::buildField (viewOf (model_.nodes), options_, {}, field, result_.report);
    if (result_.outcome.ok ())
      result_.outcome = erkpa::buildMesh (*field, options_, mesh_, result_.report);
    result_.seconds = std::chrono::duration<double> (Clock::now () - start).count ();
    result_.cpu_seconds = static_cast<double> (std::clock () - cpu_start) / CLOCKS_PER_SEC;
    result_.peak_mb = peakMemory ();
    return result_.outcome.ok ();
  }

  /** \brief Settles radius and voxel anew from what the last reconstruction took. */
  bool
  correct (double coarse)
  {
    const double triangles = static_cast<double> (result_.report.triangles) * coarse * coarse;
    const double nodes = result_.report.meanNodesPerEvaluation ();
    if (!(triangles > 0.0 && nodes > 0.0))
      return false;
    voxel_ *= std::sqrt (triangles / row_.triangles);
    wanted_nodes_ *= row_.nodes / nodes;
    options_.field.radius = radiusFor (wanted_nodes_, options_.field.radius);
    return true;
  }

  bool
  isClose () const
  {
    const auto differ = [] (double a, double b) { return std::abs (a / b - 1.0); };
    return differ (static_cast<double> (result_.report.triangles), row_.triangles) < 0.03 &&
           differ (result_.report.meanNodesPerEvaluation (), row_.nodes) < 0.02;
  }

  const Row &row_;
  const Model &model_;
  erkpa::Options options_;
  erkpa::NeighborSearch::ConstPtr search_;
  erkpa::TriangleMesh mesh_;
  std::vector<Eigen::Vector3f> samples_; // of the surface
  double voxel_ = 0.0;
  double wanted_nodes_ = 0.0;
  Result result_;
};

} // namespace

Result
runRow (const Row &row, const Model &model, Method method, int threads)
{
  return RowRunner (row, model, method, threads).run ();
}

} // namespace paper
