// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/large_pages.h>

#include "large_page_store.h"

#include <climits>
#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace erkpa
{

namespace
{

/** \brief From here on an array is large, and what it leaves of a grain is little. */
constexpr std::size_t LARGE = 4 * LargePageStore::GRAIN;

} // namespace

bool
preferLargePages (std::size_t bytes)
{
#if defined(__GLIBC__)
  if (bytes < 2 * LargePageStore::PAGE || bytes > (std::size_t (1) << 30) || mallopt (M_MMAP_THRESHOLD, INT_MAX) == 0 ||
      mallopt (M_TRIM_THRESHOLD, INT_MAX) == 0)
    return false;
  // The end of the heap: what is freed there is kept, and handed out again piece by piece.
  void *heap = std::malloc (bytes);
  if (heap == nullptr)
    return false;
  const bool agreed = LargePageStore::advise (heap, bytes);
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
  void *const memory = bytes < LARGE ? std::malloc (bytes) : LargePageStore::instance ().take (bytes);
  if (memory == nullptr && bytes > 0)
    throw std::bad_alloc ();
  return memory;
}

void
freeLarge (void *memory, std::size_t bytes) noexcept
{
  if (bytes < LARGE)
    std::free (memory);
  else
    LargePageStore::instance ().give (memory, bytes);
}

void
adviseLargePages (void *memory, std::size_t bytes) noexcept
{
  LargePageStore::advise (memory, bytes);
}

LargePageKeeper::LargePageKeeper ()
{
  LargePageStore::instance ().keep ();
}

LargePageKeeper::~LargePageKeeper ()
{
  LargePageStore::instance ().release ();
}

} // namespace erkpa
