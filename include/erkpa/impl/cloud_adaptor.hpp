// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/reconstruction.h>

#include <pcl/PCLPointField.h>
#include <pcl/PolygonMesh.h>
#include <pcl/console/print.h>
#include <pcl/conversions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/model_types.h>
#include <pcl/search/search.h>
#include <pcl/type_traits.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief The attributes of a point that a mesh carries on. */
enum class Attributes
{
  NONE,
  COLOR,    ///< r, g, b
  INTENSITY ///< intensity
};

template <typename PointT>
constexpr bool
hasNormal ()
{
  return pcl::traits::has_field<PointT, pcl::fields::normal_x>::value;
}

template <typename PointT>
constexpr Attributes
kindOfAttributes ()
{
  if constexpr (pcl::traits::has_color<PointT>::value)
    return Attributes::COLOR;
  else if constexpr (pcl::traits::has_field<PointT, pcl::fields::intensity>::value)
    return Attributes::INTENSITY;
  else
    return Attributes::NONE;
}

/** \brief A cloud of PCL as the core sees it. */
template <typename PointT>
PointView
viewCloud (const pcl::PointCloud<PointT> &cloud)
{
  PointView view;
  view.size = cloud.size ();
  view.stride = sizeof (PointT);
  if (cloud.empty ())
    return view;
  view.position = cloud.points.front ().data;
  if constexpr (hasNormal<PointT> ())
    view.normal = cloud.points.front ().data_n;
  if constexpr (kindOfAttributes<PointT> () == Attributes::COLOR)
  {
    view.channels = 3;
    view.attributes.reserve (3 * cloud.size ());
    for (const PointT &p : cloud.points)
      view.attributes.insert (view.attributes.end (), {float (p.r), float (p.g), float (p.b)});
  }
  else if constexpr (kindOfAttributes<PointT> () == Attributes::INTENSITY)
  {
    view.channels = 1;
    view.attributes.reserve (cloud.size ());
    for (const PointT &p : cloud.points)
      view.attributes.push_back (static_cast<float> (p.intensity));
  }
  return view;
}

/** \brief The memory of a cloud and the layout of its points. */
struct CloudBytes
{
  std::vector<pcl::PCLPointField> fields;
  const std::uint8_t *data;
  std::size_t point_step, row_step;
  std::size_t width, height;
};

/** \brief The values of a field by name, of any numeric type; nothing is done for an empty name.
 * \return Status::INVALID_SETTING where the cloud has no such field, or one that is not a number
 */
Outcome
readField (const CloudBytes &cloud, const std::string &name, std::vector<float> &values);

/** \brief The surface whose coefficients a model of PCL's sample consensus gives; false where there is none. */
bool
surfaceModelOf (pcl::SacModel model, SurfaceModel &surface);

/** \brief Neighbour queries through a search of PCL that the user chose.
 *
 * Once the user gives the search another cloud, it finds nothing here any more: the field becomes undefined.
 */
template <typename PointT>
class PclSearch : public NeighborSearch
{
public:
  PclSearch (typename pcl::search::Search<PointT>::Ptr tree, const OrientedPoints &points) : tree_ (std::move (tree))
  {
    cloud_->resize (points.size ());
    for (std::size_t i = 0; i < points.size (); ++i)
      (*cloud_)[i].getVector3fMap () = points.positions[i];
    tree_->setInputCloud (cloud_);
  }

  void
  nearestK (const Eigen::Vector3f &x, int k, std::vector<int> &indices,
            std::vector<float> &squared_distances) const override
  {
    if (isStillOurs (indices, squared_distances))
      tree_->nearestKSearch (query (x), k, indices, squared_distances);
  }

  void
  withinRadius (const Eigen::Vector3f &x, double radius, std::vector<int> &indices,
                std::vector<float> &squared_distances) const override
  {
    if (isStillOurs (indices, squared_distances))
      tree_->radiusSearch (query (x), radius, indices, squared_distances);
  }

private:
  bool
  isStillOurs (std::vector<int> &indices, std::vector<float> &squared_distances) const
  {
    indices.clear ();
    squared_distances.clear ();
    return tree_->getInputCloud () == cloud_;
  }

  static PointT
  query (const Eigen::Vector3f &x)
  {
    PointT point;
    point.getVector3fMap () = x;
    return point;
  }

  typename pcl::search::Search<PointT>::Ptr tree_;
  typename pcl::PointCloud<PointT>::Ptr cloud_{new pcl::PointCloud<PointT>};
};

