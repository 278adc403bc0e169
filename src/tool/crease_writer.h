// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "output_file.h"

#include <erkpa/triangle_mesh.h>

#include <string>
#include <vector>

namespace erkpa::tool
{

/** \brief Writes the creases of a mesh as lines, in the format that the end of the file's name asks for, as text.
 *
 * .vtk (legacy): polylines, each with the number "surface" of its sharp surface; pcl_viewer shows them beside the mesh.
 * .ply: the same as "vertex" and "edge" elements, each edge with its "surface". Both hold the vertices of the creases
 * alone. The file is closed, not yet committed.
 * \param[in] creases lines over the vertices of \a mesh
 */
void
writeCreases (const TriangleMesh &mesh, const std::vector<Crease> &creases, const std::string &path, OutputFile &file);

/** \brief Whether writeCreases knows the format. */
bool
isWritableForCreases (const std::string &path);

/** \brief The formats that can be written, for messages. */
std::string
writableCreaseFormats ();

/** \brief How long the creases of a mesh are, all together. */
double
lengthOf (const TriangleMesh &mesh, const std::vector<Crease> &creases);

} // namespace erkpa::tool
