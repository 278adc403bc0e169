// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "paper_models.h"

#include <erkpa/reconstruction.h>

namespace paper
{

enum class Method
{
  FUNCTIONAL, ///< the paper's: functional constraints, linear, its kernel, no normals in the fit
  HERMITE     ///< the library's default: values and normals, spherical
};

/** \brief A row as this machine makes it. */
struct Result
{
  erkpa::Outcome outcome;
  erkpa::Report report;
  double radius = 0.0;      ///< support radius chosen for the paper's number of nodes
  double seconds = 0.0;     ///< from the points to the mesh, as a clock on the wall shows them
  double cpu_seconds = 0.0; ///< of all threads together: what other programs take does not count
  double peak_mb = 0.0;     ///< most memory of the program meanwhile; 0 where the system does not tell
};

/** \brief Repeats a row of the table.
 *
 * Chooses the support radius and the voxel so that nodes per evaluation and triangles are the paper's, by
 * reconstructions that cost little; only the last one is measured.
 */
Result
runRow (const Row &row, const Model &model, Method method, int threads);

} // namespace paper
