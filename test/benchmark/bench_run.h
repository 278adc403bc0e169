// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>

namespace bench
{

using Json = nlohmann::ordered_json;

/** \brief Whether there is a pcl::Poisson to compare with. */
bool
hasPoisson ();

/** \brief What a single measurement is of. */
struct Run
{
  std::string shape;
  std::size_t points = 0;
  int threads = 1;
  int poisson_depth = 0; ///< 0: ERKPA is measured, else pcl::Poisson with this depth
};

/** \brief Reconstructs a shape in a process of its own, from the cloud to the pcl::PolygonMesh.
 *
 * Must be called before the calling process has started threads. \return what was measured: of "seconds" the "total" as
 * a clock on the wall shows it and the stages, "cpu_seconds" of all threads together, "peak_mb" of the process with the
 * cloud in it, "triangles" and more; or "error", a sentence.
 */
Json
measure (const Run &run);

} // namespace bench
