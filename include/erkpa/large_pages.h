// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace erkpa
{

/** \brief For programs whose work is reconstruction: memory is kept when it is freed, and comes in large pages.
 *
 * A reconstruction fills many arrays for a short time. Taking each from the system, page by page, and giving it back
 * is a quarter of the time. Call this once, first thing in main(): it sets malloc of the whole process, which is why
 * the library does not by itself. Meshes are the same. Needs Linux with the GNU C library and transparent huge pages
 * ("madvise" or "always" in /sys/kernel/mm/transparent_hugepage/enabled); elsewhere it does nothing.
 * \param[in] bytes memory that is to come in large pages, up to a gigabyte; only what is used of it is taken
 * \return whether the system agreed
 */
bool
preferLargePages (std::size_t bytes = std::size_t (1) << 29);

} // namespace erkpa
