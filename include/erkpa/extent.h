// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/status.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <memory>
#include <vector>

namespace erkpa
{

struct ExtentParts;

/** \brief A region of space, to which a sharp surface may be limited. Const and safe from several threads. */
class Extent
{
public:
  using ConstPtr = std::shared_ptr<const Extent>;

  Extent () = default;
  Extent (const Extent &) = delete;
  Extent &
  operator= (const Extent &) = delete;
  virtual ~Extent () = default;

  /** \brief How far \a x is from the region, in the unit of length of the cloud: 0 inside, continuous, and no larger
   * than the distance itself (so that it grows by at most one in one).
   * \param[out] gradient where not null; zero inside. It may jump where two parts of the region are equally near
   */
  virtual double
  distance (const Eigen::Vector3d &x, Eigen::Vector3d *gradient = nullptr) const = 0;

  /** \brief A box around the region; unbounded where the region is. */
  virtual Eigen::AlignedBox3d
  bounds () const = 0;

  /** \brief What the region was made from. */
  virtual ExtentParts
  parts () const;
};

/** \brief What an extent was made from. */
struct ExtentParts
{
  enum class Kind
  {
    OTHER,   ///< a class of the caller's own: not known
    BOX,     ///< \a points: the low and the high corner
    POLYGON, ///< \a points: the vertices in order; \a length: the thickness
    POINTS   ///< \a points; \a length: the radius
  };

  Kind kind = Kind::OTHER;
  std::vector<Eigen::Vector3d> points;
  double length = 0.0;
};

/** \brief The box between two corners.
 * \param[in] low, high finite, low <= high in all coordinates
 * \param[out] extent untouched on error
 * \return Status::INVALID_SETTING with the reason where the corners make no box
 */
Outcome
makeBoxExtent (const Eigen::Vector3d &low, const Eigen::Vector3d &high, Extent::ConstPtr &extent);

/** \brief What lies over or under a polygon: the points whose projection along its normal falls into it.
 * \param[in] vertices at least three, in order around the polygon, finite, roughly in a plane: none farther from the
 * plane that fits them than a tenth of the polygon's diameter. Corners may point inwards; sides must not cross
 * \param[in] thickness how far the region reaches on either side of the plane; 0 = any distance
 * \param[out] extent untouched on error
 * \return Status::INVALID_SETTING with the reason where the vertices make no polygon
 */
Outcome
makePolygonExtent (const std::vector<Eigen::Vector3d> &vertices, double thickness, Extent::ConstPtr &extent);

/** \brief What lies within a radius of any of some points, such as points along an edge.
 * \param[in] points at least one, finite
 * \param[in] radius positive, finite
 * \param[out] extent untouched on error
 * \return Status::INVALID_SETTING with the reason
 */
Outcome
makePointsExtent (const std::vector<Eigen::Vector3d> &points, double radius, Extent::ConstPtr &extent);

} // namespace erkpa
