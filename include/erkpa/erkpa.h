// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/reconstruction.h>

#include <pcl/ModelCoefficients.h>
#include <pcl/PolygonMesh.h>
#include <pcl/point_types.h>
#include <pcl/surface/reconstruction.h>

#include <vector>

namespace erkpa
{

/** \brief Surface reconstruction with sharp edges via Enriched Reproducing Kernel Approximation, as a PCL stage.
 *
 * Takes the place of pcl::Poisson:
 * \code
 * erkpa::ERKPA<pcl::PointNormal> erkpa;
 * erkpa.setInputCloud (cloud);
 * erkpa.reconstruct (mesh);
 * \endcode
 * Every setting has a default that gives a good mesh. Sharp edges are made where planes given by addSharpEdge ()
 * cut the surface. Points without usable normals get estimated ones. Nothing is thrown across reconstruct: on
 * failure one PCL_ERROR names the input or setting, getStatus () tells the kind, and the output is empty.
 *
 * P. Reuter, P. Joyot, J. Trunzler, T. Boubekeur, C. Schlick: Reconstructing Implicit Surfaces with Sharp Edges via
 * Enriched Reproducing Kernel Approximation, RR-1334-04, LaBRI, 2004.
 *
 * \tparam PointNT a point type with x, y, z; normals, colour and intensity are used where the type has them
 */
template <typename PointNT>
class ERKPA : public pcl::SurfaceReconstruction<PointNT>
{
public:
  using Ptr = pcl::shared_ptr<ERKPA<PointNT>>;
  using ConstPtr = pcl::shared_ptr<const ERKPA<PointNT>>;
  using PointCloud = pcl::PointCloud<PointNT>;
  using PointCloudConstPtr = typename PointCloud::ConstPtr;

  using pcl::PCLBase<PointNT>::input_;
  using pcl::PCLBase<PointNT>::indices_;
  using pcl::PCLBase<PointNT>::use_indices_;
  using pcl::PCLBase<PointNT>::fake_indices_;
  using pcl::SurfaceReconstruction<PointNT>::tree_;
  using pcl::SurfaceReconstruction<PointNT>::check_tree_;

  ERKPA ()
  {
    check_tree_ = false; // the base would choose a search that fails on ordinary clouds
  }

  /** \brief Reconstruct the surface of the input cloud (its indices, where set).
   * \param[out] output triangles over a cloud with x, y, z, unit normals, and the input's colour or intensity
   */
  void
  reconstruct (pcl::PolygonMesh &output) override;

  /** \brief The same, with the vertices in the input's own point type. */
  void
  reconstruct (PointCloud &points, std::vector<pcl::Vertices> &polygons) override;

  /** \brief Only the field, for queries: no mesh is made. Null on failure, which getStatus () explains. */
  ImplicitField::ConstPtr
  computeField ();

  /** \brief The field of the last call; null before the first one and after a failure. */
  ImplicitField::ConstPtr
  getField () const
  {
    return field_;
  }

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

  /** \brief What the field reproduces exactly; spherical by default. */
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

  /** \brief The surface is f = iso_level; in the cloud's unit of length, positive outside. */
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

  /** \brief Make the surface sharp where it crosses a plane.
   * \param[in] coefficients a, b, c, d of a x + b y + c z + d = 0, of any scale: the plane that halves the edge
   * \return false, with a PCL_ERROR, where there are not four finite values or a = b = c = 0
   */
  bool
  addSharpEdge (const pcl::ModelCoefficients &coefficients);

  /** \brief Replace all sharp edges; on a bad one none is changed, and false is returned. */
  bool
  setSharpEdges (std::vector<pcl::ModelCoefficients> edges);

  const std::vector<pcl::ModelCoefficients> &
  getSharpEdges () const
  {
    return sharp_edges_;
  }

  void
  clearSharpEdges ()
  {
    sharp_edges_.clear ();
    options_.field.sharp_surfaces.clear ();
  }

  /** \brief How the last call ended. */
  Status
  getStatus () const
  {
    return outcome_.status;
  }

  /** \brief The sentence that explains the status; empty after success. */
  const std::string &
  getStatusMessage () const
  {
    return outcome_.message;
  }

  /** \brief What the last call did: counts of points, evaluations, seconds per stage, topology. */
  const Report &
  getReport () const
  {
    return report_;
  }

  /** \brief All settings at once, as the command line and other front ends fill them: the view point and the sharp
   * surfaces are those of the options from then on, and getSharpEdges () knows none. */
  void
  setOptions (const Options &options);

  const Options &
  getOptions () const
  {
    return options_;
  }

  /** \brief Called with the fraction done during long runs. */
  void
  setProgressCallback (const ProgressCallback &progress)
  {
    progress_ = progress;
  }

protected:
  std::string
  getClassName () const override
  {
    return "erkpa::ERKPA";
  }

  void
  performReconstruction (pcl::PolygonMesh &output) override
  {
    reconstruct (output);
  }

  void
  performReconstruction (PointCloud &points, std::vector<pcl::Vertices> &polygons) override
  {
    reconstruct (points, polygons);
  }

private:
  /** \brief Runs a step of the pipeline; what it throws becomes a status, and a failure is said once. */
  template <typename StepT>
  bool
  guarded (StepT step);

  /** \brief cloud -> field_ */
  Outcome
  makeField ();

  /** \brief cloud -> field_ -> mesh */
  bool
  makeMesh (TriangleMesh &mesh);

  PointView
  viewOfInput () const;

  Options options_;
  bool use_sensor_origin_ = true;
  std::vector<pcl::ModelCoefficients> sharp_edges_;
  ProgressCallback progress_;

  ImplicitField::ConstPtr field_;
  Outcome outcome_;
  Report report_;
};

/** \brief Reconstruct from a cloud whose fields are known only at run time (as loaded from a file).
 *
 * Uses x, y, z and, where present, normal_x/y/z, rgb or rgba, intensity.
 * \param[in] cloud FLOAT32 x, y, z
 * \param[in] options all settings; options.normals.view_point is where the sensor stood
 * \param[out] mesh empty on failure
 * \param[out] report what was done
 * \param[out] field the field, where not null
 * \param[in] progress may be empty
 */
Outcome
reconstruct (const pcl::PCLPointCloud2 &cloud, const Options &options, pcl::PolygonMesh &mesh, Report &report,
             ImplicitField::ConstPtr *field = nullptr, const ProgressCallback &progress = {});

} // namespace erkpa

#include <erkpa/impl/erkpa.hpp>
