// SPDX-License-Identifier: BSD-3-Clause
#include "pencil.h"

#include "enriching_surface.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace erkpa
{

namespace
{

/** \brief The pencil of three planes, if they make one: α θ_a + β θ_b + γ θ_c = 0 with no factor near zero. */
bool
pencilOf (const std::array<const SharpPlane *, 3> &planes, double tolerance, Pencil &pencil)
{
  Eigen::Matrix<double, 3, 3> normals;
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero ();
  for (int i = 0; i < 3; ++i)
    normals.col (i) = planes[static_cast<std::size_t> (i)]->thetaGradient (zero);
  constexpr double PARALLEL = 0.05; // about 3 degrees: planes found by segmentation are not exact
  if (std::abs (normals.determinant ()) > 1.5 * PARALLEL)
    return false; // the smallest singular value is larger than PARALLEL: the other two make at most 1.5
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd (normals, Eigen::ComputeFullV);
  if (svd.singularValues ()[2] > PARALLEL || svd.singularValues ()[1] < PARALLEL)
    return false;
  const Eigen::Vector3d factors = svd.matrixV ().col (2);
  // A point on two of the planes: there the third must vanish too, else the three bound a prism.
  const Eigen::Vector3d offsets (planes[0]->theta (zero), planes[1]->theta (zero), planes[2]->theta (zero));
  if (std::abs (factors.dot (offsets)) > tolerance)
    return false;
  if (factors.cwiseAbs ().minCoeff () < 0.1)
    return false;
  pencil.scale_a = factors[0];
  pencil.scale_b = -factors[1];
  return true;
}

/** \brief A box around where a surface is in force, and a bit more. */
Eigen::AlignedBox3d
boundsOf (const SharpSurface &surface, double more)
{
  const Eigen::Vector3d infinite = Eigen::Vector3d::Constant (HUGE_VAL), margin = Eigen::Vector3d::Constant (more);
  Eigen::AlignedBox3d bounds (-infinite, infinite);
  for (SharpSurfaceParts parts = surface.parts (); parts.kind == SharpSurfaceParts::Kind::LIMITED;
       parts = parts.surface->parts ())
  {
    const Eigen::AlignedBox3d box = parts.extent->bounds ();
    bounds.clamp (Eigen::AlignedBox3d (box.min () - margin, box.max () + margin));
  }
  return bounds;
}

/** \brief The planes through one line, of which every triple is a pencil.
 *
 * Of n planes n - 2 triples say all: functions that are linear between the 2 n half-planes around a line have n - 2
 * dimensions beside the linear ones and the kinks. Each triple that brings a plane of its own adds one.
 */
class Lines
{
public:
  /** \brief Whether a triple says what those that were taken before do not. */
  bool
  isNew (const std::array<int, 3> &triple)
  {
    for (std::vector<int> &line : lines_)
    {
      const auto is_other = [&] (int plane) { return std::find (line.begin (), line.end (), plane) == line.end (); };
      const auto others = std::count_if (triple.begin (), triple.end (), is_other);
      if (others > 1) // two planes lie in one line only
        continue;
      std::copy_if (triple.begin (), triple.end (), std::back_inserter (line), is_other);
      return others == 1;
    }
    lines_.emplace_back (triple.begin (), triple.end ());
    return true;
  }

private:
  std::vector<std::vector<int>> lines_; // their planes
};

} // namespace

std::vector<Pencil>
findPencils (const std::vector<SharpSurface::ConstPtr> &surfaces, double tolerance)
{
  std::vector<const SharpPlane *> planes (surfaces.size ());
  std::vector<const SpaceWarp *> warps (surfaces.size ());
  std::vector<Eigen::AlignedBox3d> bounds;
  for (std::size_t i = 0; i < surfaces.size (); ++i)
  {
    planes[i] = planeBehind (*surfaces[i], &warps[i]);
    bounds.push_back (boundsOf (*surfaces[i], tolerance));
  }
  std::vector<Pencil> pencils;
  Lines lines;
  const int n = static_cast<int> (surfaces.size ());
  const auto plane = [&] (int i) { return planes[static_cast<std::size_t> (i)]; };
  const auto warp = [&] (int i) { return warps[static_cast<std::size_t> (i)]; };
  // One with an extent may be absent where the others meet.
  const auto is_limited = [&] (int i)
  { return EnrichingSurface (surfaces[static_cast<std::size_t> (i)]).isLimited (); };
  const auto touch = [&] (int i, int j)
  {
    return plane (i) && plane (j) && warp (i) == warp (j) &&
           bounds[static_cast<std::size_t> (i)].intersects (bounds[static_cast<std::size_t> (j)]);
  };
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b)
      for (int c = b + 1; c < n && touch (a, b); ++c)
      {
        Pencil pencil{{a, b, c}, 0.0, 0.0};
        if (touch (a, c) && touch (b, c) && pencilOf ({plane (a), plane (b), plane (c)}, tolerance, pencil) &&
            (is_limited (a) || is_limited (b) || is_limited (c) || lines.isNew ({a, b, c})))
          pencils.push_back (pencil);
      }
  return pencils;
}

} // namespace erkpa
