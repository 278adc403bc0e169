// SPDX-License-Identifier: BSD-3-Clause
//
// What erkpa_reconstruct takes and writes about sharp edges, on clouds of a box.
#include "erkpa_reconstruct_test.h"

#include "shapes.h"

#include <erkpa/sharp_surface_io.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <iomanip>
#include <sstream>

namespace
{

const Eigen::Vector3d HALF (1.0, 0.7, 0.5);
constexpr double EDGES = 4.0 * 2.0 * (1.0 + 0.7 + 0.5); // their length

/** \brief The program in a directory that holds a box as box.xyz. */
class SharpEdgeOptions : public ErkpaReconstruct
{
protected:
  SharpEdgeOptions ()
  {
    std::ostringstream rows;
    const shapes::Samples box = shapes::box (6000, HALF);
    rows << std::setprecision (9);
    for (std::size_t i = 0; i < box.size (); ++i)
      rows << box.positions[i].transpose () << " " << box.normals[i].transpose () << "\n";
    write ("box.xyz", rows.str ());
  }

  nlohmann::json
  report () const
  {
    return nlohmann::json::parse (read ("r.json"));
  }
};

/** \brief The lines that a file of creases holds. */
struct Lines
{
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<std::size_t>> lines;
  std::vector<int> surfaces;

  double
  length () const
  {
    double sum = 0.0;
    for (const auto &line : lines)
      for (std::size_t i = 0; i + 1 < line.size (); ++i)
        sum += (points.at (line[i + 1]) - points.at (line[i])).norm ();
    return sum;
  }
};

void
readPoints (std::istream &file, std::size_t count, Lines &lines)
{
  lines.points.resize (count);
  for (Eigen::Vector3d &p : lines.points)
    file >> p[0] >> p[1] >> p[2];
}

Lines
readVtk (const std::string &text)
{
  Lines lines;
  std::istringstream file (text);
  std::string word;
  std::size_t count = 0;
  while (file >> word && word != "POINTS")
    ;
  file >> count >> word;
  readPoints (file, count, lines);
  file >> word >> count >> word;
  lines.lines.resize (count);
  for (auto &line : lines.lines)
  {
    file >> count;
    line.resize (count);
    for (std::size_t &point : line)
      file >> point;
  }
  while (file >> word && word != "default")
    ;
  for (int surface = 0; file >> surface;)
    lines.surfaces.push_back (surface);
  return lines;
}

Lines
readPly (const std::string &text)
{
  Lines lines;
  std::istringstream file (text);
  std::string word;
  std::size_t points = 0, edges = 0;
  while (file >> word && word != "end_header")
    if (word == "vertex")
      file >> points;
    else if (word == "edge")
      file >> edges;
  readPoints (file, points, lines);
  lines.lines.assign (edges, std::vector<std::size_t> (2));
  lines.surfaces.resize (edges);
  for (std::size_t i = 0; i < edges; ++i)
    file >> lines.lines[i][0] >> lines.lines[i][1] >> lines.surfaces[i];
  return lines;
}

} // namespace

TEST_F (SharpEdgeOptions, FindSharpEdgesAndSayHowMany)
{
  const Result result = run ("box.xyz out.ply -sharp_auto -report r.json");
  ASSERT_EQ (result.status, 0) << result.err;
  const nlohmann::json sharp = report ()["sharp_edges"];
  EXPECT_EQ (sharp["given"], 0);
  EXPECT_GE (sharp["found"], 12);
  EXPECT_GE (sharp["creases"], 12);
  EXPECT_EQ (sharp["corners"], 8);
  EXPECT_NEAR (sharp["crease_length"].get<double> (), EDGES, 0.01 * EDGES);
  EXPECT_EQ (sharp["normals_sharpened"], false);
  EXPECT_EQ (sharp["normals_smoothed"], false);
  EXPECT_GT (report ()["seconds"]["sharp"], 0.0);
  for (const std::string &words : {"found " + std::to_string (sharp["found"].get<int> ()) + " sharp edges\n",
                                   std::to_string (sharp["creases"].get<int> ()) + " creases, 8 corners\n"})
    EXPECT_NE (result.out.find (words), std::string::npos) << result.out;
}

TEST_F (SharpEdgeOptions, SaveWhatWasFoundAndLoadItForTheSameMesh)
{
  ASSERT_EQ (run ("box.xyz found.ply -sharp_auto -save_sharp_edges edges.json").status, 0);
  const Result result = run ("box.xyz loaded.ply -sharp_edges edges.json -save_sharp_edges again.json -report r.json");
  ASSERT_EQ (result.status, 0) << result.err;
  EXPECT_EQ (result.out.find ("found"), std::string::npos) << result.out;
  EXPECT_EQ (read ("found.ply"), read ("loaded.ply"));
  EXPECT_EQ (read ("edges.json"), read ("again.json"));
  EXPECT_EQ (report ()["sharp_edges"]["found"], 0);
  EXPECT_GE (report ()["sharp_edges"]["given"], 12);
}

