// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/reconstruction.h>

#include <string>

namespace erkpa
{

/** \brief The setters and getters of a reconstruction stage, over Options: what they mean and their defaults stand
 * there. */
class Settings
{
public:
  /** \brief The neighbours of the support: ε(x) is the distance to the k-th nearest point. At least 5;
   * 0 (default) chooses k from the noise of the points. */
  void
  setKSearch (int k)
  {
    options_.field.k = k;
  }

  int
  getKSearch () const
  {
    return options_.field.k;
  }

  /** \brief A constant support radius in the cloud's unit of length; 0 (default) uses k. */
  void
  setRadiusSearch (double radius)
  {
    options_.field.radius = radius;
  }

  double
  getRadiusSearch () const
  {
    return options_.field.radius;
  }

  /** \brief A support radius that changes linearly along an axis of the cloud's frame; RadiusRamp () for none. */
  void
  setRadiusRamp (const RadiusRamp &ramp)
  {
    options_.field.radius_ramp = ramp;
  }

  const RadiusRamp &
  getRadiusRamp () const
  {
    return options_.field.radius_ramp;
  }

  /** \brief The support radius as a function of position, see RadiusFunction; nullptr for none. */
  void
  setRadiusFunction (const RadiusFunction &function)
  {
    options_.field.radius_function = function;
  }

  const RadiusFunction &
  getRadiusFunction () const
  {
    return options_.field.radius_function;
  }

  /** \brief The field of the cloud that holds the support radius of each point; "" (default) for none. */
  void
  setRadiusField (const std::string &name)
  {
    options_.points.radius_field = name;
  }

  const std::string &
  getRadiusField () const
  {
    return options_.points.radius_field;
  }

  /** \brief The field of the cloud that holds the confidence of each point, by which it is weighed; "" (default) for
   * none. */
  void
  setConfidenceField (const std::string &name)
  {
    options_.points.confidence_field = name;
  }

  const std::string &
  getConfidenceField () const
  {
    return options_.points.confidence_field;
  }

  /** \brief What the field reproduces exactly; automatic by default: spherical, for functional constraints linear. */
  void
  setOrder (Order order)
  {
    options_.field.order = order;
  }

  Order
  getOrder () const
  {
    return options_.field.order;
  }

  /** \brief How the points constrain the field; Hermite by default. */
  void
  setConstraint (Constraint constraint)
  {
    options_.field.constraint = constraint;
  }

  Constraint
  getConstraint () const
  {
    return options_.field.constraint;
  }

  /** \brief How far off-surface points are from theirs, as a share of the support radius; 0.2 by default. */
  void
  setOffset (double offset)
  {
    options_.field.offset = offset;
  }

  double
  getOffset () const
  {
    return options_.field.offset;
  }

  /** \brief What sharp edges add to the field; a kink by default. */
  void
  setEnrichment (EnrichmentType enrichment)
  {
    options_.field.enrichment = enrichment;
  }

  EnrichmentType
  getEnrichment () const
  {
    return options_.field.enrichment;
  }

  /** \brief Whether the surface passes through the points; not by default. */
  void
  setInterpolation (Interpolation interpolation)
  {
    options_.field.interpolation = interpolation;
  }

  Interpolation
  getInterpolation () const
  {
    return options_.field.interpolation;
  }

  /** \brief How points are weighed by their distance. */
  void
  setKernel (KernelType kernel)
  {
    options_.field.kernel = kernel;
    options_.field.user_kernel.reset ();
  }

  /** \brief The same with a kernel of your own; null for none. */
  void
  setKernel (const Kernel::ConstPtr &kernel)
  {
    options_.field.user_kernel = kernel;
  }

  const Kernel::ConstPtr &
  getUserKernel () const
  {
    return options_.field.user_kernel;
  }

  /** \brief The kernel in force where there is none of your own. */
  KernelType
  getKernel () const
  {
    return options_.field.kernel;
  }

  /** \brief How far the support of a point reaches along its normal, as a share of the radius; 1 (default) = a ball. */
  void
  setFlatten (double flatten)
  {
    options_.field.flatten = flatten;
  }

  double
  getFlatten () const
  {
    return options_.field.flatten;
  }

  /** \brief Deform the surface: the mesh and the field are those of the warped space; null (default) for none. */
  void
  setSpaceWarp (const SpaceWarp::ConstPtr &warp)
  {
    options_.field.warp = warp;
  }

  const SpaceWarp::ConstPtr &
  getSpaceWarp () const
  {
    return options_.field.warp;
  }

  /** \brief Side of a grid cell in the cloud's unit of length; 0 (default) takes the resolution or the spacing. */
  void
  setVoxelSize (double voxel_size)
  {
    options_.polygonizer.voxel_size = voxel_size;
  }

  double
  getVoxelSize () const
  {
    return options_.polygonizer.voxel_size;
  }

  /** \brief Grid cells along the longest side of the cloud; 0 (default) follows the spacing of the points. */
  void
  setGridResolution (int resolution)
  {
    options_.polygonizer.resolution = resolution;
  }

  int
  getGridResolution () const
  {
    return options_.polygonizer.resolution;
  }

  /** \brief The surface is f = iso_level; in the cloud's unit of length (before a warp), positive outside. Supports
   * of k nearest points: at most 16 support radii far, or 64 voxels. */
  void
  setIsoLevel (double iso_level)
  {
    options_.polygonizer.iso_level = iso_level;
  }

  double
  getIsoLevel () const
  {
    return options_.polygonizer.iso_level;
  }

  /** \brief How exact moments are where they may be interpolated, which is where supports of a constant radius hold
   * many hundreds of points: see PolygonizerOptions::moment_tolerance. In [0, 1); 0 = every sum is over the points in
   * the support. Default 0.01: vertices then lie some thousandths of a voxel off the surface of getField (). */
  void
  setMomentTolerance (double moment_tolerance)
  {
    options_.polygonizer.moment_tolerance = moment_tolerance;
  }

  double
  getMomentTolerance () const
  {
    return options_.polygonizer.moment_tolerance;
  }

  /** \brief Number of threads; 0 (default) takes all processors. The result does not depend on it. */
  void
  setNumberOfThreads (int threads)
  {
    options_.normals.threads = options_.polygonizer.threads = threads;
  }

  int
  getNumberOfThreads () const
  {
    return options_.polygonizer.threads;
  }

  /** \brief Where the sensor stood, for the sign of estimated normals; default: the cloud's sensor_origin_. */
  void
  setViewPoint (float x, float y, float z)
  {
    options_.normals.view_point = Eigen::Vector3d (x, y, z);
    options_.normals.has_view_point = true;
    use_sensor_origin_ = false;
  }

  void
  getViewPoint (float &x, float &y, float &z) const
  {
    x = static_cast<float> (options_.normals.view_point.x ());
    y = static_cast<float> (options_.normals.view_point.y ());
    z = static_cast<float> (options_.normals.view_point.z ());
  }

  /** \brief Take the view point from the cloud again. */
  void
  useSensorOriginAsViewPoint ()
  {
    use_sensor_origin_ = true;
  }

  const Options &
  getOptions () const
  {
    return options_;
  }

protected:
  Settings () = default;
  ~Settings () = default;

  Options options_;
  bool use_sensor_origin_ = true;
};

} // namespace erkpa
