// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sphere.h"

#include <gtest/gtest.h>
#include <pcl/io/ply_io.h>
#include <pcl/io/vtk_lib_io.h>

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

/** \brief A directory of its own for a test, and the program run in it. */
class ToolRun : public testing::Test
{
protected:
  struct Result
  {
    int status = -1;
    std::string out, err;

    std::ptrdiff_t
    errorLines () const
    {
      return std::count (err.begin (), err.end (), '\n');
    }
  };

  ToolRun ()
  {
    std::string name = (std::filesystem::temp_directory_path () / "erkpa_XXXXXX").string ();
    directory_ = mkdtemp (name.data ());
  }

  ~ToolRun () override
  {
    std::filesystem::remove_all (directory_);
  }

  std::string
  path (const std::string &name) const
  {
    return (directory_ / name).string ();
  }

  bool
  exists (const std::string &name) const
  {
    return std::filesystem::exists (path (name));
  }

  void
  write (const std::string &name, const std::string &bytes) const
  {
    std::ofstream (path (name), std::ios::binary) << bytes;
  }

  std::string
  read (const std::string &name) const
  {
    std::ifstream file (path (name), std::ios::binary);
    return {std::istreambuf_iterator<char> (file), std::istreambuf_iterator<char> ()};
  }

  /** \brief The names of all files in the directory. */
  std::vector<std::string>
  files () const
  {
    std::vector<std::string> names;
    for (const auto &entry : std::filesystem::directory_iterator (directory_))
      names.push_back (entry.path ().filename ().string ());
    std::sort (names.begin (), names.end ());
    return names;
  }

  /** \brief Runs the program in the directory.
   * \param[in] arguments as a shell would take them
   * \param[in] before shell commands to run first, such as "ulimit -f 1;"
   */
  Result
  run (const std::string &arguments, const std::string &before = "") const
  {
    const std::string command = "cd " + directory_.string () + "; " + before + " exec " ERKPA_RECONSTRUCT_PATH " " +
                                arguments + " >" + path (".out") + " 2>" + path (".err") + " </dev/null";
    const int status = std::system (("sh -c '" + command + "'").c_str ());
    Result result;
    result.status = WIFEXITED (status) ? WEXITSTATUS (status) : -1;
    result.out = read (".out");
    result.err = read (".err");
    std::filesystem::remove (path (".out"));
    std::filesystem::remove (path (".err"));
    return result;
  }

private:
  std::filesystem::path directory_;
};

/** \brief The program in a directory that holds the sphere as sphere.xyz. */
class ErkpaReconstruct : public ToolRun
{
protected:
  ErkpaReconstruct ()
  {
    write ("sphere.xyz", sphereRows (true));
  }

  /** \brief A coarse grid will do. */
  Result
  runCoarse (const std::string &arguments) const
  {
    return run (arguments + " -resolution 30");
  }

  pcl::PolygonMesh
  load (const std::string &name) const
  {
    pcl::PolygonMesh mesh;
    if (std::filesystem::path (name).extension () == ".ply")
      EXPECT_EQ (pcl::io::loadPLYFile (path (name), mesh), 0) << name;
    else
      EXPECT_GT (pcl::io::loadPolygonFile (path (name), mesh), 0) << name; // by VTK
    return mesh;
  }

  template <typename PointT>
  pcl::PointCloud<PointT>
  loadVertices (const std::string &name) const
  {
    pcl::PointCloud<PointT> vertices;
    pcl::fromPCLPointCloud2 (load (name).cloud, vertices);
    return vertices;
  }

  void
  expectSphere (const std::string &name, double radius = 1.0) const
  {
    const double expected = SPHERE_VOLUME * radius * radius * radius;
    EXPECT_NEAR (volumeOf (load (name)), expected, 0.02 * expected) << name;
  }

  /** \brief The program makes the sphere of this input. */
  void
  expectReads (const std::string &input) const
  {
    const Result result = runCoarse (input + " out.ply");
    ASSERT_EQ (result.status, 0) << input << ": " << result.err;
    EXPECT_EQ (result.err, "") << input;
    expectSphere ("out.ply");
    std::filesystem::remove (path ("out.ply"));
  }

  /** \brief The program fails with one line that holds \a words, and leaves the directory as it was. */
  void
  expectRefuses (const std::string &arguments, const std::string &words, const std::string &before = "") const
  {
    const std::vector<std::string> untouched = files ();
    const Result result = run (arguments, before);
    EXPECT_GT (result.status, 0) << arguments;
    EXPECT_EQ (result.errorLines (), 1) << arguments << "\n" << result.err;
    EXPECT_NE (result.err.find (words), std::string::npos) << arguments << "\n" << result.err;
    EXPECT_EQ (files (), untouched) << arguments;
  }
};