TEST_F (SharpEdgeOptions, SaveGivenSharpEdgesWithoutAMeshToo)
{
  write ("query.xyz", "0 0 0.5\n");
  ASSERT_EQ (run ("box.xyz -evaluate query.xyz values.txt -sharp 1,0,-1,-0.5 -save_sharp_edges edges.json").status, 0);
  std::vector<erkpa::SharpSurface::ConstPtr> surfaces;
  ASSERT_TRUE (erkpa::loadSharpSurfaces (path ("edges.json"), surfaces).ok ());
  ASSERT_EQ (surfaces.size (), 1u);
  EXPECT_NEAR (surfaces[0]->theta ({1.0, 0.3, 0.5}), 0.0, 1e-6);
}

TEST_F (SharpEdgeOptions, MakeTheEdgesBetweenFacesSharp)
{
  const std::string faces = "-face 1,0,0,-1 -face 1,0,0,1 -face 0,-2,0,1.4 -face 0,1,0,0.7 -face=0,0,1,-0.5 "
                            "-face 0,0,1,0.5 -face_tolerance 0.01";
  ASSERT_EQ (run ("box.xyz out.ply -report r.json " + faces).status, 0);
  const nlohmann::json sharp = report ()["sharp_edges"];
  EXPECT_EQ (sharp["found"], 12);
  EXPECT_EQ (sharp["corners"], 8);
}

TEST_F (SharpEdgeOptions, WriteCreasesAsLinesInBothFormats)
{
  ASSERT_EQ (run ("box.xyz out.ply -sharp_auto -creases lines.vtk -report r.json").status, 0);
  ASSERT_EQ (run ("box.xyz out.ply -sharp_auto -creases lines.PLY").status, 0);
  const nlohmann::json sharp = report ()["sharp_edges"];
  const Lines vtk = readVtk (read ("lines.vtk")), ply = readPly (read ("lines.PLY"));
  EXPECT_EQ (vtk.lines.size (), sharp["creases"]);
  EXPECT_EQ (vtk.surfaces.size (), vtk.lines.size ());
  EXPECT_EQ (ply.points.size (), vtk.points.size ());
  for (const Lines &lines : {vtk, ply})
  {
    EXPECT_NEAR (lines.length (), sharp["crease_length"].get<double> (), 1e-4);
    for (const int surface : lines.surfaces)
    {
      EXPECT_GE (surface, 0);
      EXPECT_LT (surface, sharp["found"].get<int> ());
    }
    for (const Eigen::Vector3d &p : lines.points) // on two faces at least
      EXPECT_GE (((p.cwiseAbs () - HALF).cwiseAbs ().array () < 1e-4).count (), 2);
  }
  pcl::PolygonMesh loaded;
  pcl::io::loadPolygonFileVTK (path ("lines.vtk"), loaded);
  EXPECT_EQ (loaded.cloud.width, vtk.points.size ()) << "as VTK reads it";
}

TEST_F (SharpEdgeOptions, WriteNoLinesWhereThereAreNoCreases)
{
  for (const std::string name : {"lines.vtk", "lines.ply"})
  {
    ASSERT_EQ (runCoarse ("sphere.xyz out.ply -creases " + name).status, 0);
    EXPECT_TRUE ((name == "lines.vtk" ? readVtk (read (name)) : readPly (read (name))).points.empty ());
  }
}

TEST_F (SharpEdgeOptions, SplitTheNormalsAtCreases)
{
  ASSERT_EQ (run ("box.xyz one.ply -sharp_auto").status, 0);
  ASSERT_EQ (run ("box.xyz two.ply -sharp_auto -split_normals -report r.json").status, 0);
  EXPECT_EQ (load ("one.ply").polygons.size (), load ("two.ply").polygons.size ());
  EXPECT_GT (load ("two.ply").cloud.width, load ("one.ply").cloud.width);
  EXPECT_EQ (load ("two.ply").cloud.width, report ()["mesh"]["vertices"]);
  EXPECT_EQ (report ()["mesh"]["euler"], 2) << "before they are split";
}

TEST_F (SharpEdgeOptions, RefuseBadFilesWithOneLine)
{
  write ("bad.json", "{\n\n]");
  expectRefuses ("box.xyz out.ply -sharp_edges none.json", "none.json");
  expectRefuses ("box.xyz out.ply -sharp_edges bad.json", "bad.json");
  expectRefuses ("box.xyz out.ply -creases lines.txt", ".vtk");
  expectRefuses ("box.xyz out.ply -creases no/lines.vtk", "no/lines.vtk");
  expectRefuses ("box.xyz out.ply -save_sharp_edges no/edges.json", "no/edges.json");
  expectRefuses ("box.xyz -evaluate box.xyz v.txt -creases lines.vtk", "OUTPUT");
  expectRefuses ("box.xyz out.ply -creases out.ply", "same file");
  expectRefuses ("box.xyz out.ply -report r.json -save_sharp_edges r.json", "same file");
  expectRefuses ("box.xyz out.ply -sharp_edges bad.json -save_sharp_edges bad.json", "bad.json");
  expectRefuses ("box.xyz out.ply -save_sharp_edges box.xyz", "write over");
  write ("edges.json", "precious");
  expectRefuses ("box.xyz out.ply -sharp_auto -save_sharp_edges edges.json -creases /dev/full.vtk", "/dev/full.vtk");
  EXPECT_EQ (read ("edges.json"), "precious");
}
