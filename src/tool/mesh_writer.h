// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "output_file.h"

#include <erkpa/triangle_mesh.h>

#include <string>

namespace erkpa::tool
{

/** \brief Writes a mesh to a file in the format that the end of its name asks for: .ply (binary), .vtk
 * (legacy, binary), .stl (binary) or .obj. The file is closed, not yet committed.
 *
 * PCL's own writers are not used: on a full disk all but .stl report success, .vtk and .obj keep five digits
 * (in UTM coordinates: metres), .vtk has no normals, and they live in pcl_io, which loads VTK before main.
 * \param[in] mesh with colours where it has three channels, with intensities where it has one
 * \param[in] threads that bring it into the form of the file; 0 = all processors
 */
void
writeMesh (const TriangleMesh &mesh, const std::string &path, int threads, OutputFile &file);

/** \brief Whether writeMesh knows the format. */
bool
isWritable (const std::string &path);

/** \brief The formats that can be written, for messages. */
std::string
writableFormats ();

} // namespace erkpa::tool
