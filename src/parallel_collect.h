// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "threads.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief The elements of all parts, one part after the other; the parts are given up.
 * \param[in] spare memory for what will be appended, as a share of them
 */
template <typename VectorT>
VectorT
joinParts (std::vector<VectorT> &&parts, int threads, double spare = 0.0)
{
  std::vector<std::size_t> firsts (parts.size () + 1, 0);
  for (std::size_t i = 0; i < parts.size (); ++i)
    firsts[i + 1] = firsts[i] + parts[i].size ();
  VectorT joined;
  joined.reserve (firsts.back () + static_cast<std::size_t> (spare * static_cast<double> (firsts.back ())));
  joined.resize (firsts.back ());
  parallelFor (
      parts.size (), threads, [] { return 0; },
      [&] (int, std::size_t i)
      {
        std::move (parts[i].begin (), parts[i].end (), joined.begin () + static_cast<std::ptrdiff_t> (firsts[i]));
        VectorT ().swap (parts[i]);
      });
  return joined;
}

/** \brief Joins what work (first, last, part) appends to its part for each stretch of 0 .. count - 1, in their order.
 * \param[in] stretch items of one part
 */
template <typename VectorT, typename WorkT>
VectorT
parallelCollect (std::size_t count, int threads, WorkT work, std::size_t stretch = 16384)
{
  std::vector<VectorT> parts ((count + stretch - 1) / stretch);
  parallelFor (
      parts.size (), threads, [] { return 0; },
      [&] (int, std::size_t i) { work (i * stretch, std::min (count, (i + 1) * stretch), parts[i]); });
  return joinParts (std::move (parts), threads);
}

} // namespace erkpa
