// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/erkpa.h>

#include <pcl/common/io.h>

#include <limits>
#include <string>

namespace erkpa
{

void
reportPoints (const std::string &class_name, const Report &report, const Options &options)
{
  const PointCounts &points = report.points;
  if (points.not_finite + points.duplicate > 0)
    PCL_WARN ("[%s::reconstruct] Of %zu points %zu are not finite and %zu repeat another: they are left out.\n",
              class_name.c_str (), points.read, points.not_finite, points.duplicate);
  if (points.without_normal == 0)
    return;
  const Eigen::Vector3d &eye = options.normals.view_point;
  if (report.orientation == Orientation::VIEW_POINT)
    PCL_WARN ("[%s::reconstruct] %zu points have no usable normal: normals are estimated and oriented to the view "
              "point (%g, %g, %g).\n",
              class_name.c_str (), points.without_normal, eye.x (), eye.y (), eye.z ());
  else
    PCL_WARN ("[%s::reconstruct] %zu points have no usable normal: normals are estimated and oriented outwards, from "
              "neighbour to neighbour%s.\n",
              class_name.c_str (), points.without_normal,
              options.normals.has_view_point ? ", where the view point cannot have seen the surface" : "");
}

void
reportRounding (const std::string &class_name, const ImplicitField &field, const Report &report)
{
  const double step = field.points ().origin.cwiseAbs ().maxCoeff () * std::numeric_limits<float>::epsilon ();
  if (16.0 * step > report.polygonizer.voxel_size)
    PCL_WARN ("[%s::reconstruct] Coordinates are rounded to steps of %g, with voxels of %g: triangles may collapse. "
              "Subtract an offset from the cloud first.\n",
              class_name.c_str (), step, report.polygonizer.voxel_size);
}

namespace
{

template <typename PointT>
Outcome
reconstructAs (const pcl::PCLPointCloud2 &input, const Options &options, pcl::PolygonMesh &mesh, Report &report,
               ImplicitField::ConstPtr *field, const ProgressCallback &progress)
{
  const typename pcl::PointCloud<PointT>::Ptr cloud (new pcl::PointCloud<PointT>);
  if (!input.data.empty ()) // PCL's conversion is undefined without points
    pcl::fromPCLPointCloud2 (input, *cloud);
  ERKPA<PointT> erkpa;
  erkpa.setOptions (options);
  erkpa.setProgressCallback (progress);
  erkpa.setInputCloud (cloud);
  erkpa.reconstruct (mesh);
  report = erkpa.getReport ();
  if (field != nullptr)
    *field = erkpa.getField ();
  return {erkpa.getStatus (), erkpa.getStatusMessage ()};
}

bool
hasField (const pcl::PCLPointCloud2 &cloud, const std::string &name)
{
  return pcl::getFieldIndex (cloud, name) >= 0;
}

} // namespace

Outcome
reconstruct (const pcl::PCLPointCloud2 &cloud, const Options &options, pcl::PolygonMesh &mesh, Report &report,
             ImplicitField::ConstPtr *field, const ProgressCallback &progress)
{
  const bool normals = hasField (cloud, "normal_x");
  if (hasField (cloud, "rgb") || hasField (cloud, "rgba"))
    return normals ? reconstructAs<pcl::PointXYZRGBNormal> (cloud, options, mesh, report, field, progress)
                   : reconstructAs<pcl::PointXYZRGB> (cloud, options, mesh, report, field, progress);
  if (hasField (cloud, "intensity"))
    return normals ? reconstructAs<pcl::PointXYZINormal> (cloud, options, mesh, report, field, progress)
                   : reconstructAs<pcl::PointXYZI> (cloud, options, mesh, report, field, progress);
  return normals ? reconstructAs<pcl::PointNormal> (cloud, options, mesh, report, field, progress)
                 : reconstructAs<pcl::PointXYZ> (cloud, options, mesh, report, field, progress);
}

} // namespace erkpa
