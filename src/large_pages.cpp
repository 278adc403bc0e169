// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/large_pages.h>

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <climits>
#include <cstdint>
#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace erkpa
{

namespace
{

constexpr std::size_t PAGE = std::size_t (1) << 21;

/** \brief For the whole pages in a piece of memory; false where there are none, or the system has none. */
bool
useLargePages (void *memory, std::size_t bytes)
{
#if defined(MADV_HUGEPAGE) && !defined(__SANITIZE_ADDRESS__) // which has its own malloc
  const std::size_t offset = (PAGE - reinterpret_cast<std::uintptr_t> (memory) % PAGE) % PAGE; // to where one begins
  return bytes >= offset + PAGE &&
         madvise (static_cast<char *> (memory) + offset, (bytes - offset) / PAGE * PAGE, MADV_HUGEPAGE) == 0;
#else
  static_cast<void> (memory);
  static_cast<void> (bytes);
  return false;
#endif
}

} // namespace

bool
preferLargePages (std::size_t bytes)
{
#if defined(__GLIBC__)
  if (bytes < 2 * PAGE || bytes > (std::size_t (1) << 30) || mallopt (M_MMAP_THRESHOLD, INT_MAX) == 0 ||
      mallopt (M_TRIM_THRESHOLD, INT_MAX) == 0)
    return false;
  // The end of the heap: what is freed there is kept, and handed out again piece by piece.
  void *heap = std::malloc (bytes);
  if (heap == nullptr)
    return false;
  const bool agreed = useLargePages (heap, bytes);
  std::free (heap);
  return agreed;
#else
  static_cast<void> (bytes);
  return false;
#endif
}

void *
allocateLarge (std::size_t bytes)
{
  const bool is_large = bytes >= PAGE / 4;
  if (is_large && bytes < std::numeric_limits<std::size_t>::max () - PAGE)
    bytes = (bytes + PAGE - 1) / PAGE * PAGE;
  void *memory = is_large ? std::aligned_alloc (PAGE, bytes) : std::malloc (bytes);
  if (memory == nullptr && bytes > 0)
    throw std::bad_alloc ();
  if (is_large)
    useLargePages (memory, bytes);
  return memory;
}

void
adviseLargePages (void *memory, std::size_t bytes) noexcept
{
  useLargePages (memory, bytes);
}

void
freeLarge (void *memory) noexcept
{
  std::free (memory);
}

} // namespace erkpa
