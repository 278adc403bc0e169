// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/reconstruction.h>

namespace erkpa
{

/** \brief Which edges are taken out of force around a flap. */
enum class FlapEdges
{
  OF_FACE,     ///< those of the face that makes it
  ALL,         ///< all there
  SMALL_WHOLLY ///< and those of small faces everywhere
};

/** \brief Take sharp edges that were found out of force where a face runs on past them into empty space.
 *
 * There the mesh leaves the points, or has a border, though the surface without the edges does not.
 * \param[in] options with which field and mesh were made
 * \param[in,out] report of that; its sharp surfaces are what is left of them
 * \param[in,out] field that of the mesh; made anew with what is left
 * \return false where there is nothing to mend
 */
bool
mendFlaps (const Options &options, const TriangleMesh &mesh, FlapEdges which, Report &report,
           ImplicitField::ConstPtr &field);

} // namespace erkpa
