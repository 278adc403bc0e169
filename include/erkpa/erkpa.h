// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/settings.h>

#include <pcl/ModelCoefficients.h>
#include <pcl/PolygonMesh.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/model_types.h>
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
 * Every setting has a default that gives a good mesh; settings.h lists them. Sharp edges are made where planes given by
 * addSharpEdge () cut the surface. Points without usable normals get estimated ones. Nothing is thrown across
 * reconstruct: on failure one PCL_ERROR names the input or setting, getStatus () tells the kind, and the output is
 * empty.
 *
 * P. Reuter, P. Joyot, J. Trunzler, T. Boubekeur, C. Schlick: Reconstructing Implicit Surfaces with Sharp Edges via
 * Enriched Reproducing Kernel Approximation, RR-1334-04, LaBRI, 2004.
 *
 * \tparam PointNT a point type with x, y, z; normals, colour and intensity are used where the type has them
 */
template <typename PointNT>
class ERKPA : public pcl::SurfaceReconstruction<PointNT>, public Settings
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

  /** \brief Something about each point of the input cloud, one value per point; empty (default) for none. The fields of
   * the cloud named by setRadiusField () and setConfidenceField () go first.
   */
  void
  setRadii (const std::vector<float> &radii)
  {
    radii_ = radii;
  }

  /** \brief The weights of the points beside the kernel, the paper's Δx_i (eq. 13). */
  void
  setConfidences (const std::vector<float> &confidences)
  {
    confidences_ = confidences;
  }

  /** \brief The shapes of the points' supports: |S (x - x_i)| < radius, no singular value of S below 1. They exclude
   * setFlatten (). Where they are flat, the voxel must be well below their thickness. */
  void
  setSupportShapes (const std::vector<Eigen::Matrix3f> &shapes)
  {
    shapes_ = shapes;
  }

  /** \brief Make the surface sharp where it crosses a plane.
   * \param[in] coefficients a, b, c, d of a x + b y + c z + d = 0, of any scale: the plane that halves the edge
   * \return false, with a PCL_ERROR, where there are not four finite values or a = b = c = 0
   */
  bool
  addSharpEdge (const pcl::ModelCoefficients &coefficients);

  /** \brief The same with another surface than a plane.
   * \param[in] coefficients those of the model, as PCL's sample consensus gives them
   * \param[in] model pcl::SACMODEL_PLANE, SACMODEL_SPHERE, SACMODEL_CYLINDER or SACMODEL_CONE, or one of their kin with
   * the same coefficients (SACMODEL_NORMAL_PLANE, ...)
   * \return false, with a PCL_ERROR, where they make no surface
   */
  bool
  addSharpEdge (const pcl::ModelCoefficients &coefficients, pcl::SacModel model);

  /** \brief Make the edge sharp in which two faces meet: see makeSharpBetween (). The rim of a cylinder, for example.
   * \param[in] face coefficients of a face; the normal of a plane points out of the solid. The signed distance to a
   * sphere, cylinder or cone is positive outside it, so that it must be the outside of a boss, not of a hole
   * \param[in] model its model, as above
   * \param[in] other, other_model the other face
   * \return false, with a PCL_ERROR, where they make no surface
   */
  bool
  addSharpEdge (const pcl::ModelCoefficients &face, pcl::SacModel model, const pcl::ModelCoefficients &other,
                pcl::SacModel other_model);

  /** \brief The same with any surface; null is ignored. */
  void
  addSharpSurface (const SharpSurface::ConstPtr &surface);

  /** \brief Replace all sharp edges by planes; on a bad one none is changed, and false is returned. */
  bool
  setSharpEdges (std::vector<pcl::ModelCoefficients> edges);

  /** \brief The planes given. */
  const std::vector<pcl::ModelCoefficients> &
  getSharpEdges () const
  {
    return sharp_edges_;
  }

  /** \brief Forget the sharp edges, planes and others. */
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
   * surfaces are those of the options from then on, and getSharpEdges () knows none. What is given point by point
   * (setRadii () and its kin) stays. */
  void
  setOptions (const Options &options);

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
  makeField (const ProgressCallback &progress);

  /** \brief cloud -> field_ -> mesh */
  bool
  makeMesh (TriangleMesh &mesh);

  Outcome
  viewInput (PointView &view) const;

  /** \brief The surface that coefficients describe; null, with a PCL_ERROR, where there is none. */
  SharpSurface::ConstPtr
  sharpSurfaceOf (const pcl::ModelCoefficients &coefficients, pcl::SacModel model) const;

  std::vector<float> radii_, confidences_;
  std::vector<Eigen::Matrix3f> shapes_;
  std::vector<pcl::ModelCoefficients> sharp_edges_;
  ProgressCallback progress_;

  ImplicitField::ConstPtr field_;
  Outcome outcome_;
  Report report_;
};

/** \brief Reconstruct from a cloud whose fields are known only at run time (as loaded from a file).
 *
 * Uses x, y, z and, where present, normal_x/y/z, rgb or rgba, intensity, and the fields that options.points names.
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

/** \brief The same without a mesh: only the field, null on failure. */
Outcome
computeField (const pcl::PCLPointCloud2 &cloud, const Options &options, ImplicitField::ConstPtr &field, Report &report,
              const ProgressCallback &progress = {});

} // namespace erkpa

#include <erkpa/impl/erkpa.hpp>
