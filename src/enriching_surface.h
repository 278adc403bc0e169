// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/extent.h>
#include <erkpa/sharp_surface.h>

#include <cmath>

namespace erkpa
{

/** \brief What is known of a sharp surface from what it was made of. */
class EnrichingSurface
{
public:
  explicit EnrichingSurface (SharpSurface::ConstPtr surface);

  const SharpSurface &
  surface () const
  {
    return *surface_;
  }

  /** \brief The surface itself where it is a plane, or the one that is limited, not seen through a warp; null where
   * there is none. */
  const SharpPlane *
  plane () const
  {
    return plane_;
  }

  /** \brief Whether θ is linear, and |θ| a distance. */
  bool
  isPlane () const
  {
    return plane_ != nullptr;
  }

  /** \brief Whether θ is a field of its own, behind whatever it is. */
  bool
  isField () const
  {
    return is_field_;
  }

  /** \brief Whether θ takes a few operations, and not a function of somebody's. */
  bool
  isQuick () const
  {
    return steepness_ > 0.0;
  }

  /** \brief Whether one extent at most, seen through one warp at most, says where it is in force. Not so of classes
   * not known. */
  bool
  hasKnownPresence () const
  {
    return has_known_presence_;
  }

  /** \brief Whether an extent limits it. */
  bool
  isLimited () const
  {
    return extent_ != nullptr;
  }

  /** \brief See SharpSurfaceParts::fade. */
  double
  fade () const
  {
    return fade_;
  }

  /** \brief The distance from the extent by which the presence at \a x goes.
   * \param[out] away ∇ of it
   */
  double
  distanceFromExtent (const Eigen::Vector3d &x, Eigen::Vector3d &away) const;

  /** \brief False where no node of a support of this reach around \a x can lie beyond the surface from there. */
  bool
  canPass (const Eigen::Vector3d &x, double reach) const
  {
    return !(steepness_ > 0.0) || std::abs (surface_->theta (x)) <= steepness_ * reach;
  }

private:
  /** \brief Take in what a surface is made of, from the outermost to the innermost. */
  void
  look (const SharpSurface &surface);

  SharpSurface::ConstPtr surface_;
  const SharpPlane *plane_ = nullptr;
  bool is_field_ = false, has_known_presence_ = true;
  double steepness_ = 0.0; // |∇θ| is nowhere larger; 0: not known, as of all but models and what is between them
  const SpaceWarp *warp_ = nullptr; // through which the extent is seen
  int warps_ = 0;                   // around it
  const Extent *extent_ = nullptr;
  double fade_ = 0.0;
};

} // namespace erkpa
