// SPDX-License-Identifier: BSD-3-Clause
#include "feature_loops.h"

#include "crease_solver.h"
#include "crease_turn.h"
#include "plane_meeting.h"
#include "threads.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace erkpa
{

namespace
{

/** \brief Meshes the loops of one thread. */
class LoopMesher
{
public:
  LoopMesher (const ImplicitField &field, const PolygonizerOptions &options, double voxel,
              const SurfaceVertices &vertices, bool has_border)
      : options_ (options), voxel_ (voxel), vertices_ (vertices), local_ (field),
        channels_ (static_cast<std::size_t> (field.points ().channels)), has_border_ (has_border)
  {
  }

  void
  mesh (const CellLoop &loop, MeshedLoop &result)
  {
    Eigen::Vector3d around = Eigen::Vector3d::Zero ();
    for (const int v : loop.ring)
      around += position (v) / static_cast<double> (loop.ring.size ());
    is_gathered_ = false;
    findSides (loop, around, result);
    if (result.crossings.empty ())
      return;
    gatherOnce (around);
    const bool is_single = result.crossings.size () == 2; // one crease runs through: the vertex may be anywhere on it
    const Eigen::Vector3d middle = is_single ? middleOf (result.crossings) : around;
    result.position = minimizeDistances (loop, middle);
    result.has_center = solve (middle, result.position);
    if (result.has_center && is_single)
      moveInside (loop, middle, result);
    if (result.has_center)
      describeCenter (result);
  }

  const LocalField &
  local () const
  {
    return local_;
  }

private:
  static constexpr double TOLERANCE = 1e-5; // voxels
  static constexpr double REACH = 2.5;      // voxels that a vertex may be away from the middle of its loop
  static constexpr double NEAR = 0.7;       // voxels that few of them are

  const Eigen::Vector3d &
  position (int v) const
  {
    return vertices_.positions[static_cast<std::size_t> (v)];
  }

  std::uint64_t
  keyOf (int v) const
  {
    return vertices_.side_keys[static_cast<std::size_t> (v)];
  }

  Side
  sideOf (int v) const
  {
    return {vertices_.faces[static_cast<std::size_t> (v)], position (v)};
  }

  /** \brief Find where creases cross the loop, and the sides of them that its vertices lie on. */
  void
  findSides (const CellLoop &loop, const Eigen::Vector3d &around, MeshedLoop &result)
  {
    sides_.clear ();
    const std::size_t n = loop.ring.size ();
    for (std::size_t i = 0; i < n; ++i)
    {
      const int a = loop.ring[i], b = loop.ring[(i + 1) % n];
      if (keyOf (a) == keyOf (b) || !isCrease (std::min (a, b), std::max (a, b), around))
        continue;
      result.crossings.push_back (orderedPair (a, b));
      for (const int v : {a, b})
        if (std::none_of (sides_.begin (), sides_.end (), [&] (int other) { return keyOf (other) == keyOf (v); }))
          sides_.push_back (v);
    }
  }

  /** \brief Between the places where a crease crosses a loop. Two loops share each of these, so that the vertices of
   * loops along a crease stand in the order of the loops. */
  Eigen::Vector3d
  middleOf (const std::vector<VertexPair> &crossings) const
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
    for (const VertexPair &crossing : crossings)
      sum += 0.5 * (position (crossing.first) + position (crossing.second));
    return sum / static_cast<double> (crossings.size ());
  }

  /** \brief Moves a point near to \a middle to the crease or corner between all sides. */
  bool
  solve (const Eigen::Vector3d &middle, Eigen::Vector3d &x)
  {
    std::vector<Side> sides;
    for (const int v : sides_)
      sides.push_back (sideOf (v));
    return moveToCrease (local_, sides, options_.iso_level, REACH * voxel_, TOLERANCE * voxel_, x, &gradients_) &&
           (x - middle).norm () < REACH * voxel_;
  }

  /** \brief Moves the vertex along its crease to where it lies on the inner side of all sides of the loop that the
   * crease does not cross, so that no triangle is turned over. */
  void
  moveInside (const CellLoop &loop, const Eigen::Vector3d &middle, MeshedLoop &result)
  {
    constexpr double MARGIN = 0.02, STEEP = 0.1; // voxels; sine between crease and side of the loop
    const Eigen::Vector3d along = gradients_.front ().cross (gradients_.back ()).normalized ();
    double low = -REACH * voxel_, high = -low;
    const std::size_t n = loop.ring.size ();
    for (std::size_t i = 0; i < n; ++i)
    {
      const int a = loop.ring[i], b = loop.ring[(i + 1) % n];
      const VertexPair side = orderedPair (a, b);
      if (std::find (result.crossings.begin (), result.crossings.end (), side) != result.crossings.end ())
        continue;
      const Eigen::Vector3d up = (normalOf (a) + normalOf (b)).normalized ();
      const Eigen::Vector3d inwards = up.cross (position (b) - position (a)).normalized ();
      const double room = inwards.dot (result.position - position (a)) - MARGIN * voxel_, slope = inwards.dot (along);
      if (slope > STEEP)
        low = std::max (low, -room / slope);
      else if (slope < -STEEP)
        high = std::min (high, -room / slope);
    }
    if (low <= 0.0 && high >= 0.0)
      return;
    Eigen::Vector3d moved = result.position + (low > high ? 0.5 * (low + high) : low > 0.0 ? low : high) * along;
    const std::vector<Eigen::Vector3d> gradients = gradients_;
    if (solve (middle, moved))
      result.position = moved;
    else
      gradients_ = gradients;
  }

  const Eigen::Vector3d &
  normalOf (int v) const
  {
    return vertices_.normals[static_cast<std::size_t> (v)];
  }

  /** \brief Whether the pieces of f on the sides of two vertices turn against each other between them. */
  bool
  isCrease (int a, int b, const Eigen::Vector3d &around)
  {
    if (!mayCrease (normalOf (a), normalOf (b)))
      return false;
    gatherOnce (around);
    const Eigen::Vector3d middle = 0.5 * (position (a) + position (b));
    if (turnBetween (normalOf (a), normalOf (b)) > CERTAIN_CREASE_TURN &&
        local_.keepsApart (sideOf (a).face, sideOf (b).face, middle))
      return true;
    std::vector<LocalSample> samples;
    local_.sampleOnSides (middle, {sideOf (a), sideOf (b)}, samples, LocalField::Slope::OF_THE_FIT);
    const LocalSample &one = samples.front (), &other = samples.back ();
    return one.isDefined () && other.isDefined () && turnBetween (one.gradient, other.gradient) > LEAST_CREASE_TURN;
  }

  void
  gatherOnce (const Eigen::Vector3d &around)
  {
    if (!std::exchange (is_gathered_, true))
      local_.gather (around, NEAR * voxel_);
  }

  /** \brief The point nearest to the tangent planes at the loop's vertices (Kobbelt et al. 2001). */
  Eigen::Vector3d
  minimizeDistances (const CellLoop &loop, const Eigen::Vector3d &middle) const
  {
    PlaneMeeting meeting;
    for (const int v : loop.ring)
    {
      const Eigen::Vector3d &normal = vertices_.normals[static_cast<std::size_t> (v)];
      meeting.add (normal, normal.dot (position (v) - middle));
    }
    const Eigen::Vector3d step = meeting.point (0.1);
    const double length = step.norm ();
    const double limit = 1.5 * voxel_;
    return middle + (length > limit ? limit / length : 1.0) * step;
  }

  /** \brief The normal of a crease vertex is the mean of its faces' normals. */
  void
  describeCenter (MeshedLoop &result)
  {
    result.face = vertices_.faces[static_cast<std::size_t> (sides_.front ())];
    result.attributes.resize (channels_);
    if (has_border_ || channels_ > 0)
      result.border_offset = local_.sample (result.position).border_offset;
    if (channels_ > 0)
      local_.blendAttributes (result.attributes.data ());
    std::vector<Eigen::Vector3d> normals; // of the faces: several sides of sharp surfaces can be of one
    for (const Eigen::Vector3d &gradient : gradients_)
    {
      const auto is_known = [&] (const Eigen::Vector3d &n) { return turnBetween (n, gradient) < LEAST_CREASE_TURN; };
      if (gradient.norm () > 0.0 && std::none_of (normals.begin (), normals.end (), is_known))
        normals.push_back (gradient.normalized ());
    }
    result.normal.setZero ();
    for (const Eigen::Vector3d &normal : normals)
      result.normal += normal;
    if (result.normal.norm () > 0.0)
      result.normal.normalize ();
  }

  const PolygonizerOptions &options_;
  double voxel_;
  const SurfaceVertices &vertices_;
  LocalField local_;
  std::size_t channels_;
  bool has_border_;                        // whether border offsets are wanted
  bool is_gathered_ = false;               // around the loop: most are where a sharp surface crosses a smooth one
  std::vector<int> sides_;                 // a vertex on each
  std::vector<Eigen::Vector3d> gradients_; // of the pieces of f on these sides where the crease was last found
};

} // namespace

std::vector<MeshedLoop>
meshLoops (const ImplicitField &field, const PolygonizerOptions &options, const LargeVector<CellLoop> &loops,
           double voxel, bool has_border, const SurfaceVertices &vertices, PolygonizerReport &report)
{
  std::vector<MeshedLoop> meshed (loops.size ());
  parallelFor (
      loops.size (), options.threads, [&] { return LoopMesher (field, options, voxel, vertices, has_border); },
      [&] (LoopMesher &mesher, std::size_t i) { mesher.mesh (loops[i], meshed[i]); },
      [&report] (const LoopMesher &mesher)
      {
        report.evaluations += mesher.local ().evaluations ();
        report.support_nodes += mesher.local ().supportNodes ();
      });
  return meshed;
}

} // namespace erkpa
