// SPDX-License-Identifier: BSD-3-Clause
//
// Uses the library as a stranger does, from outside its tree. Built with and without AVX: Eigen's allocator
// differs between the two, so memory that crosses into the library and is freed on the other side ends this
// program.
#include <erkpa/erkpa.h>
#include <erkpa/version.h>

#include <pcl/conversions.h>
#include <pcl/search/kdtree.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <type_traits>

namespace
{

const Eigen::Vector3f CENTER (3.0f, -2.0f, 0.5f);
constexpr double RADIUS = 1.5;
constexpr int SIZE = 3000;

void
require (bool condition, const char *type, const char *what)
{
  if (condition)
    return;
  std::fprintf (stderr, "consumer: %s: %s\n", type, what);
  std::exit (1);
}

/** \brief Evenly spread points on a sphere, with outward normals where the type has them. */
template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr
makeSphere ()
{
  typename pcl::PointCloud<PointT>::Ptr cloud (new pcl::PointCloud<PointT>);
  for (int i = 0; i < SIZE; ++i)
  {
    const double z = 1.0 - (2.0 * i + 1.0) / SIZE;
    const double angle = 2.399963229728653 * i; // the golden angle
    const double r = std::sqrt (1.0 - z * z);
    const Eigen::Vector3d n (r * std::cos (angle), r * std::sin (angle), z);
    PointT point;
    point.getVector3fMap () = CENTER + (RADIUS * n).cast<float> ();
    if constexpr (pcl::traits::has_normal<PointT>::value)
      point.getNormalVector3fMap () = n.cast<float> ();
    cloud->push_back (point);
  }
  return cloud;
}

/** \brief Volume within a closed surface (the divergence theorem): positive if it is turned outwards. */
template <typename PointT>
double
volume (const pcl::PointCloud<PointT> &points, const std::vector<pcl::Vertices> &polygons)
{
  double sum = 0.0;
  for (const pcl::Vertices &polygon : polygons)
  {
    const auto corner = [&] (int i) -> Eigen::Vector3d
    { return (points[polygon.vertices[i]].getVector3fMap () - CENTER).template cast<double> (); };
    sum += corner (0).dot (corner (1).cross (corner (2))) / 6.0;
  }
  return sum;
}

bool
isVolumeOfSphere (double volume)
{
  const double expected = 4.0 / 3.0 * M_PI * RADIUS * RADIUS * RADIUS;
  return std::abs (volume - expected) < 0.02 * expected;
}

template <typename PointT>
void
reconstructSphere (const char *type)
{
  const typename pcl::PointCloud<PointT>::Ptr cloud = makeSphere<PointT> ();
  typename erkpa::ERKPA<PointT>::Ptr erkpa (new erkpa::ERKPA<PointT>);
  erkpa->setInputCloud (cloud);

  pcl::PolygonMesh mesh;
  erkpa->reconstruct (mesh);
  require (erkpa->getStatus () == erkpa::Status::OK, type, erkpa->getStatusMessage ().c_str ());
  pcl::PointCloud<PointT> vertices;
  pcl::fromPCLPointCloud2 (mesh.cloud, vertices);
  require (isVolumeOfSphere (volume (vertices, mesh.polygons)), type, "wrong volume of the PolygonMesh");

  // The other overload, the neighbours from a tree of the user's.
  erkpa->setSearchMethod (typename pcl::search::KdTree<PointT>::Ptr (new pcl::search::KdTree<PointT>));
  pcl::PointCloud<PointT> points;
  std::vector<pcl::Vertices> polygons;
  erkpa->reconstruct (points, polygons);
  require (erkpa->getStatus () == erkpa::Status::OK, type, erkpa->getStatusMessage ().c_str ());
  require (isVolumeOfSphere (volume (points, polygons)), type, "wrong volume of the points and polygons");

  erkpa::ImplicitField::ConstPtr field = erkpa->computeField ();
  require (field != nullptr, type, "no field");
  erkpa.reset (); // the field outlives what made it
  const erkpa::FieldSample outside = field->sample (CENTER.cast<double> () + 1.1 * RADIUS * Eigen::Vector3d::UnitX ());
  require (outside.value > 0.0 && outside.gradient.x () > 0.5, type, "wrong field");
  std::printf ("consumer: %s: %zu points, %zu triangles\n", type, points.size (), polygons.size ());
}

/** \brief The function for clouds whose type is known at run time only. */
void
reconstructBlob ()
{
  pcl::PCLPointCloud2 cloud;
  pcl::toPCLPointCloud2 (*makeSphere<pcl::PointNormal> (), cloud);
  pcl::PolygonMesh mesh;
  erkpa::Report report;
  const erkpa::Outcome outcome = erkpa::reconstruct (cloud, erkpa::Options (), mesh, report);
  require (outcome.ok (), "PCLPointCloud2", outcome.message.c_str ());
  require (report.topology.boundary_edges == 0, "PCLPointCloud2", "the sphere is open");
}

} // namespace

int
main ()
{
#ifdef __AVX2__
  if (!__builtin_cpu_supports ("avx2"))
  {
    std::puts ("consumer: skipped, this processor has no AVX2");
    return 77;
  }
#endif
  reconstructSphere<pcl::PointNormal> ("PointNormal");
  reconstructSphere<pcl::PointXYZRGBNormal> ("PointXYZRGBNormal");
  reconstructSphere<pcl::PointXYZINormal> ("PointXYZINormal");
  reconstructSphere<pcl::PointXYZ> ("PointXYZ, normals estimated");
  reconstructBlob ();
  std::puts ("consumer: erkpa " ERKPA_VERSION);
  return 0;
}
