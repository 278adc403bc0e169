// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <pcl/PCLPointCloud2.h>

#include <optional>
#include <string>
#include <string_view>

namespace erkpa::tool
{

/** \brief The points of a file, with the types of the file. */
struct RawCloud
{
  pcl::PCLPointCloud2 cloud;                 ///< at least x, y, z
  std::optional<Eigen::Vector3d> view_point; ///< where the sensor stood, if the file says so
  bool has_face_normals = false;             ///< the file has no normals: those here are from its faces
};

/** \brief Reads a .pcd, .ply, .xyz, .xyzn, .pwn, .obj or .off file.
 *
 * PCL's own readers are not used: they take "foo" for a number and a short row for zeros, do not know the
 * line, fall over a .pcd without header, and live in pcl_io, which loads VTK before main. Throws a ToolError
 * that names the file and, where it is text, the line.
 */
RawCloud
readCloud (const std::string &path);

/** \brief Whether readCloud knows the format; tells a typing error before any work. */
bool
isReadable (const std::string &path);

/** \brief The formats that can be read, for messages. */
std::string
readableFormats ();

// The formats, each from the bytes of a file; path is for errors.

RawCloud
readPcd (std::string_view bytes, const std::string &path);

RawCloud
readPly (std::string_view bytes, const std::string &path);

RawCloud
readXyz (std::string_view bytes, const std::string &path);

RawCloud
readPwn (std::string_view bytes, const std::string &path);

RawCloud
readObj (std::string_view bytes, const std::string &path);

RawCloud
readOff (std::string_view bytes, const std::string &path);

} // namespace erkpa::tool
