// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/erkpa.h>

#include "field_type.h"

#include <pcl/common/io.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <sstream>
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
  Outcome bad{Status::INVALID_SETTING, "the field \"" + name + "\" of the cloud is not a number of a known type"};
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

Outcome
outcomeOfException ()
{
  try
  {
    throw;
  }
  catch (const std::bad_alloc &)
  {
    return {Status::INTERNAL_ERROR, "out of memory: use a larger voxel size or fewer points"};
  }
  catch (const std::exception &error)
  {
    return {Status::INTERNAL_ERROR, error.what ()};
  }
  catch (...)
  {
    return {Status::INTERNAL_ERROR, "a function given by the caller threw something that is no std::exception"};
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
  const Eigen::Vector3d &eye = options.normals.view_point;
  std::ostringstream how;
  if (report.orientation == Orientation::VIEW_POINT)
    how << "to the view point (" << eye.x () << ", " << eye.y () << ", " << eye.z () << ")";
  else
    how << (report.orientation == Orientation::ONE_SIDE ? "to the side that all of them are seen from"
                                                        : "outwards, from neighbour to neighbour")
        << (options.normals.has_view_point ? ", where the view point does not seem to have seen all of the surface"
                                           : "");
  if (points.without_normal > 0)
    PCL_WARN ("[%s::reconstruct] %zu points have no usable normal: normals are estimated and oriented %s.\n",
              class_name.c_str (), points.without_normal, how.str ().c_str ());
  if (report.normals_contradicted)
    PCL_WARN ("[%s::reconstruct] Normals of neighbours look opposite ways: they are oriented anew, %s.\n",
              class_name.c_str (), how.str ().c_str ());
  if (report.normals_turned > 0)
    PCL_WARN ("[%s::reconstruct] %zu normals look the other way than those around them: they are turned.\n",
              class_name.c_str (), report.normals_turned);
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
  TriangleMesh *mesh;
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

bool
hasField (const pcl::PCLPointCloud2 &cloud, const std::string &name)
{
  return pcl::getFieldIndex (cloud, name) >= 0;
}

Attributes
attributesOf (const pcl::PCLPointCloud2 &cloud)
{
  if (hasField (cloud, "rgb") || hasField (cloud, "rgba"))
    return Attributes::COLOR;
  return hasField (cloud, "intensity") ? Attributes::INTENSITY : Attributes::NONE;
}

/** \brief Where three floats of the first point follow each other; null where the cloud does not have them so. */
const float *
findTriple (const pcl::PCLPointCloud2 &cloud, const std::array<const char *, 3> &names)
{
  const std::uint8_t *first = nullptr;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const int index = pcl::getFieldIndex (cloud, names[i]);
    if (index < 0 || cloud.fields[static_cast<std::size_t> (index)].datatype != pcl::PCLPointField::FLOAT32)
      return nullptr;
    const std::uint8_t *at = cloud.data.data () + cloud.fields[static_cast<std::size_t> (index)].offset;
    first = i == 0 ? at : first;
    if (at != first + i * sizeof (float))
      return nullptr;
  }
  return reinterpret_cast<std::uintptr_t> (first) % alignof (float) == 0 ? reinterpret_cast<const float *> (first)
                                                                         : nullptr;
}

/** \brief Look at the cloud where it lies; false where its memory is not as it would have to be. */
bool
viewInPlace (const pcl::PCLPointCloud2 &cloud, PointView &view)
{
  const bool has_normals = hasField (cloud, "normal_x");
  if (cloud.data.empty () || attributesOf (cloud) != Attributes::NONE || cloud.point_step % alignof (float) != 0 ||
      (cloud.height > 1 && cloud.row_step != std::size_t (cloud.width) * cloud.point_step))
    return false;
  view.size = std::size_t (cloud.width) * cloud.height;
  view.stride = cloud.point_step;
  view.position = findTriple (cloud, {"x", "y", "z"});
  view.normal = findTriple (cloud, {"normal_x", "normal_y", "normal_z"});
  return view.position != nullptr && (view.normal != nullptr || !has_normals);
}

/** \brief The points that a view looks at, where they are not looked at in place. */
using Holder = std::shared_ptr<void>;

template <typename PointT>
Holder
viewAs (const pcl::PCLPointCloud2 &input, PointView &view)
{
  const auto cloud = std::make_shared<pcl::PointCloud<PointT>> ();
  if (!input.data.empty ()) // PCL's conversion is undefined without points
    pcl::fromPCLPointCloud2 (input, *cloud);
  view = viewCloud (*cloud);
  return cloud;
}

/** \brief As the point type that holds most of what the cloud has. */
Holder
viewTyped (const pcl::PCLPointCloud2 &cloud, PointView &view)
{
  const bool normals = hasField (cloud, "normal_x");
  switch (attributesOf (cloud))
  {
    case Attributes::COLOR:
      return normals ? viewAs<pcl::PointXYZRGBNormal> (cloud, view) : viewAs<pcl::PointXYZRGB> (cloud, view);
    case Attributes::INTENSITY:
      return normals ? viewAs<pcl::PointXYZINormal> (cloud, view) : viewAs<pcl::PointXYZI> (cloud, view);
    case Attributes::NONE:
      break;
  }
  return normals ? viewAs<pcl::PointNormal> (cloud, view) : viewAs<pcl::PointXYZ> (cloud, view);
}

Outcome
runUnguarded (const pcl::PCLPointCloud2 &input, const Options &options, const ProgressCallback &progress,
              const Result &result)
{
  Outcome outcome = checkLayout (input);
  if (!outcome.ok ())
    return outcome;
  const bool is_empty = input.data.empty ();
  const CloudBytes bytes{input.fields,   input.data.data (),         input.point_step,
                         input.row_step, is_empty ? 0 : input.width, is_empty ? 0 : input.height};
  double share = 1.0; // of the field
  if (result.mesh != nullptr)
    share = options.field.interpolation == Interpolation::COLLOCATION ? 0.5 : 0.0; // else it takes no time
  ImplicitField::ConstPtr field;
  {
    PointView view;
    const Holder points = viewInPlace (input, view) ? nullptr : viewTyped (input, view);
    outcome = readField (bytes, options.points.radius_field, view.radii);
    if (outcome.ok ())
      outcome = readField (bytes, options.points.confidence_field, view.confidences);
    if (outcome.ok ())
      outcome = buildField (view, options, {}, field, *result.report, partOf (progress, 0.0, share));
  }
  if (!outcome.ok ())
    return outcome;
  reportPoints ("erkpa", *result.report, options);
  if (result.mesh != nullptr)
    outcome = buildMeshNearPoints (field, options, *result.mesh, *result.report, partOf (progress, share, 1.0 - share));
  if (outcome.ok () && result.mesh != nullptr)
    reportRounding ("erkpa", *field, *result.report);
  if (outcome.ok () && result.field != nullptr)
    *result.field = field;
  return outcome;
}

Outcome
run (const pcl::PCLPointCloud2 &cloud, const Options &options, const ProgressCallback &progress, const Result &result)
{
  Outcome outcome;
  const LargePageKeeper keeper;
  try
  {
    outcome = runUnguarded (cloud, options, progress, result);
  }
  catch (...)
  {
    outcome = outcomeOfException ();
  }
  if (!outcome.ok ())
    PCL_ERROR ("[erkpa::reconstruct] %s.\n", outcome.message.c_str ());
  return outcome;
}

} // namespace

Outcome
reconstruct (const pcl::PCLPointCloud2 &cloud, const Options &options, TriangleMesh &mesh, Report &report,
             ImplicitField::ConstPtr *field, const ProgressCallback &progress)
{
  mesh.clear ();
  report = Report ();
  if (field != nullptr)
    field->reset ();
  Outcome outcome = run (cloud, options, progress, {&mesh, field, &report});
  if (!outcome.ok ())
    mesh.clear ();
  return outcome;
}

Outcome
reconstruct (const pcl::PCLPointCloud2 &cloud, const Options &options, pcl::PolygonMesh &mesh, Report &report,
             ImplicitField::ConstPtr *field, const ProgressCallback &progress)
{
  mesh = pcl::PolygonMesh ();
  TriangleMesh triangles;
  Outcome outcome = reconstruct (cloud, options, triangles, report, field, progress);
  toPolygonMesh (triangles, attributesOf (cloud), cloud.header, mesh);
  return outcome;
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
