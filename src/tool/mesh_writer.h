// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "output_file.h"

#include <pcl/PolygonMesh.h>

#include <string>

namespace erkpa::tool
{

/** \brief Writes a mesh to a file in the format that the end of its name asks for: .ply (binary), .vtk
 * (legacy, binary), .stl (binary) or .obj. The file is closed, not yet committed.
 *
 * PCL's own writers are not used: on a full disk all but .stl report success, .vtk and .obj keep five digits
 * (in UTM coordinates: metres), .vtk has no normals, and they live in pcl_io, which loads VTK before main.
 * \param[in] mesh triangles over FLOAT32 x y z, and normal_x/y/z, rgb, intensity where there are
 */
void
writeMesh (const pcl::PolygonMesh &mesh, const std::string &path, OutputFile &file);

/** \brief Whether writeMesh knows the format. */
bool
isWritable (const std::string &path);

/** \brief The formats that can be written, for messages. */
std::string
writableFormats ();

} // namespace erkpa::tool
