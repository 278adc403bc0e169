// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_intersections.h"

#include <gtest/gtest.h>

using Eigen::Vector3d;
using Triangle = std::array<int, 3>;
using Pairs = std::vector<std::pair<int, int>>;

namespace
{

/** \brief A triangle in the plane z = 0 with corners 0, 1, 2, and points to make others of. */
const erkpa::LargeVector<Vector3d> POINTS{
    {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.2, 0.2, -0.5}, {0.3, 0.2, 0.5},
    {0.2, 0.3, 0.5}, {0.2, 0.2, 0.1}, {1.2, 1.2, 0.5}, {1.2, 1.2, -0.5}, {1.0, 1.0, -0.2},
};
const Triangle FLAT{0, 1, 2};

} // namespace

TEST (MeshIntersections, AreFoundWhereASideOfOneTrianglePassesThroughTheOther)
{
  EXPECT_TRUE (erkpa::passThrough (POINTS, FLAT, {3, 4, 5}));
  EXPECT_TRUE (erkpa::passThrough (POINTS, {3, 4, 5}, FLAT));
  EXPECT_FALSE (erkpa::passThrough (POINTS, FLAT, {4, 5, 6})) << "above";
  EXPECT_FALSE (erkpa::passThrough (POINTS, FLAT, {7, 8, 9})) << "beside";
}

TEST (MeshIntersections, OfTrianglesThatShareAVertexAreThoseBeyondIt)
{
  EXPECT_TRUE (erkpa::passThrough (POINTS, FLAT, {0, 3, 4}));
  EXPECT_FALSE (erkpa::passThrough (POINTS, FLAT, {0, 4, 5}));
  EXPECT_FALSE (erkpa::passThrough (POINTS, FLAT, {0, 1, 4})) << "a common edge";
}

TEST (MeshIntersections, ComeWithASuspectFirstAndEachPairOnce)
{
  const erkpa::LargeVector<Triangle> triangles{FLAT, {3, 4, 5}, {7, 8, 9}};
  for (const double cell : {0.05, 0.3, 10.0})
  {
    EXPECT_EQ (erkpa::findIntersections (POINTS, triangles, {1}, cell, 2), (Pairs{{1, 0}}));
    EXPECT_EQ (erkpa::findIntersections (POINTS, triangles, {0, 1, 2}, cell, 2), (Pairs{{0, 1}}));
    EXPECT_TRUE (erkpa::findIntersections (POINTS, triangles, {2}, cell, 2).empty ());
  }
}
