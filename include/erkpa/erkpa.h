// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/sharp_edge_settings.h>

#include <pcl/PolygonMesh.h>
#include <pcl/point_types.h>
#include <pcl/surface/reconstruction.h>

#include <string>
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
 * Every setting has a default that gives a good mesh; settings.h and sharp_edge_settings.h list them. Sharp edges are
 * made where planes given by addSharpEdge () cut the surface, and where setAutomaticSharpEdges () lets them be found in
 * the points. Points without usable normals get estimated ones. Nothing is thrown across reconstruct: on failure one
 * PCL_ERROR names the input or setting, getStatus () tells the kind, and the output is empty.
 *
 * P. Reuter, P. Joyot, J. Trunzler, T. Boubekeur, C. Schlick: Reconstructing Implicit Surfaces with Sharp Edges via
 * Enriched Reproducing Kernel Approximation, RR-1334-04, LaBRI, 2004.
 *
 * \tparam PointNT a point type with x, y, z; normals, colour and intensity are used where the type has them
 */
template <typename PointNT>
class ERKPA : public pcl::SurfaceReconstruction<PointNT>, public SharpEdgeSettings
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

  /** \brief Only the field, for queries: no mesh is made, nor looked through for sharp edges found in vain, which
   * reconstruct () takes out. Null on failure, which getStatus () explains. */
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

  /** \brief The sharp surfaces that the last call found, between faces and in the points; not those given.
   *
   * They can be looked at, and given back with setSharpSurfaces () where some are not wanted; with nothing more to be
   * found (setAutomaticSharpEdges (false), clearFaces ()) all of them give the same mesh.
   */
  const std::vector<SharpSurface::ConstPtr> &
  getFoundSharpSurfaces () const
  {
    return report_.sharp_surfaces;
  }

  /** \brief Save the sharp surfaces that were in force in the last call, given and found, in this order; those given
   * where it has failed or there was none. See sharp_surface_io.h.
   * \return false, with a PCL_ERROR, where they cannot be written
   */
  bool
  saveSharpSurfaces (const std::string &path) const;

  /** \brief The creases of the last mesh as lines of its vertices. The surface of a crease is a place in
   * getSharpSurfaces () as they were, and beyond its end in getFoundSharpSurfaces (). */
  const std::vector<Crease> &
  getCreases () const
  {
    return report_.creases;
  }

  /** \brief The vertices of the last mesh in which more than two creases meet. */
  const std::vector<int> &
  getCorners () const
  {
    return report_.corners;
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

  std::vector<float> radii_, confidences_;
  std::vector<Eigen::Matrix3f> shapes_;
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

/** \brief The same with the mesh as the library has it, which takes less memory and time than PCL's.
 * \param[out] mesh in the frame of the cloud; channels is 3 for colour, 1 for intensity
 */
Outcome
reconstruct (const pcl::PCLPointCloud2 &cloud, const Options &options, TriangleMesh &mesh, Report &report,
             ImplicitField::ConstPtr *field = nullptr, const ProgressCallback &progress = {});

/** \brief The same without a mesh: only the field, null on failure. */
Outcome
computeField (const pcl::PCLPointCloud2 &cloud, const Options &options, ImplicitField::ConstPtr &field, Report &report,
              const ProgressCallback &progress = {});

} // namespace erkpa

#include <erkpa/impl/erkpa.hpp>
