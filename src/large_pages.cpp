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

bool
preferLargePages (std::size_t bytes)
{
#if defined(__GLIBC__) && defined(MADV_HUGEPAGE) && !defined(__SANITIZE_ADDRESS__) // which has its own malloc
  constexpr std::uintptr_t PAGE = std::uintptr_t (1) << 21;
  if (bytes < 2 * PAGE || bytes > (std::size_t (1) << 30) || mallopt (M_MMAP_THRESHOLD, INT_MAX) == 0 ||
      mallopt (M_TRIM_THRESHOLD, INT_MAX) == 0)
    return false;
  // The end of the heap: what is freed there is kept, and handed out again piece by piece.
  void *heap = std::malloc (bytes);
  if (heap == nullptr)
    return false;
  const std::uintptr_t offset = PAGE - reinterpret_cast<std::uintptr_t> (heap) % PAGE; // to where a page begins
  const bool agreed = madvise (static_cast<char *> (heap) + offset, bytes - PAGE, MADV_HUGEPAGE) == 0;
  std::free (heap);
  return agreed;
#else
  static_cast<void> (bytes);
  return false;
#endif
}

} // namespace erkpa
