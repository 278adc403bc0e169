// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <mutex>
#include <vector>

namespace erkpa
{

/** \brief Memory in large pages, from the system and back to it; see LargePageKeeper. */
class LargePageStore
{
public:
  static constexpr std::size_t PAGE = std::size_t (1) << 21;
  static constexpr std::size_t GRAIN = std::size_t (1) << 16; ///< arrays share pages: they take multiples of this

  static LargePageStore &
  instance ();

  /** \brief Ask for large pages in any memory; false where it holds none as a whole, or the system has none. */
  static bool
  advise (void *memory, std::size_t bytes) noexcept;

  /** \brief At least \a bytes; nullptr where there are none. */
  void *
  take (std::size_t bytes);

  /** \param[in] bytes as they were asked for */
  void
  give (void *memory, std::size_t bytes) noexcept;

  /** \brief From now on keep what is given, until release () was called as often. */
  void
  keep ();

  void
  release () noexcept;

private:
  /** \brief Grains, one after the other. */
  struct Range
  {
    char *first;
    std::size_t bytes;
  };

  void *
  takeKept (std::size_t bytes);

  /** \brief Give the system what is kept. */
  void
  dropKept () noexcept;

  bool
  tryToKeep (const Range &range) noexcept;

  std::mutex mutex_;
  std::size_t keepers_ = 0;
  std::vector<Range> kept_; // by address, none next to another
};

} // namespace erkpa
