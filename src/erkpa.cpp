// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/erkpa.h>

#include "field_type.h"

#include <pcl/common/io.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace erkpa
{

namespace
{

template <typename T>
void
readAs (const CloudBytes &cloud, std::size_t offset, std::vector<float> &values)
{
  values.clear ();
  for (std::size_t row = 0; row < cloud.height; ++row)
    for (std::size_t column = 0; column < cloud.width; ++column)
    {
      T value;
      std::memcpy (&value, cloud.data + row * cloud.row_step + column * cloud.point_step + offset, sizeof (T));
      values.push_back (static_cast<float> (value));
    }
}

} // namespace

Outcome
readField (const CloudBytes &cloud, const std::string &name, std::vector<float> &values)
{
  using Field = pcl::PCLPointField;
  if (name.empty ())
    return {};
  const auto field =
      std::find_if (cloud.fields.begin (), cloud.fields.end (), [&name] (const Field &f) { return f.name == name; });
  std::string names;
  for (const Field &other : cloud.fields)
    names += (names.empty () ? "" : ", ") + other.name;
  if (field == cloud.fields.end ())
    return {Status::INVALID_SETTING, "the cloud has no field \"" + name + "\": it has " + names};
  const Outcome bad{Status::INVALID_SETTING, "the field \"" + name + "\" of the cloud is not a number of a known type"};
  const auto size = static_cast<std::size_t> (pcl::getFieldSize (field->datatype));
  if (size == 0 || field->offset + size > cloud.point_step)
    return bad;
  withType (field->datatype, [&] (auto zero) { readAs<decltype (zero)> (cloud, field->offset, values); });
  return {};
}

bool
surfaceModelOf (pcl::SacModel model, SurfaceModel &surface)
{
  switch (model)
  {
    case pcl::SACMODEL_PLANE:
    case pcl::SACMODEL_PARALLEL_PLANE:
    case pcl::SACMODEL_PERPENDICULAR_PLANE:
    case pcl::SACMODEL_NORMAL_PLANE:
    case pcl::SACMODEL_NORMAL_PARALLEL_PLANE:
      surface = SurfaceModel::PLANE;
      return true;
    case pcl::SACMODEL_SPHERE:
    case pcl::SACMODEL_NORMAL_SPHERE:
      surface = SurfaceModel::SPHERE;
      return true;
    case pcl::SACMODEL_CYLINDER:
      surface = SurfaceModel::CYLINDER;
      return true;
    case pcl::SACMODEL_CONE:
      surface = SurfaceModel::CONE;
      return true;
    default:
      return false;
  }
}

void
reportPoints (const std::string &class_name, const Report &report, const Options &options)
{
  const PointCounts &points = report.points;
  if (points.not_finite + points.duplicate > 0)
    PCL_WARN ("[%s::reconstruct] Of %zu points %zu are not finite and %zu repeat another: they are left out.\n",
              class_name.c_str (), points.read, points.not_finite, points.duplicate);
  if (points.no_confidence > 0)
    PCL_WARN ("[%s::reconstruct] %zu points have no positive confidence: they are left out.\n", class_name.c_str (),
              points.no_confidence);
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

/** \brief What a call at run time fills in; no mesh is made where there is none to fill. */
struct Result
{
  pcl::PolygonMesh *mesh;
  ImplicitField::ConstPtr *field;
  Report *report;
};

/** \brief Whether every field lies within its point and every row within the data: PCL's conversions do not look. */
Outcome
checkLayout (const pcl::PCLPointCloud2 &cloud)
{
  for (const pcl::PCLPointField &field : cloud.fields)
  {
    const auto size = static_cast<std::size_t> (pcl::getFieldSize (field.datatype)) * std::max (field.count, 1U);
    if (field.offset + size > cloud.point_step)
      return {Status::BAD_CLOUD, "the field \"" + field.name + "\" of the cloud ends at byte " +
                                     std::to_string (field.offset + size) + " of its points of " +
                                     std::to_string (cloud.point_step) + ": set its offset or point_step"};
  }
  const std::size_t row = std::size_t (cloud.width) * cloud.point_step;
  const std::size_t needed = cloud.height == 0 ? 0 : (cloud.height - 1) * std::size_t (cloud.row_step) + row;
  if ((cloud.height > 1 && cloud.row_step < row) || cloud.data.size () < needed)
    return {Status::BAD_CLOUD, "the cloud has " + std::to_string (cloud.data.size ()) + " bytes for " +
                                   std::to_string (cloud.height) + " rows of " + std::to_string (row) +
                                   ": set its width, height, row_step and data to agree"};
  return {};
}

template <typename PointT>
Outcome
runAs (const pcl::PCLPointCloud2 &input, const Options &options, const ProgressCallback &progress, const Result &result)
{
  const bool is_empty = input.data.empty ();
  const CloudBytes bytes{input.fields,   input.data.data (),         input.point_step,
                         input.row_step, is_empty ? 0 : input.width, is_empty ? 0 : input.height};
  std::vector<float> radii, confidences;
  Outcome outcome = checkLayout (input);
  if (outcome.ok ())
    outcome = readField (bytes, options.points.radius_field, radii);
  if (outcome.ok ())
    outcome = readField (bytes, options.points.confidence_field, confidences);
  if (!outcome.ok ())
  {
    PCL_ERROR ("[erkpa::reconstruct] %s.\n", outcome.message.c_str ());
    return outcome;
  }
  const typename pcl::PointCloud<PointT>::Ptr cloud (new pcl::PointCloud<PointT>);
  if (!is_empty) // PCL's conversion is undefined without points
    pcl::fromPCLPointCloud2 (input, *cloud);
  Options typed = options;
  typed.points = PointOptions (); // PointT does not have these fields
  ERKPA<PointT> erkpa;
  erkpa.setOptions (typed);
  erkpa.setRadii (radii);
  erkpa.setConfidences (confidences);
  erkpa.setProgressCallback (progress);
  erkpa.setInputCloud (cloud);
  if (result.mesh != nullptr)
    erkpa.reconstruct (*result.mesh);
  else
    erkpa.computeField ();
  *result.report = erkpa.getReport ();
  if (result.field != nullptr)
    *result.field = erkpa.getField ();
  return {erkpa.getStatus (), erkpa.getStatusMessage ()};
}

bool
hasField (const pcl::PCLPointCloud2 &cloud, const std::string &name)
{
  return pcl::getFieldIndex (cloud, name) >= 0;
}

/** \brief As the point type that holds most of what the cloud has. */
Outcome
run (const pcl::PCLPointCloud2 &cloud, const Options &options, const ProgressCallback &progress, const Result &result)
{
  const bool normals = hasField (cloud, "normal_x");
  if (hasField (cloud, "rgb") || hasField (cloud, "rgba"))
    return normals ? runAs<pcl::PointXYZRGBNormal> (cloud, options, progress, result)
                   : runAs<pcl::PointXYZRGB> (cloud, options, progress, result);
  if (hasField (cloud, "intensity"))
    return normals ? runAs<pcl::PointXYZINormal> (cloud, options, progress, result)
                   : runAs<pcl::PointXYZI> (cloud, options, progress, result);
  return normals ? runAs<pcl::PointNormal> (cloud, options, progress, result)
                 : runAs<pcl::PointXYZ> (cloud, options, progress, result);
}

} // namespace

Outcome
reconstruct (const pcl::PCLPointCloud2 &cloud, const Options &options, pcl::PolygonMesh &mesh, Report &report,
             ImplicitField::ConstPtr *field, const ProgressCallback &progress)
{
  mesh = pcl::PolygonMesh ();
  report = Report ();
  if (field != nullptr)
    field->reset ();
  return run (cloud, options, progress, {&mesh, field, &report});
}

Outcome
computeField (const pcl::PCLPointCloud2 &cloud, const Options &options, ImplicitField::ConstPtr &field, Report &report,
              const ProgressCallback &progress)
{
  field.reset ();
  report = Report ();
  return run (cloud, options, progress, {nullptr, &field, &report});
}

} // namespace erkpa
