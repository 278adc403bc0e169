// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/sharp_surface.h>
#include <erkpa/status.h>

#include <string>
#include <vector>

namespace erkpa
{

/** \brief Sharp surfaces as JSON, to look at, to edit, and to load again exactly as they were.
 *
 * \code{.json}
 * {
 *   "format": "erkpa sharp surfaces",
 *   "version": 1,
 *   "faces": [
 *     {"type": "plane", "normal": [0, 0, 1], "offset": -0.5},
 *     {"type": "cylinder", "point": [0, 0, 0], "axis": [0, 0, 1], "radius": 0.5},
 *     {"type": "points", "origin": [0, 0, 0], "k": 20, "points": [[x, y, z, nx, ny, nz], ...]}
 *   ],
 *   "surfaces": [
 *     {"type": "between", "face": 0, "other": 1},
 *     {"type": "sphere", "center": [0, 0, 0], "radius": 1, "extents": [{"type": "box", "low": [0, 0, 0], "high": [1, 1,
 * 1], "fade": 0.1}]}
 *   ]
 * }
 * \endcode
 *
 * What a "type" has, beside "extents", all in the frame and unit of length of the cloud:
 *   - plane: "normal" [x, y, z] and "offset", for normal·x + offset = 0
 *   - sphere: "center" and "radius"
 *   - cylinder: "point" on the axis, "axis", its direction, and "radius"
 *   - cone: "apex", "axis", its direction, and "angle" between axis and side in radians
 *   - points: a face of points: "origin", "k" (0 = chosen from the noise) and "points", each with its position relative
 *     to the origin and its normal
 *   - between: "face" and "other", where two faces meet
 *   - reversed: "face", one of the faces with its other side outside: a plane, or the wall of a hole
 *   - face: "face", a surface that is one of the faces
 *
 * "face" and "other" are places in "faces", counted from 0; a face may refer to those before it. Faces that surfaces
 * share are shared again when loaded. "extents" (may be absent) limit a surface one within the other; each may have
 * "fade" (absent or 0 = automatic, see makeLimited ()):
 *   - box: "low" and "high", its corners
 *   - polygon: "vertices", a list of [x, y, z] in order, and "thickness" (absent or 0 = any distance)
 *   - points: "points", a list of [x, y, z], and "radius"
 *
 * Directions need not have unit length. Words that are not listed here are refused, lest a misspelt one go unseen.
 *
 * \param[in] surfaces any but functions, warped ones and classes of the caller's own, which no numbers describe
 * \param[out] text untouched on error
 * \return Status::INVALID_SETTING with the place of the surface in the list, and why it cannot be written
 */
Outcome
writeSharpSurfaces (const std::vector<SharpSurface::ConstPtr> &surfaces, std::string &text);

/** \brief Sharp surfaces from such text.
 * \param[out] surfaces untouched on error
 * \return Status::INVALID_SETTING with the line or the place in the text, what is wrong there, and what to do
 */
Outcome
readSharpSurfaces (const std::string &text, std::vector<SharpSurface::ConstPtr> &surfaces);

/** \brief writeSharpSurfaces () into a file. It appears whole or not at all: on error an older one stays as it is.
 * \return Status::INVALID_SETTING for surfaces that cannot be written and for a path that cannot, with its name
 */
Outcome
saveSharpSurfaces (const std::string &path, const std::vector<SharpSurface::ConstPtr> &surfaces);

/** \brief readSharpSurfaces () from a file.
 * \return Status::INVALID_SETTING, with the name of the file, where it cannot be read or holds something else
 */
Outcome
loadSharpSurfaces (const std::string &path, std::vector<SharpSurface::ConstPtr> &surfaces);

} // namespace erkpa
