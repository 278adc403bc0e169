// SPDX-License-Identifier: BSD-3-Clause
//
// What erkpa_reconstruct reads and writes.
#include "erkpa_reconstruct_test.h"

#include <nlohmann/json.hpp>
#include <pcl/io/pcd_io.h>

#include <sstream>

namespace
{

TEST_F (ErkpaReconstruct, ReadsTablesOfText)
{
  expectReads ("sphere.xyz");
  write ("a.xyzn", "# a comment\n\n" + sphereRows (true, "\t", ",\t", " # another\r"));
  expectReads ("a.xyzn");
  write ("a.xyzn", "\xEF\xBB\xBF" + sphereRows (true)); // as some editors begin a text
  expectReads ("a.xyzn");
  write ("without_normals.XYZ", sphereRows (false));
  expectReads ("without_normals.XYZ");
  write ("a.pwn", sphereRows (true));
  expectReads ("a.pwn");
  write ("counted.pwn", "3000\n" + sphereRows (true));
  expectReads ("counted.pwn");
}

TEST_F (ErkpaReconstruct, ReadsEveryKindOfPcd)
{
  const auto cloud = sphereCloud<pcl::PointNormal> ();
  pcl::io::savePCDFileASCII (path ("ascii.pcd"), cloud);
  expectReads ("ascii.pcd");
  pcl::io::savePCDFileBinary (path ("binary.pcd"), cloud);
  expectReads ("binary.pcd");
  pcl::io::savePCDFileBinaryCompressed (path ("compressed.pcd"), cloud);
  expectReads ("compressed.pcd");
}

TEST_F (ErkpaReconstruct, ReadsEveryKindOfPly)
{
  const auto cloud = sphereCloud<pcl::PointNormal> ();
  pcl::io::savePLYFileASCII (path ("ascii.ply"), cloud);
  expectReads ("ascii.ply");
  pcl::io::savePLYFileBinary (path ("binary.ply"), cloud);
  expectReads ("binary.ply");

  std::string doubles = "ply\nformat binary_big_endian 1.0\ncomment -\nelement skipped 1\nproperty uchar a\n"
                        "element vertex 3000\nproperty double x\nproperty double y\nproperty double z\n"
                        "property uint8 class\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n?";
  for (const Eigen::Vector3d &p : fibonacciSphere ())
  {
    for (double coordinate : p)
    {
      auto *bytes = reinterpret_cast<char *> (&coordinate);
      std::reverse (bytes, bytes + sizeof (coordinate));
      doubles.append (bytes, sizeof (coordinate));
    }
    doubles += '\7';
  }
  write ("doubles.ply", doubles + '\3' + std::string (12, '\0'));
  expectReads ("doubles.ply");
}

TEST_F (ErkpaReconstruct, ReadsVerticesOfMeshFiles)
{
  write ("plain.off", "OFF\n3000 0 0\n" + sphereRows (false));
  expectReads ("plain.off");
  write ("normals.off", "# comment\nNOFF 3000 0 0\n" + sphereRows (true));
  expectReads ("normals.off");
  write ("colours.off", "COFF\n3000 0 0\n" + sphereRows (false, "", " ", " 255 0 0 255"));
  expectReads ("colours.off");
  write ("plain.obj", "o name\n" + sphereRows (false, "v ") + "f 1 2 3\n");
  expectReads ("plain.obj");
  write ("normals.obj", sphereRows (false, "v ") + sphereRows (false, "vn "));
  expectReads ("normals.obj");
}

TEST_F (ErkpaReconstruct, TakesTheNormalsOfAnObjFromItsFaces)
{
  std::string text = sphereRows (false, "v ");
  const auto points = fibonacciSphere ();
  for (auto p = points.rbegin (); p != points.rend (); ++p) // in another order than the vertices
    text += "vn " + std::to_string (p->x ()) + " " + std::to_string (p->y ()) + " " + std::to_string (p->z ()) + "\n";
  for (int i = 1; i <= 3000; ++i)
    text += "f " + std::to_string (i) + "//" + std::to_string (3001 - i) + " 1//3000 -3000/7/-1\n";
  write ("a.obj", text);
  ASSERT_EQ (runCoarse ("a.obj out.ply -report r.json").status, 0);
  expectSphere ("out.ply");
  EXPECT_EQ (nlohmann::json::parse (read ("r.json"))["points"]["without_normal"], 0);
}

TEST_F (ErkpaReconstruct, WritesEveryFormatSoThatPclReadsIt)
{
  for (const std::string name : {"out.ply", "out.vtk", "out.stl", "out.obj", "out.PLY"})
  {
    const Result result = runCoarse ("sphere.xyz " + name);
    ASSERT_EQ (result.status, 0) << result.err;
    if (name != "out.PLY") // PCL looks for lower case only
      expectSphere (name);
  }
}

TEST_F (ErkpaReconstruct, WritesUnitNormals)
{
  for (const std::string name : {"out.ply", "out.vtk", "out.obj"})
  {
    ASSERT_EQ (runCoarse ("sphere.xyz " + name).status, 0);
    for (const pcl::PointNormal &vertex : loadVertices<pcl::PointNormal> (name))
      ASSERT_NEAR (vertex.getNormalVector3fMap ().dot (vertex.getVector3fMap ()), 1.0, 0.02) << name;
  }
}

TEST_F (ErkpaReconstruct, CarriesColourOver)
{
  auto cloud = sphereCloud<pcl::PointXYZRGBNormal> ();
  for (pcl::PointXYZRGBNormal &point : cloud)
    point.r = 10, point.g = 150, point.b = point.z > 0.0f ? 255 : 0;
  pcl::io::savePCDFileASCII (path ("ascii.pcd"), cloud);
  pcl::io::savePCDFileBinaryCompressed (path ("compressed.pcd"), cloud);
  pcl::io::savePLYFileBinary (path ("a.ply"), cloud);
  for (const std::string input : {"ascii.pcd", "compressed.pcd", "a.ply"})
    for (const std::string output : {"out.ply", "out.vtk"})
    {
      ASSERT_EQ (runCoarse (input + " " + output).status, 0);
      for (const pcl::PointXYZRGB &vertex : loadVertices<pcl::PointXYZRGB> (output))
      {
        ASSERT_NEAR (vertex.r, 10, 1) << input << output;
        ASSERT_NEAR (vertex.g, 150, 1) << input << output;
        if (std::abs (vertex.z) > 0.5f)
        {
          ASSERT_NEAR (vertex.b, vertex.z > 0.0f ? 255 : 0, 1) << input << output;
        }
      }
    }
}

TEST_F (ErkpaReconstruct, ReadsColoursOfTextInBothScales)
{
  write ("bytes.off", "COFF\n3000 0 0\n" + sphereRows (false, "", " ", " 255 51 0 255"));
  write ("shares.off", "COFF\n3000 0 0\n" + sphereRows (false, "", " ", " 1.0 0.2 0.0"));
  write ("shares.obj", sphereRows (false, "v ", " ", " 1.0 0.2 0.0"));
  for (const std::string input : {"bytes.off", "shares.off", "shares.obj"})
  {
    ASSERT_EQ (runCoarse (input + " out.ply").status, 0);
    for (const pcl::PointXYZRGB &vertex : loadVertices<pcl::PointXYZRGB> ("out.ply"))
      ASSERT_EQ (vertex.getRGBVector3i (), Eigen::Vector3i (255, 51, 0)) << input;
  }
}

TEST_F (ErkpaReconstruct, TellsColoursFromNormalsInTablesOfText)
{
  std::string rows;
  for (const Eigen::Vector3d &p : fibonacciSphere ())
    rows += std::to_string (p.x ()) + " " + std::to_string (p.y ()) + " " + std::to_string (p.z ()) + " 200 7 0\n";
  write ("colours.xyz", rows);
  ASSERT_EQ (runCoarse ("colours.xyz colours.ply").status, 0);
  pcl::PointCloud<pcl::PointXYZRGBNormal> coloured;
  ASSERT_EQ (pcl::io::loadPLYFile (path ("colours.ply"), coloured), 0);
  for (const auto &point : coloured)
  {
    ASSERT_EQ (point.getRGBVector3i (), Eigen::Vector3i (200, 7, 0));
    ASSERT_GT (point.getNormalVector3fMap ().dot (point.getVector3fMap ()), 0.9f);
  }
}

TEST_F (ErkpaReconstruct, CarriesIntensityOver)
{
  auto cloud = sphereCloud<pcl::PointXYZINormal> ();
  for (pcl::PointXYZINormal &point : cloud)
    point.intensity = 7.5f + point.x;
  pcl::io::savePCDFileBinary (path ("a.pcd"), cloud);
  ASSERT_EQ (runCoarse ("a.pcd out.ply").status, 0);
  for (const pcl::PointXYZI &vertex : loadVertices<pcl::PointXYZI> ("out.ply"))
    ASSERT_NEAR (vertex.intensity, 7.5f + vertex.x, 0.1f);
}

TEST_F (ErkpaReconstruct, KeepsThePrecisionOfTheVerticesInText)
{
  for (const std::string name : {"out.ply", "out.obj"})
    ASSERT_EQ (runCoarse ("sphere.xyz " + name).status, 0);
  const auto exact = loadVertices<pcl::PointXYZ> ("out.ply");
  const auto text = loadVertices<pcl::PointXYZ> ("out.obj");
  ASSERT_EQ (exact.size (), text.size ());
  for (std::size_t i = 0; i < exact.size (); ++i)
    ASSERT_EQ (exact[i].getVector3fMap (), text[i].getVector3fMap ());
}

TEST_F (ErkpaReconstruct, TakesNormalsFromTheFacesOfFilesThatHaveNone)
{
  // Eight points are too few to estimate normals from; with those of the faces f is negative inside.
  const std::string corners = "-1 -1 -1\n1 -1 -1\n-1 1 -1\n1 1 -1\n-1 -1 1\n1 -1 1\n-1 1 1\n1 1 1\n";
  write ("cube.off",
         "OFF\n8 6 0\n" + corners + "4 0 2 3 1 0.5 0.5 0.5\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n");
  std::string vertices;
  std::istringstream rows (corners);
  for (std::string row; std::getline (rows, row);)
    vertices += "v " + row + "\n";
  write ("cube.obj", vertices + "f 1 3 4 2\nf 5/1 6/1 8/1 7/1\nf 1 2 6 5\nf 3 7 8 4\nf -8 -4 -2 -6\nf 2 4 8 6\n");
  write ("query.xyz", "0 0 0\n1.2 1.2 1.2\n");
  // faces that do not agree about the outside say nothing
  write ("mixed.off", "OFF\n3000 2 0\n" + sphereRows (false) + "3 0 1 2\n3 0 1 3\n");
  const Result mixed = runCoarse ("mixed.off out.ply");
  EXPECT_NE (mixed.out.find ("estimated"), std::string::npos) << mixed.err;
  for (const std::string input : {"cube.off", "cube.obj"})
  {
    const Result result = run (input + " -constraint functional -radius 2.5 -order constant -evaluate query.xyz f.txt");
    ASSERT_EQ (result.status, 0) << result.err;
    EXPECT_NE (result.out.find ("from the faces"), std::string::npos) << input;
    std::istringstream values (read ("f.txt"));
    double x = 0.0, f[2] = {};
    for (double &value : f)
      ASSERT_TRUE (values >> x >> x >> x >> value >> x >> x >> x);
    EXPECT_LT (f[0], -1.0) << input;
    EXPECT_GT (f[1], 0.1) << input;
  }
}

} // namespace
