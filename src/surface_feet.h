// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <erkpa/implicit_field.h>
#include <erkpa/marching_cubes.h>

#include <Eigen/Core>

#include <vector>

namespace erkpa
{

class MomentLattice;

/** \brief Move points to their feet on the surface f = iso_level by Newton steps; none goes farther than its support.
 * \param[in] lattice see BlockField
 * \param[in,out] points neighbours follow each other, or nearly; local frame
 * \return per point whether it has a foot, which is where the point then is
 */
std::vector<char>
findFeet (const ImplicitField &field, const PolygonizerOptions &options, double voxel, const MomentLattice *lattice,
          std::vector<Eigen::Vector3d> &points, PolygonizerReport &report);

} // namespace erkpa
