// SPDX-License-Identifier: BSD-3-Clause
#include "spatial_order.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace erkpa
{

namespace
{

/** \brief The values that all points have of one kind, \a count per point, or none. */
template <typename T>
void
reorder (const std::uint32_t *order, std::size_t size, std::size_t count, std::vector<T> &values)
{
  if (values.empty ())
    return;
  std::vector<T> ordered (values.size ());
  for (std::size_t i = 0; i < size; ++i)
    std::copy_n (values.begin () + static_cast<std::ptrdiff_t> (count * order[i]), count,
                 ordered.begin () + static_cast<std::ptrdiff_t> (count * i));
  values.swap (ordered);
}

} // namespace

void
reorder (const std::uint32_t *order, OrientedPoints &points)
{
  const std::size_t size = points.size ();
  reorder (order, size, 1, points.positions);
  reorder (order, size, 1, points.normals);
  reorder (order, size, static_cast<std::size_t> (points.channels), points.attributes);
  reorder (order, size, 1, points.confidences);
  reorder (order, size, 1, points.radii);
  reorder (order, size, 1, points.shapes);
}

} // namespace erkpa
