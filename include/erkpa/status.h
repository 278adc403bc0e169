// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace erkpa
{

/** \brief How a reconstruction ended. */
enum class Status
{
  OK,              ///< a surface was made
  NO_INPUT,        ///< no input cloud was set
  BAD_CLOUD,       ///< the fields of the cloud do not fit its memory
  BAD_INDICES,     ///< an index points outside the cloud
  TOO_FEW_POINTS,  ///< fewer distinct, finite points than a fit needs
  INVALID_SETTING, ///< a setting has a value that makes no sense
  NO_NORMALS,      ///< normals are missing and could not be estimated
  GRID_TOO_FINE,   ///< the voxel is too small for the extent of the cloud
  NO_SURFACE,      ///< the field has no zero set at the data
  NOT_CONVERGED,   ///< the values that make the field interpolate were not found
  INTERNAL_ERROR   ///< something below us failed (out of memory, a library's exception)
};

/** \brief A status with the sentence that explains it: which input or setting, and what to do. */
struct Outcome
{
  Status status = Status::OK;
  std::string message; ///< empty when status is OK

  bool
  ok () const
  {
    return status == Status::OK;
  }
};

} // namespace erkpa
