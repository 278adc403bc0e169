// SPDX-License-Identifier: BSD-3-Clause
//
// What erkpa_reconstruct does not take, and how it says so.
#include "erkpa_reconstruct_test.h"

#include <utility>

namespace
{

TEST_F (ErkpaReconstruct, RefusesBadUseWithOneLine)
{
  expectRefuses ("", "INPUT OUTPUT");
  expectRefuses ("sphere.xyz", "INPUT OUTPUT");
  expectRefuses ("sphere.xyz out.ply third.ply", "third.ply");
  expectRefuses ("sphere.xyz out.ply -bogus", "-bogus");
  expectRefuses ("sphere.xyz out.ply --bogus=3", "--bogus");
  expectRefuses ("sphere.xyz out.ply -thread 3", "-thread");
  expectRefuses ("missing.xyz out.ply", "missing.xyz");
  expectRefuses ("sphere.txt out.ply", ".xyz");
  expectRefuses ("sphere.xyz out.txt", ".ply");
  expectRefuses ("sphere.xyz no/such/directory/out.ply", "no/such/directory");
  expectRefuses ("sphere.xyz out.ply -report no/r.json", "no/r.json");
  expectRefuses ("sphere.xyz out.ply -evaluate sphere.xyz no/v.txt", "no/v.txt");
  expectRefuses ("sphere.xyz out.ply -evaluate missing.xyz v.txt", "missing.xyz");
  expectRefuses ("sphere.xyz out.ply -evaluate sphere.xyz", "evaluate");
  expectRefuses ("sphere.xyz out.ply -voxel 0.1 -resolution 30", "-voxel");
  expectRefuses ("sphere.xyz out.ply -k 20 -radius 0.3", "-radius");
  expectRefuses ("sphere.xyz out.ply -radius 0.2 -radius_ramp x,0.1,0.2", "-radius_ramp");
  expectRefuses ("sphere.xyz out.ply -radius_field reach -k 20", "-radius_field");
  expectRefuses ("sphere.xyz out.ply -radius_field reach", "no field reach");
  expectRefuses ("sphere.xyz out.ply -confidence_field trust", "no field trust");
  expectRefuses ("sphere.xyz out.ply -radius_field nz", "radius"); // some are negative
  expectRefuses ("sphere.xyz out.ply -enrichment jump -sharp 1,0,0,0", "functional");
  expectRefuses ("sphere.xyz out.ply -kernel singular -interpolate collocation", "singular");
  expectRefuses ("sphere.xyz out.ply -report out.ply", "same file");
  expectRefuses ("sphere.xyz -evaluate sphere.xyz r.txt -report r.txt", "same file");
  expectRefuses ("sphere.xyz -evaluate sphere.xyz sphere.xyz", "write over");
}

TEST_F (ErkpaReconstruct, RefusesNonsenseValuesWithOneLine)
{
  for (const std::string option : {"-k 3",
                                   "-k -5",
                                   "-k 20x",
                                   "-k 1e3",
                                   "-k 99999999999",
                                   "-radius -1",
                                   "-radius nan",
                                   "-radius inf",
                                   "-voxel -0.1",
                                   "-voxel 0,1",
                                   "-resolution -3",
                                   "-resolution 10.5",
                                   "-iso nan",
                                   "-iso 1mm",
                                   "-moment_tolerance fine",
                                   "-threads -1",
                                   "-threads two",
                                   "-order cubic",
                                   "-constraint none",
                                   "-viewpoint 1,2",
                                   "-viewpoint 1,2,nan",
                                   "-sharp 1,0,0",
                                   "-sharp 1,0,0,0,0",
                                   "-sharp 0,0,0,1",
                                   "-sharp 1,0,0,",
                                   "-sharp -",
                                   "-k",
                                   "-kernel box",
                                   "-interpolate yes",
                                   "-enrichment 2",
                                   "-radius_ramp w,1,2",
                                   "-radius_ramp x",
                                   "-radius_ramp x,1",
                                   "-flatten big",
                                   "-offset 1,2",
                                   "-sharp_sphere 0,0,0,-1",
                                   "-sharp_cylinder 0,0,0,0,0,0,1",
                                   "-sharp_cone 0,0,0,0,0,1,2",
                                   "-sharp_angle 4",
                                   "-sharp_angle 91",
                                   "-sharp_angle nan",
                                   "-sharp_angle sharp",
                                   "-face 0,0,0,1",
                                   "-face 1,0,0",
                                   "-face_tolerance -1"})
    expectRefuses ("sphere.xyz out.ply " + option, option.substr (0, option.find (' ')));
  expectRefuses ("sphere.xyz out.ply -flatten 0", "flatten");
  expectRefuses ("sphere.xyz out.ply -flatten 2", "flatten");
  expectRefuses ("sphere.xyz out.ply -moment_tolerance -0.1", "moments");
  expectRefuses ("sphere.xyz out.ply -moment_tolerance 1", "moments");
  expectRefuses ("sphere.xyz out.ply -offset 0 -constraint offsurface", "offset");
  expectRefuses ("sphere.xyz out.ply -radius_ramp x,0,1", "ramp");
}

TEST_F (ErkpaReconstruct, NamesFileAndLineOfBrokenText)
{
  const std::string rows = "0 0 0\n0 0 1\n0 1 0\n";
  const std::string pcd = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 4\nHEIGHT 1\nPOINTS 4\nDATA ascii\n";
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                          "property float z\nend_header\n";
  const auto expectBroken = [this] (const std::string &name, const std::string &bytes, const std::string &words)
  {
    write (name, bytes);
    expectRefuses (name + " out.ply", name + words);
  };
  expectBroken ("word.xyz", rows + "1 foo 1\n", ", line 4: ");
  expectBroken ("short.xyz", "# x y z\n" + rows + "1 2\n", ", line 5: ");
  expectBroken ("long.xyz", rows + "1 2 3 4\n", ", line 4: ");
  expectBroken ("four.xyz", "1 2 3 4\n", ", line 1: ");
  expectBroken ("early.pwn", "4\n" + rows, ", line 4: ");
  expectBroken ("early.off", "OFF\n4 0 0\n" + rows, ", line 5: ");
  expectBroken ("word.off", "OFF\n3 0 0\n0 0 x\n", ", line 3: ");
  expectBroken ("other.off", "4OFF\n3 0 0\n" + rows, ", line 1: ");
  expectBroken ("short.obj", "v 0 0 0\nv 1 2\n", ", line 2: ");
  expectBroken ("word.obj", "v 0 0 0\nv 1 2 z\n", ", line 2: ");
  expectBroken ("early.pcd", pcd + rows, ", line 10: ");
  expectBroken ("word.pcd", pcd + rows + "1 2 foo\n", ", line 11: ");
  expectBroken ("short.pcd", pcd + "0 0\n" + rows, ", line 8: ");
  expectBroken ("nothing_known.pcd", "hello\n", ", line 1: ");
  expectBroken ("early.ply", ply + rows, ", line 10: ");
  expectBroken ("word.ply", ply + rows + "1 2 foo\n", ", line 11: ");
  expectBroken ("long.ply", ply + "0 0 0 0\n" + rows, ", line 8: ");
  expectBroken ("nothing_known.ply", "hello\n", ", line 1: ");
}

TEST_F (ErkpaReconstruct, NamesTheFirstBrokenLineOfALongText)
{
  std::string text = "# x y z\n\n"; // of many rows, so that threads share them
  for (int row = 0; row < 9000; ++row)
    text += row == 5000 || row == 8000 ? "0 0 foo\n" : row % 100 == 0 ? "\n  # a remark\n0 0 1\n" : "0 1 0\n";
  write ("long.xyz", text);
  expectRefuses ("long.xyz out.ply", "long.xyz, line 5103: 'foo'"); // after 5,000 rows and 102 lines that hold none
}

TEST_F (ErkpaReconstruct, RefusesTextWithAHeaderThatAsksForTerabytesByItsFirstRow)
{
  std::string text = "FIELDS x y z u v w\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\nCOUNT 1 1 1 1000000 1000000 1000000\n"
                     "WIDTH 200000\nHEIGHT 1\nPOINTS 200000\nDATA ascii\n";
  for (int row = 0; row < 200000; ++row)
    text += "0 0 0 1\n";
  write ("wide.pcd", text);
  expectRefuses ("wide.pcd out.ply", "wide.pcd, line 9: ");
}

TEST_F (ErkpaReconstruct, NamesTheFileWithoutPointsOrBytes)
{
  const std::vector<std::pair<std::string, std::string>> broken = {
      {"empty.xyz", ""},
      {"comments.xyz", "# nothing\n"},
      {"empty.pwn", "0\n"},
      {"empty.off", "OFF\n0 0 0\n"},
      {"empty.obj", "o nothing\n"},
      {"empty.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 0\nHEIGHT 1\nPOINTS 0\nDATA binary\n"},
      {"empty.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
                    "end_header\n"},
      {"flat.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n"},
      {"early.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA binary\n012345678901"},
      {"endless.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 4000000000\nHEIGHT 4000000000\nDATA binary\n0123"},
      {"damaged.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA binary_compressed\n" +
                          std::string ("\3\0\0\0\14\0\0\0\377\377\377", 11)},
      {"early.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                    "property float z\nend_header\n012345678901"}};
  for (const auto &[name, bytes] : broken)
  {
    write (name, bytes);
    expectRefuses (name + " out.ply", name);
  }
  std::filesystem::create_directory (path ("directory.xyz"));
  expectRefuses ("directory.xyz out.ply", "directory.xyz");
  expectRefuses ("sphere.xyz directory.xyz/../directory.ply/out.ply", "directory.ply");
}

TEST_F (ErkpaReconstruct, LeavesAnExistingOutputUntouchedOnFailure)
{
  write ("out.ply", "precious");
  write ("r.json", "precious");
  write ("two.xyz", "0 0 0\n1 1 1\n");
  expectRefuses ("sphere.xyz out.ply -k 3", "-k");
  expectRefuses ("two.xyz out.ply -report r.json", "two.xyz");
  expectRefuses ("sphere.xyz out.ply -report r.json", "out.ply", "trap \"\" XFSZ; ulimit -f 1;");
  expectRefuses ("sphere.xyz out.ply -report /dev/full", "/dev/full");
  expectRefuses ("sphere.xyz out.ply -evaluate sphere.xyz /dev/full", "/dev/full");
  EXPECT_EQ (read ("out.ply"), "precious");
  EXPECT_EQ (read ("r.json"), "precious");
  ASSERT_EQ (runCoarse ("sphere.xyz out.ply -report r.json").status, 0);
  expectSphere ("out.ply");
}

} // namespace
