// SPDX-License-Identifier: BSD-3-Clause
//
// Depth images of boxes on a table: what segmentation finds in them becomes sharp edges.
#include "erkpa_tests.h"

#include <pcl/filters/extract_indices.h>
#include <pcl/filters/passthrough.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/io/pcd_io.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>

using Eigen::Vector3d;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Stage = ERKPA<pcl::PointXYZ>;

namespace
{

/** \brief A box in the scene: the middle of its foot, its turn about the upright, its lengths. */
struct Box
{
  Vector3d foot, lengths;
  double turn;
};

/** \brief A table with two boxes as a sensor at the origin sees it that looks along z; y points down. */
class Scene
{
public:
  Scene ()
  {
    up_ = Vector3d (0.0, -std::cos (TILT), -std::sin (TILT));
    right_ = Vector3d::UnitX ();
    away_ = up_.cross (right_);
    table_ = Vector3d (0.0, 0.05, 0.95);
    boxes_ = {{Vector3d (-0.13, 0.0, 0.0), {0.16, 0.12, 0.14}, 0.7},
              {Vector3d (0.12, 0.02, 0.0), {0.14, 0.18, 0.1}, -0.7}};
  }

  /** \brief A depth image with noise that grows with the square of the depth. */
  Cloud::Ptr
  image (double noise_at_one_metre) const
  {
    constexpr int WIDTH = 320, HEIGHT = 240;
    constexpr double FOCAL = 300.0;
    std::mt19937 random (4);
    std::normal_distribution<double> normal (0.0, noise_at_one_metre);
    const Cloud::Ptr cloud (new Cloud (WIDTH, HEIGHT));
    cloud->is_dense = false;
    for (int row = 0; row < HEIGHT; ++row)
      for (int column = 0; column < WIDTH; ++column)
      {
        const Vector3d ray ((column - 0.5 * WIDTH) / FOCAL, (row - 0.5 * HEIGHT) / FOCAL, 1.0);
        const double depth = depthAlong (ray);
        const Vector3d p = ray * (depth + depth * depth * normal (random));
        cloud->at (column, row).getVector3fMap () =
            depth < 1.5 ? Eigen::Vector3f (p.cast<float> ()) : Eigen::Vector3f::Constant (NOT_A_NUMBER);
      }
    return cloud;
  }

  /** \brief The ends of the edges of boxes of which the sensor sees both faces. */
  std::vector<std::pair<Vector3d, Vector3d>>
  visibleEdges () const
  {
    std::vector<std::pair<Vector3d, Vector3d>> edges;
    for (const Box &box : boxes_)
      for (int axis = 0; axis < 3; ++axis)
        for (const double sb : {-1.0, 1.0})
          for (const double sc : {-1.0, 1.0})
          {
            const int b = (axis + 1) % 3, c = (axis + 2) % 3;
            Vector3d from, to;
            from[axis] = -1.0;
            to[axis] = 1.0;
            from[b] = to[b] = sb;
            from[c] = to[c] = sc;
            if (isSeen (box, b, sb) && isSeen (box, c, sc))
              edges.emplace_back (atCorner (box, from), atCorner (box, to));
          }
    return edges;
  }

private:
  static constexpr double TILT = 0.65; // radians below the horizon at which the sensor looks

  Eigen::Matrix3d
  axesOf (const Box &box) const
  {
    Eigen::Matrix3d axes;
    axes.col (0) = std::cos (box.turn) * right_ + std::sin (box.turn) * away_;
    axes.col (1) = std::cos (box.turn) * away_ - std::sin (box.turn) * right_;
    axes.col (2) = up_;
    return axes;
  }

  Vector3d
  middleOf (const Box &box) const
  {
    return table_ + box.foot[0] * right_ + box.foot[1] * away_ + 0.5 * box.lengths[2] * up_;
  }

  Vector3d
  atCorner (const Box &box, const Vector3d &signs) const
  {
    return middleOf (box) + axesOf (box) * signs.cwiseProduct (0.5 * box.lengths);
  }

  bool
  isSeen (const Box &box, int axis, double sign) const
  {
    const Vector3d normal = sign * axesOf (box).col (axis);
    return normal.dot (middleOf (box) + 0.5 * box.lengths[axis] * normal) < 0.0;
  }

  /** \brief The depth of what a ray from the sensor meets first. */
  double
  depthAlong (const Vector3d &ray) const
  {
    double nearest = up_.dot (table_) / up_.dot (ray);
    if (!(nearest > 0.0))
      nearest = HUGE_VAL;
    for (const Box &box : boxes_)
    {
      const Eigen::Matrix3d axes = axesOf (box);
      const Vector3d start = axes.transpose () * -middleOf (box), way = axes.transpose () * ray;
      double enter = 0.0, leave = HUGE_VAL;
      for (int axis = 0; axis < 3; ++axis)
      {
        const double one = (-0.5 * box.lengths[axis] - start[axis]) / way[axis];
        const double other = (0.5 * box.lengths[axis] - start[axis]) / way[axis];
        enter = std::max (enter, std::min (one, other));
        leave = std::min (leave, std::max (one, other));
      }
      if (enter < leave)
        nearest = std::min (nearest, enter);
    }
    return nearest;
  }

