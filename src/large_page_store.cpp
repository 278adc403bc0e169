// SPDX-License-Identifier: BSD-3-Clause
#include "large_page_store.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <limits>

// AddressSanitizer has its own malloc, which finds more.
#ifdef __has_feature
#define ERKPA_HAS_SANITIZER __has_feature (address_sanitizer)
#elif defined(__SANITIZE_ADDRESS__)
#define ERKPA_HAS_SANITIZER 1
#else
#define ERKPA_HAS_SANITIZER 0
#endif

#if defined(MADV_HUGEPAGE) && !ERKPA_HAS_SANITIZER
#define ERKPA_HAS_LARGE_PAGES 1
#else
#define ERKPA_HAS_LARGE_PAGES 0
#endif

namespace erkpa
{

namespace
{

constexpr std::size_t PAGE = LargePageStore::PAGE;
constexpr bool CAN_DIVIDE = ERKPA_HAS_LARGE_PAGES; // what the system gives; memory of malloc cannot be

#if ERKPA_HAS_LARGE_PAGES

void *
takeFromSystem (std::size_t bytes)
{
  void *const mapped = mmap (nullptr, bytes + PAGE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED)
    return nullptr;
  const std::size_t before = (PAGE - reinterpret_cast<std::uintptr_t> (mapped) % PAGE) % PAGE; // where a page begins
  char *const first = static_cast<char *> (mapped) + before;
  if (before > 0)
    munmap (mapped, before);
  munmap (first + bytes, PAGE - before);
  madvise (first, bytes, MADV_HUGEPAGE);
  return first;
}

void
giveToSystem (void *memory, std::size_t bytes) noexcept
{
  munmap (memory, bytes);
}

#else

void *
takeFromSystem (std::size_t bytes)
{
  return std::malloc (bytes);
}

void
giveToSystem (void *memory, std::size_t) noexcept
{
  std::free (memory);
}

#endif

std::size_t
wholeGrains (std::size_t bytes)
{
  constexpr std::size_t GRAIN = LargePageStore::GRAIN;
  return (bytes + GRAIN - 1) / GRAIN * GRAIN;
}

} // namespace

bool
LargePageStore::advise (void *memory, std::size_t bytes) noexcept
{
#if ERKPA_HAS_LARGE_PAGES
  const std::size_t offset = (PAGE - reinterpret_cast<std::uintptr_t> (memory) % PAGE) % PAGE; // to where one begins
  return bytes >= offset + PAGE &&
         madvise (static_cast<char *> (memory) + offset, (bytes - offset) / PAGE * PAGE, MADV_HUGEPAGE) == 0;
#else
  static_cast<void> (memory);
  static_cast<void> (bytes);
  return false;
#endif
}

LargePageStore &
LargePageStore::instance ()
{
  static auto *const store = new LargePageStore; // arrays may outlive what ends with the program
  return *store;
}

void *
LargePageStore::take (std::size_t bytes)
{
  if (bytes > std::numeric_limits<std::size_t>::max () / 4)
    return nullptr;
  bytes = wholeGrains (bytes);
  if (void *const kept = takeKept (bytes); kept != nullptr)
    return kept;
  // More than is asked for, so that what is given up lies together; pages that are not filled take no memory.
  constexpr std::size_t LEAST = std::size_t (1) << 26;
  const std::size_t much = std::max (LEAST, 2 * bytes);
  auto *const memory = CAN_DIVIDE ? static_cast<char *> (takeFromSystem (much)) : nullptr;
  if (memory != nullptr)
  {
    give (memory + bytes, much - bytes);
    return memory;
  }
  if (void *const least = takeFromSystem (bytes); least != nullptr)
    return least;
  dropKept (); // of which no range was large enough
  return takeFromSystem (bytes);
}

void
LargePageStore::dropKept () noexcept
{
  std::vector<Range> dropped;
  {
    const std::lock_guard<std::mutex> lock (mutex_);
    dropped.swap (kept_);
  }
  for (const Range &range : dropped)
    giveToSystem (range.first, range.bytes);
}

/** \brief From the last range that does: systems give addresses downwards, so that it is most likely to be filled. */
void *
LargePageStore::takeKept (std::size_t bytes)
{
  const std::lock_guard<std::mutex> lock (mutex_);
  const auto found = std::find_if (kept_.rbegin (), kept_.rend (), [=] (const Range &r) { return r.bytes >= bytes; });
  if (found == kept_.rend ())
    return nullptr;
  const auto range = found.base () - 1;
  void *const memory = range->first;
  range->first += bytes;
  range->bytes -= bytes;
  if (range->bytes == 0)
    kept_.erase (range);
  return memory;
}

void
LargePageStore::give (void *memory, std::size_t bytes) noexcept
{
  bytes = wholeGrains (bytes);
  if (!tryToKeep ({static_cast<char *> (memory), bytes}))
    giveToSystem (memory, bytes);
}

/** \brief False where nobody wants it kept. */
bool
LargePageStore::tryToKeep (const Range &range) noexcept
{
  if (!CAN_DIVIDE)
    return false;
  try
  {
    const std::lock_guard<std::mutex> lock (mutex_);
    if (keepers_ == 0)
      return false;
    const auto is_below = [] (const Range &a, const Range &b) { return a.first < b.first; };
    auto at = kept_.insert (std::lower_bound (kept_.begin (), kept_.end (), range, is_below), range);
    const auto join_next = [this] (auto one)
    {
      if (one + 1 == kept_.end () || one->first + one->bytes != (one + 1)->first)
        return;
      one->bytes += (one + 1)->bytes;
      kept_.erase (one + 1);
    };
    join_next (at);
    if (at != kept_.begin ())
      join_next (at - 1);
    return true;
  }
  catch (const std::exception &)
  {
    return false;
  }
}

void
LargePageStore::keep ()
{
  const std::lock_guard<std::mutex> lock (mutex_);
  ++keepers_;
}

void
LargePageStore::release () noexcept
{
  bool is_last = false;
  {
    const std::lock_guard<std::mutex> lock (mutex_);
    is_last = --keepers_ == 0;
  }
  if (is_last)
    dropKept ();
}

} // namespace erkpa
