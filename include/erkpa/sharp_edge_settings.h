// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/extent.h>
#include <erkpa/settings.h>
#include <erkpa/sharp_surface.h>

#include <pcl/ModelCoefficients.h>
#include <pcl/sample_consensus/model_types.h>

#include <string>
#include <vector>

namespace erkpa
{

/** \brief The settings of a reconstruction stage that say where its surface is sharp.
 *
 * Sharp edges are given (addSharpEdge () and its kin), found between faces that are given (addFace ()), or found in the
 * points (setAutomaticSharpEdges ()), or all of these. What makes no sense is refused at once, with a PCL_ERROR.
 */
class SharpEdgeSettings : public Settings
{
public:
  /** \brief Make the surface sharp where it crosses a plane.
   * \param[in] coefficients a, b, c, d of a x + b y + c z + d = 0, of any scale: the plane that halves the edge
   * \return false, with a PCL_ERROR, where there are not four finite values or a = b = c = 0
   */
  bool
  addSharpEdge (const pcl::ModelCoefficients &coefficients);

  /** \brief The same with a plane that is in force in a region only, see makeLimited ().
   * \param[in] coefficients as above
   * \param[in] extent the edge and, as that takes points from all sides, a support radius around it
   * \return false, with a PCL_ERROR, where there is no such plane or the extent is null
   */
  bool
  addSharpEdge (const pcl::ModelCoefficients &coefficients, const Extent::ConstPtr &extent);

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

  /** \brief Those given as the coefficients of a plane alone, without an extent. */
  const std::vector<pcl::ModelCoefficients> &
  getSharpEdges () const
  {
    return sharp_edges_;
  }

  /** \brief Replace all sharp edges by surfaces, such as those that were found before; null ones are left out. */
  void
  setSharpSurfaces (const std::vector<SharpSurface::ConstPtr> &surfaces);

  /** \brief All sharp surfaces that were given, planes and others; not those that are found. */
  const std::vector<SharpSurface::ConstPtr> &
  getSharpSurfaces () const
  {
    return options_.field.sharp_surfaces;
  }

  /** \brief Forget one of getSharpSurfaces (), by its place; false, with a PCL_ERROR, where there is none. */
  bool
  removeSharpSurface (std::size_t index);

  /** \brief Forget the sharp edges that were given, planes and others. */
  void
  clearSharpEdges ();

  /** \brief Add the sharp surfaces of a file, see sharp_surface_io.h.
   * \return false, with a PCL_ERROR, where it cannot be read; nothing is added then
   */
  bool
  loadSharpSurfaces (const std::string &path);

  /** \brief Add a face of the solid as segmentation finds it; where faces meet in the points their edges become sharp,
   * see sharpEdgesFromFaces (). Which side is outside does not matter.
   * \param[in] coefficients those of the model, as PCL's sample consensus gives them
   * \param[in] model its model, as for addSharpEdge ()
   * \return false, with a PCL_ERROR, where they make no surface
   */
  bool
  addFace (const pcl::ModelCoefficients &coefficients, pcl::SacModel model = pcl::SACMODEL_PLANE);

  const std::vector<FaceModel> &
  getFaces () const
  {
    return options_.sharp.faces;
  }

  void
  clearFaces ()
  {
    options_.sharp.faces.clear ();
  }

  /** \brief How far points may lie off their face, a length: the distance threshold of the segmentation; 0 (default)
   * = half the spacing of the points. */
  void
  setFaceTolerance (double tolerance)
  {
    options_.sharp.face_tolerance = tolerance;
  }

  double
  getFaceTolerance () const
  {
    return options_.sharp.face_tolerance;
  }

  /** \brief Find sharp edges in the points, see findSharpSurfaces (); not by default. */
  void
  setAutomaticSharpEdges (bool automatic)
  {
    options_.sharp.automatic = automatic;
  }

  bool
  getAutomaticSharpEdges () const
  {
    return options_.sharp.automatic;
  }

  /** \brief Found edges turn by at least this angle in degrees, in [5, 90]; 25 by default. */
  void
  setSharpAngle (double degrees)
  {
    options_.sharp.angle = degrees;
  }

  double
  getSharpAngle () const
  {
    return options_.sharp.angle;
  }

  /** \brief Turn normals that look the other way than those around them, orient those that contradict each other, and,
   * where sharp edges are known or sought, make normals those of one face each, see refineNormals (); true by default.
   * Else they are taken as they are given. */
  void
  setSharpenNormals (bool sharpen)
  {
    options_.normals.sharpen = sharpen;
  }

  bool
  getSharpenNormals () const
  {
    return options_.normals.sharpen;
  }

  /** \brief Give each side of a crease vertices of its own, with the normals of that side, for shading; the mesh is
   * then cut open along its creases. Not by default. */
  void
  setSplitNormals (bool split)
  {
    options_.polygonizer.split_normals = split;
  }

  bool
  getSplitNormals () const
  {
    return options_.polygonizer.split_normals;
  }

protected:
  SharpEdgeSettings () = default;
  ~SharpEdgeSettings () = default;

  /** \brief All settings at once; getSharpEdges () knows none from then on. */
  void
  replaceOptions (const Options &options);

private:
  std::vector<pcl::ModelCoefficients> sharp_edges_;
  std::vector<SharpSurface::ConstPtr> edge_planes_; // of sharp_edges_, one for each
};

} // namespace erkpa