  Vector3d up_, right_, away_, table_;
  std::vector<Box> boxes_;
};

/** \brief Gives the stage the planes of a cloud as faces, the largest first. */
void
addFaces (const Cloud::Ptr &cloud, double threshold, std::size_t smallest, Stage &stage)
{
  pcl::SACSegmentation<pcl::PointXYZ> segmentation;
  segmentation.setModelType (pcl::SACMODEL_PLANE);
  segmentation.setDistanceThreshold (threshold);
  segmentation.setMaxIterations (2000);
  Cloud::Ptr rest = cloud;
  while (rest->size () > smallest)
  {
    const pcl::PointIndices::Ptr inliers (new pcl::PointIndices);
    pcl::ModelCoefficients plane;
    segmentation.setInputCloud (rest);
    segmentation.segment (*inliers, plane);
    if (inliers->indices.size () < smallest)
      break;
    EXPECT_TRUE (stage.addFace (plane));
    const Cloud::Ptr others (new Cloud);
    pcl::ExtractIndices<pcl::PointXYZ> extract;
    extract.setInputCloud (rest);
    extract.setIndices (inliers);
    extract.setNegative (true);
    extract.filter (*others);
    rest = others;
  }
  stage.setFaceTolerance (2.0 * threshold); // towards its edges a face as the sensor sees it bends
}

/** \brief The mesh's vertices along its creases. */
std::vector<std::vector<Vector3d>>
creaseLines (Stage &stage)
{
  pcl::PolygonMesh output;
  stage.reconstruct (output);
  EXPECT_EQ (stage.getStatus (), Status::OK) << stage.getStatusMessage ();
  const erkpa::TriangleMesh mesh = fromPcl (output);
  EXPECT_MESH_CONTRACT (mesh, false);
  std::vector<std::vector<Vector3d>> lines;
  for (const erkpa::Crease &crease : stage.getCreases ())
  {
    lines.emplace_back ();
    for (const int v : crease.vertices)
      lines.back ().emplace_back (mesh.vertices[static_cast<std::size_t> (v)].cast<double> ());
  }
  return lines;
}

double
distanceToSegment (const Vector3d &p, const Vector3d &a, const Vector3d &b)
{
  const double t = std::clamp ((p - a).dot (b - a) / (b - a).squaredNorm (), 0.0, 1.0);
  return (a + t * (b - a) - p).norm ();
}

/** \brief How far a place is from the nearest crease. */
double
distanceToLines (const Vector3d &p, const std::vector<std::vector<Vector3d>> &lines)
{
  double nearest = HUGE_VAL;
  for (const std::vector<Vector3d> &line : lines)
    for (std::size_t i = 0; i + 1 < line.size (); ++i)
      nearest = std::min (nearest, distanceToSegment (p, line[i], line[i + 1]));
  return nearest;
}

/** \brief Length of a line from end to end, and how far its points are from the straight one at most. */
std::pair<double, double>
straightness (const std::vector<Vector3d> &line)
{
  double off = 0.0;
  for (const Vector3d &p : line)
    off = std::max (off, distanceToSegment (p, line.front (), line.back ()));
  return {(line.back () - line.front ()).norm (), off};
}

/** \brief Of the inner nine tenths of the edges: the share that has a crease within a distance. */
double
shareWithin (double distance, const std::vector<std::pair<Vector3d, Vector3d>> &edges,
             const std::vector<std::vector<Vector3d>> &lines)
{
  int within = 0, all = 0;
  for (const auto &[from, to] : edges)
    for (double t = 0.05; t <= 0.95; t += 0.01, ++all)
      within += distanceToLines (from + t * (to - from), lines) < distance;
  return within / static_cast<double> (all);
}

} // namespace

TEST (BoxesOnTable, HaveStraightEdgesInASyntheticImage)
{
  const double noise = 0.001; // metres at one metre, a third of the spacing
  const Scene scene;
  const Cloud::Ptr image = scene.image (noise), cloud (new Cloud);
  pcl::PassThrough<pcl::PointXYZ> pass;
  pass.setInputCloud (image);
  pass.filter (*cloud);
  Stage stage;
  stage.setInputCloud (cloud);
  addFaces (cloud, 3.0 * noise, 400, stage);
  const auto edges = scene.visibleEdges ();
  ASSERT_EQ (edges.size (), 6u);
  const auto lines = creaseLines (stage);
  EXPECT_GT (shareWithin (3.0 * noise, edges, lines), 0.9);
}

TEST (BoxesOnTable, HaveStraightEdgesInAKinectImage)
{
  const char *folder = std::getenv ("ERKPA_TEST_DATA");
  const std::string path = folder ? std::string (folder) + "/boxes_on_table_kinect.pcd" : "";
  if (path.empty () || !std::ifstream (path).good ())
    GTEST_SKIP () << "needs boxes_on_table_kinect.pcd in ERKPA_TEST_DATA";
  const Cloud::Ptr image (new Cloud), near (new Cloud), cloud (new Cloud);
  ASSERT_EQ (pcl::io::loadPCDFile (path, *image), 0);
  pcl::PassThrough<pcl::PointXYZ> pass; // the boxes and the table around them
  pass.setInputCloud (image);
  pass.setFilterFieldName ("z");
  pass.setFilterLimits (0.0f, 1.1f);
  pass.filter (*near);
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud (near);
  grid.setLeafSize (0.003f, 0.003f, 0.003f);
  grid.filter (*cloud);
  const double threshold = 0.004; // metres
  Stage stage;
  stage.setInputCloud (cloud);
  addFaces (cloud, threshold, 400, stage);
  EXPECT_GE (stage.getFaces ().size (), 4u);
  int straight = 0, all = 0;
  for (const std::vector<Vector3d> &line : creaseLines (stage))
  {
    const auto [length, off] = straightness (line);
    if (length < 0.02)
      continue;
    ++all;
    straight += off < threshold;
  }
  EXPECT_GE (all, 3);
  EXPECT_EQ (straight, all);
}