template <typename PointT>
NeighborSearch::ConstPtr
makePclSearch (const typename pcl::search::Search<PointT>::Ptr &tree, const OrientedPoints &points)
{
  return std::make_shared<PclSearch<PointT>> (tree, points);
}

/** \brief A vertex in a point type of PCL; fields the mesh does not know keep their defaults. */
template <typename PointT>
PointT
toPoint (const TriangleMesh &mesh, std::size_t i)
{
  PointT point;
  point.getVector3fMap () = mesh.vertices[i];
  if constexpr (hasNormal<PointT> ())
    point.getNormalVector3fMap () = mesh.normals[i];
  if constexpr (kindOfAttributes<PointT> () == Attributes::COLOR)
  {
    const auto byte = [] (float value) {
      return static_cast<std::uint8_t> (value < 0.0f ? 0.0f : value > 255.0f ? 255.0f : value + 0.5f);
    };
    if (mesh.channels == 3)
    {
      point.r = byte (mesh.attributes[3 * i]);
      point.g = byte (mesh.attributes[3 * i + 1]);
      point.b = byte (mesh.attributes[3 * i + 2]);
    }
  }
  else if constexpr (kindOfAttributes<PointT> () == Attributes::INTENSITY)
    point.intensity = mesh.channels == 1 ? mesh.attributes[i] : 0.0f;
  return point;
}

template <typename PointT>
void
toPointCloud (const TriangleMesh &mesh, pcl::PointCloud<PointT> &cloud)
{
  cloud.resize (mesh.vertices.size ());
  cloud.is_dense = true;
  for (std::size_t i = 0; i < mesh.vertices.size (); ++i)
    cloud[i] = toPoint<PointT> (mesh, i);
}

/** \brief The same without a cloud of that type in between. */
template <typename PointT>
void
toBlob (const TriangleMesh &mesh, pcl::PCLPointCloud2 &blob)
{
  pcl::toPCLPointCloud2 (pcl::PointCloud<PointT> (), blob); // the fields
  blob.width = static_cast<decltype (blob.width)> (mesh.vertices.size ());
  blob.height = 1;
  blob.row_step = blob.width * blob.point_step;
  blob.is_dense = 1;
  reserveLarge (mesh.vertices.size () * sizeof (PointT), blob.data);
  blob.data.resize (mesh.vertices.size () * sizeof (PointT));
  for (std::size_t i = 0; i < mesh.vertices.size (); ++i)
  {
    const PointT point = toPoint<PointT> (mesh, i);
    std::memcpy (&blob.data[i * sizeof (PointT)], &point, sizeof (PointT));
  }
}

/** \brief Triangles as PCL has them, each with memory of its own: that comes soonest from where the mesh was made, and
 * not from other threads, for which the system has to make new memory. */
inline void
toPolygons (const TriangleMesh &mesh, std::vector<pcl::Vertices> &polygons)
{
  reserveLarge (mesh.triangles.size (), polygons);
  polygons.resize (mesh.triangles.size ());
  for (std::size_t i = 0; i < mesh.triangles.size (); ++i)
    polygons[i].vertices.assign (mesh.triangles[i].begin (), mesh.triangles[i].end ());
}

template <typename PointT>
void
toPolygonMeshOf (const TriangleMesh &mesh, const pcl::PCLHeader &header, pcl::PolygonMesh &output)
{
  toBlob<PointT> (mesh, output.cloud);
  output.header = output.cloud.header = header;
  toPolygons (mesh, output.polygons);
}

/** \brief The mesh as PCL hands it on: normals always, colour or intensity where the input had them. */
inline void
toPolygonMesh (const TriangleMesh &mesh, Attributes attributes, const pcl::PCLHeader &header, pcl::PolygonMesh &output)
{
  switch (attributes)
  {
    case Attributes::NONE:
      toPolygonMeshOf<pcl::PointNormal> (mesh, header, output);
      break;
    case Attributes::COLOR:
      toPolygonMeshOf<pcl::PointXYZRGBNormal> (mesh, header, output);
      break;
    case Attributes::INTENSITY:
      toPolygonMeshOf<pcl::PointXYZINormal> (mesh, header, output);
      break;
  }
}

/** \brief The failure that the exception being handled stands for. */
Outcome
outcomeOfException ();

/** \brief Tell the user, once per call, what was done about points that are not as they should be. */
void
reportPoints (const std::string &class_name, const Report &report, const Options &options);

/** \brief Warn where the coordinates are so large that floats round the mesh visibly. */
void
reportRounding (const std::string &class_name, const ImplicitField &field, const Report &report);

} // namespace erkpa
