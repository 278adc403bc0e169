// SPDX-License-Identifier: BSD-3-Clause
//
// A depth image of boxes on a table becomes a mesh with sharp edges: pcl::SACSegmentation finds planes, and where two
// of them meet in the points the surface is made sharp.
//
//   boxes_on_table image.pcd mesh.ply creases.obj
#include <erkpa/erkpa.h>

#include <pcl/filters/extract_indices.h>
#include <pcl/filters/passthrough.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <cmath>
#include <fstream>
#include <iostream>

using Cloud = pcl::PointCloud<pcl::PointXYZRGB>;

constexpr float FARTHEST = 1.6f;      // metres: what lies behind is too noisy
constexpr float LEAF = 0.003f;        // metres between points: more of them would only be more noise
constexpr double THRESHOLD = 0.004;   // metres: how far points of a face lie off it
constexpr std::size_t SMALLEST = 300; // points of a face

/** \brief The points that lie near enough, one in each cell of a grid. */
static Cloud::Ptr
prepare (const Cloud::ConstPtr &image)
{
  const Cloud::Ptr near (new Cloud), thinned (new Cloud);
  pcl::PassThrough<pcl::PointXYZRGB> pass;
  pass.setInputCloud (image);
  pass.setFilterFieldName ("z");
  pass.setFilterLimits (0.0f, FARTHEST);
  pass.filter (*near);
  pcl::VoxelGrid<pcl::PointXYZRGB> grid;
  grid.setInputCloud (near);
  grid.setLeafSize (LEAF, LEAF, LEAF);
  grid.filter (*thinned);
  return thinned;
}

/** \brief Takes the plane most points lie on out of the cloud; false where only small ones are left. */
static bool
takePlane (Cloud::Ptr &rest, pcl::ModelCoefficients &plane)
{
  pcl::SACSegmentation<pcl::PointXYZRGB> segmentation;
  segmentation.setModelType (pcl::SACMODEL_PLANE);
  segmentation.setDistanceThreshold (THRESHOLD);
  segmentation.setMaxIterations (2000);
  segmentation.setInputCloud (rest);
  const pcl::PointIndices::Ptr inliers (new pcl::PointIndices);
  segmentation.segment (*inliers, plane);
  if (inliers->indices.size () < SMALLEST)
    return false;
  const Cloud::Ptr others (new Cloud);
  pcl::ExtractIndices<pcl::PointXYZRGB> extract;
  extract.setInputCloud (rest);
  extract.setIndices (inliers);
  extract.setNegative (true);
  extract.filter (*others);
  rest = others;
  return true;
}

/** \brief Whether a plane is one of the faces once more: what noise has left of it. */
static bool
isKnown (const pcl::ModelCoefficients &plane, const std::vector<erkpa::FaceModel> &faces)
{
  const Eigen::Vector4f p (plane.values.data ());
  for (const erkpa::FaceModel &face : faces)
  {
    const Eigen::Vector4f q (face.coefficients.data ());
    const float cosine = p.head<3> ().dot (q.head<3> ());
    if (std::abs (cosine) > 0.99f && std::abs (p[3] - std::copysign (1.0f, cosine) * q[3]) < 4.0 * THRESHOLD)
      return true;
  }
  return false;
}

/** \brief The creases of a mesh as lines of a Wavefront file. */
static bool
saveCreases (const std::string &path, const pcl::PolygonMesh &mesh, const std::vector<erkpa::Crease> &creases)
{
  pcl::PointCloud<pcl::PointXYZ> vertices;
  pcl::fromPCLPointCloud2 (mesh.cloud, vertices);
  std::ofstream file (path);
  for (const erkpa::Crease &crease : creases)
  {
    for (const int v : crease.vertices)
      file << "v " << vertices[v].x << " " << vertices[v].y << " " << vertices[v].z << "\n";
    file << "l";
    for (std::size_t i = crease.vertices.size (); i > 0; --i) // counted from the last vertex
      file << " -" << i;
    file << "\n";
  }
  return file.good ();
}

int
main (int argc, char **argv)
{
  const Cloud::Ptr image (new Cloud);
  if (argc != 4 || pcl::io::loadPCDFile (argv[1], *image) < 0)
  {
    std::cerr << "usage: boxes_on_table image.pcd mesh.ply creases.obj\n";
    return 2;
  }
  const Cloud::Ptr cloud = prepare (image);
  erkpa::ERKPA<pcl::PointXYZRGB> erkpa;
  erkpa.setInputCloud (cloud);              // with the image's sensor_origin_, to which the normals will point
  erkpa.setFaceTolerance (2.0 * THRESHOLD); // towards its edges a face as the sensor sees it bends
  Cloud::Ptr rest = cloud;
  for (pcl::ModelCoefficients plane; takePlane (rest, plane);)
    if (!isKnown (plane, erkpa.getFaces ()))
      erkpa.addFace (plane);

  pcl::PolygonMesh mesh;
  erkpa.reconstruct (mesh);
  std::cout << cloud->size () << " points, " << erkpa.getFaces ().size () << " faces, "
            << erkpa.getFoundSharpSurfaces ().size () << " sharp edges, " << mesh.polygons.size () << " triangles, "
            << erkpa.getCreases ().size () << " creases\n";
  if (erkpa.getStatus () != erkpa::Status::OK || pcl::io::savePLYFileBinary (argv[2], mesh) < 0)
    return 1;
  return saveCreases (argv[3], mesh, erkpa.getCreases ()) ? 0 : 1;
}
