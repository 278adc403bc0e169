// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "shapes.h"

#include <erkpa/erkpa.h>

#include <pcl/conversions.h>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

/** \brief What the tests of the class share. */

using erkpa::ERKPA;
using erkpa::Status;

constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN ();

/** \brief The mesh of PCL in the core's own form, so that both are measured alike. */
inline erkpa::TriangleMesh
fromPcl (const pcl::PolygonMesh &mesh)
{
  pcl::PointCloud<pcl::PointNormal> cloud;
  pcl::fromPCLPointCloud2 (mesh.cloud, cloud);
  erkpa::TriangleMesh result;
  for (const pcl::PointNormal &p : cloud)
  {
    result.vertices.emplace_back (p.getVector3fMap ());
    result.normals.emplace_back (p.getNormalVector3fMap ());
  }
  for (const pcl::Vertices &polygon : mesh.polygons)
    result.triangles.push_back ({polygon.vertices[0], polygon.vertices[1], polygon.vertices[2]});
  return result;
}

template <typename PointT>
void
expectSphere (const pcl::PolygonMesh &output, double sign = 1.0)
{
  const erkpa::TriangleMesh mesh = fromPcl (output);
  EXPECT_MESH_CONTRACT (mesh, true);
  EXPECT_NEAR (shapes::volume (mesh), sign * 4.0 / 3.0 * M_PI, 0.02);
}

inline void
expectEmpty (const pcl::PolygonMesh &mesh)
{
  EXPECT_TRUE (mesh.polygons.empty ());
  EXPECT_TRUE (mesh.cloud.data.empty ());
  EXPECT_EQ (mesh.cloud.width * mesh.cloud.height, 0u);
}

inline pcl::ModelCoefficients
coefficients (const std::vector<float> &values)
{
  pcl::ModelCoefficients result;
  result.values = values;
  return result;
}

/** \brief A mesh with something in it, to see that it is emptied. */
inline pcl::PolygonMesh
usedMesh ()
{
  pcl::PolygonMesh mesh;
  mesh.polygons.resize (3);
  mesh.cloud.width = 7;
  mesh.cloud.data.resize (99);
  return mesh;
}
