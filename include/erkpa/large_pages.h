// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <new>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief For programs whose work is reconstruction: memory is kept when it is freed, and comes in large pages.
 *
 * A reconstruction fills many arrays for a short time; the largest come in large pages in any case (LargeVector). This
 * does the same for the rest, such as the many small arrays of a pcl::PolygonMesh. Call it once, first thing in main():
 * it sets malloc of the whole process, which is why the library does not by itself. Meshes are the same. Needs Linux
 * with the GNU C library and transparent huge pages ("madvise" or "always" in
 * /sys/kernel/mm/transparent_hugepage/enabled); elsewhere it does nothing.
 * \param[in] bytes memory that is to come in large pages, up to a gigabyte; only what is used of it is taken
 * \return whether the system agreed
 */
bool
preferLargePages (std::size_t bytes = std::size_t (1) << 29);

/** \brief While there is one, memory that a LargeVector gives up is kept for the next one of the process.
 *
 * Every reconstruction has one. A program that reconstructs again and again may hold one all the time: the memory of
 * one reconstruction, some 200 bytes a triangle, then serves the next.
 */
class LargePageKeeper
{
public:
  LargePageKeeper ();
  ~LargePageKeeper ();
  LargePageKeeper (const LargePageKeeper &) = delete;
  LargePageKeeper &
  operator= (const LargePageKeeper &) = delete;
};

/** \brief Memory, much of which comes in large pages where the system has them.
 * \throw std::bad_alloc where there is none
 */
void *
allocateLarge (std::size_t bytes);

/** \param[in] bytes as they were asked for */
void
freeLarge (void *memory, std::size_t bytes) noexcept;

/** \brief Ask for large pages where memory that is not filled yet spans some; nothing happens where it does not. */
void
adviseLargePages (void *memory, std::size_t bytes) noexcept;

/** \brief Reserve an array of another allocator, with large pages if it is large. */
template <typename VectorT>
void
reserveLarge (std::size_t count, VectorT &array)
{
  array.reserve (count);
  adviseLargePages (array.data (), array.capacity () * sizeof (typename VectorT::value_type));
}

/** \brief Allocator for arrays that may become large.
 *
 * An array that is filled for the first time stops once per page for the system to give it. With pages of 4 KB that
 * took half the time of a reconstruction where a hypervisor has a say in it. For the same reason elements that come
 * without a value, as by resize (n), are not set to zero: the threads that fill them in get the pages.
 */
template <typename T>
struct LargePageAllocator
{
  using value_type = T;

  LargePageAllocator () = default;

  template <typename OtherT>
  LargePageAllocator (const LargePageAllocator<OtherT> &) noexcept
  {
  }

  T *
  allocate (std::size_t count)
  {
    static_assert (alignof (T) <= alignof (std::max_align_t), "malloc aligns no more");
    if (count > std::numeric_limits<std::size_t>::max () / sizeof (T))
      throw std::bad_alloc ();
    return static_cast<T *> (allocateLarge (count * sizeof (T)));
  }

  void
  deallocate (T *memory, std::size_t count) noexcept
  {
    freeLarge (memory, count * sizeof (T));
  }

  template <typename U, typename... Args>
  void
  construct (U *element, Args &&...args)
  {
    if constexpr (sizeof...(Args) == 0)
      ::new (static_cast<void *> (element)) U;
    else
      ::new (static_cast<void *> (element)) U (std::forward<Args> (args)...);
  }

  template <typename OtherT>
  bool
  operator== (const LargePageAllocator<OtherT> &) const
  {
    return true;
  }

  template <typename OtherT>
  bool
  operator!= (const LargePageAllocator<OtherT> &) const
  {
    return false;
  }
};

/** \brief A std::vector that may become large. resize (n) leaves new numbers unset, resize (n, value) sets them. */
template <typename T>
using LargeVector = std::vector<T, LargePageAllocator<T>>;

} // namespace erkpa
