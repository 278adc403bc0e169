// SPDX-License-Identifier: BSD-3-Clause
#include "edge_judge.h"

#include "mesh_intersections.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace erkpa
{

namespace
{

using Eigen::Vector3d;
using Triangle = std::array<int, 3>;

// Lengths are in voxels, angles given by their sines or cosines.
constexpr double TINY = 0.1;        // sides so short that it does not matter where their triangles look
constexpr double JOINT = 0.02;      // ends so close that it does not matter where the surface looks: nothing moves
constexpr double OFF_CREASE = 0.03; // how far a crease may move sideways
constexpr double OFF_SURFACE =
    0.05; // how far the surface may move: a vertex off the new triangles, the diagonals of a flip
constexpr double WELL_SHAPED = 0.25; // smallest angle of a triangle whose own normal means something (14 degrees)
constexpr double STEADY = 0.95;      // turn against the normals that is no fold in any case (18 degrees)
constexpr double LEAST_STEADY = 0.8; // the same where one as bad was there before (37 degrees)

double
cosine (const Vector3d &a, const Vector3d &b)
{
  const double lengths = std::sqrt (a.squaredNorm () * b.squaredNorm ());
  return lengths > 0.0 ? a.dot (b) / lengths : -1.0;
}

/** \brief Whether triangles look where the surface does, or at least no less than they did. */
bool
isSteady (double before, double after)
{
  return after >= STEADY || (after >= LEAST_STEADY && after >= before);
}

} // namespace

EdgeJudge::EdgeJudge (double voxel, const std::vector<VertexPair> &creases, const SurfaceVertices &vertices,
                      HalfEdges &edges)
    : voxel_ (voxel), vertices_ (vertices), edges_ (edges),
      degrees_ (creases.empty () ? 0 : vertices.positions.size (), 0)
{
  for (const auto &[a, b] : creases)
  {
    const int h = edges_.between (a, b);
    if (h < 0)
      continue;
    edges_.setCrease (h, true);
    ++degrees_[static_cast<std::size_t> (a)];
    ++degrees_[static_cast<std::size_t> (b)];
  }
}

double
EdgeJudge::sineAfterCollapse (int h) const
{
  const int from = edges_.start (h), to = edges_.end (h);
  if (movesCrease (h) || !edges_.canCollapse (h))
    return -1.0;
  const double tiny = squaredLength (h) < TINY * TINY * voxel_ * voxel_ ? TINY * TINY * voxel_ * voxel_ : 0.0;
  const bool is_joint = squaredLength (h) < JOINT * JOINT * voxel_ * voxel_;
  const Vector3d step = at (to) - at (from), towards_ends = facing (from) + facing (to);
  double sine = 1.0, sine_before = 1.0, steady = 1.0, steady_before = 1.0; // the least of the triangles around
  edges_.around (from,
                 [&] (int side)
                 {
                   if (steady < LEAST_STEADY)
                     return;
                   const int a = edges_.end (side), b = apex (side);
                   const Vector3d towards = towards_ends + facing (a) + facing (b);
                   const TriangleShape before = shapeOf (side);
                   const double own_sine = before.sine ();
                   sine_before = std::min (sine_before, own_sine);
                   if (!towards.isZero (0.0))
                     steady_before = std::min (steady_before, cosine (before.area, towards));
                   if (a == to || b == to)
                     return;
                   const TriangleShape after (at (to), at (a), at (b));
                   const bool may_collapse = isInside (to) && isInside (a) && isInside (b);
                   if (after.shortest < tiny && may_collapse)
                     return; // is going to, too
                   sine = std::min (sine, after.sine ());
                   const bool moves = std::abs (after.area.dot (step)) > OFF_SURFACE * voxel_ * after.area.norm ();
                   if (is_joint)
                     steady = std::min (steady, cosine (before.area, after.area));
                   else if (moves || (own_sine >= WELL_SHAPED && cosine (before.area, after.area) < STEADY))
                     steady = -1.0;
                   else if (own_sine < WELL_SHAPED || !towards.isZero (0.0))
                     steady = std::min (steady, cosine (after.area, towards));
                 });
  const bool is_steady = is_joint ? steady >= STEADY : isSteady (steady_before, steady);
  if (!is_steady || sine < std::min (WELL_SHAPED, sine_before))
    return -1.0;
  return entangles (h) ? -1.0 : sine;
}

bool
EdgeJudge::entangles (int h) const
{
  const int from = edges_.start (h), to = edges_.end (h);
  bool is_free = true; // from other parts of the surface, beyond a crease or a border
  edges_.around (from,
                 [&] (int side)
                 {
                   const int a = edges_.end (side);
                   is_free = is_free && isPlain (a) && isInside (a);
                 });
  if (is_free)
    return false;
  LargeVector<Triangle> moved;
  edges_.around (from,
                 [&] (int side)
                 {
                   const int a = edges_.end (side), b = apex (side);
                   if (a != to && b != to)
                     moved.push_back ({to, a, b});
                 });
  bool any = false;
  const auto test = [&] (const Triangle &other)
  {
    if (!any && std::find (other.begin (), other.end (), from) == other.end ())
      any = std::any_of (moved.begin (), moved.end (),
                         [&] (const Triangle &triangle) { return passThrough (vertices_.positions, triangle, other); });
  };
  edges_.visitNeighbors (to,
                         [&] (int v) {
                           edges_.around (v, [&] (int side) { test ({v, edges_.end (side), apex (side)}); });
                         });
  return any;
}

bool
EdgeJudge::movesCrease (int h) const
{
  const int from = edges_.start (h);
  if (isPlain (from))
    return false;
  return degrees_[static_cast<std::size_t> (from)] != 2 || !edges_.onCrease (h) || !keepsCrease (h);
}

bool
EdgeJudge::keepsCrease (int h) const
{
  const int from = edges_.start (h), to = edges_.end (h);
  int other = -1;
  edges_.around (from,
                 [&] (int side)
                 {
                   if (edges_.onCrease (side) && edges_.end (side) != to)
                     other = edges_.end (side);
                 });
  if (other < 0 || edges_.between (other, to) >= 0)
    return false;
  const Vector3d forth = at (to) - at (from), back = at (other) - at (from);
  return forth.dot (back) < 0.0 && forth.cross (back).norm () <= OFF_CREASE * voxel_ * (at (to) - at (other)).norm ();
}

double
EdgeJudge::gainOfFlip (int h) const
{
  const int g = edges_.twin (h);
  if (g < 0 || edges_.onCrease (h))
    return -1.0;
  const int a = edges_.start (h), b = edges_.end (h), c = apex (h), d = apex (g);
  for (const int v : {a, b, c, d})
    if (edges_.place (v) == HalfEdges::Place::TANGLED)
      return -1.0;
  const TriangleShape one = shapeOf (h), other = shapeOf (g);
  const TriangleShape new_one (at (c), at (d), at (b)), new_other (at (d), at (c), at (a));
  const double gain = std::min (new_one.sine (), new_other.sine ()) - std::min (one.sine (), other.sine ());
  if (gain <= 0.0 || !isNearlyFlat (a, b, c, d) || edges_.between (c, d) >= 0)
    return -1.0;
  const Vector3d towards = facing (a) + facing (b) + facing (c) + facing (d);
  if (towards.isZero (0.0))
    return -1.0;
  const double before = std::min (cosine (one.area, towards), cosine (other.area, towards));
  const double after = std::min (cosine (new_one.area, towards), cosine (new_other.area, towards));
  return isSteady (before, after) ? gain : -1.0;
}

bool
EdgeJudge::isNearlyFlat (int a, int b, int c, int d) const
{
  const Vector3d normal = (at (b) - at (a)).cross (at (d) - at (c));
  return std::abs (normal.dot (at (c) - at (a))) <= OFF_SURFACE * voxel_ * normal.norm ();
}

} // namespace erkpa
