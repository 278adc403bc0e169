// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace erkpa
{

/** \brief Numbers of blocks by keys: a table with open addresses, which asks for one line of memory where a map asks
 * for several. */
class BlockIndex
{
public:
  /** \brief The number of a key; -1 where it has none. */
  int
  find (std::uint64_t key) const
  {
    return slots_.empty () ? -1 : slots_[slotOf (key)].number;
  }

  /** \brief The number of a key, which becomes \a number where it has none yet.
   * \return also whether it had none
   */
  std::pair<int, bool>
  insert (std::uint64_t key, int number)
  {
    if (4 * (count_ + 1) > 3 * slots_.size ())
      grow ();
    Slot &slot = slots_[slotOf (key)];
    if (slot.number >= 0)
      return {slot.number, false};
    slot = {key, number};
    ++count_;
    return {number, true};
  }

private:
  struct Slot
  {
    std::uint64_t key;
    int number = -1;
  };

  /** \brief That of the key, or the free one that it would have. */
  std::size_t
  slotOf (std::uint64_t key) const
  {
    constexpr std::uint64_t ODD = 0x9e3779b97f4a7c15u; // Fibonacci hashing
    std::size_t slot = static_cast<std::size_t> (key * ODD >> shift_);
    while (slots_[slot].number >= 0 && slots_[slot].key != key)
      slot = (slot + 1) & (slots_.size () - 1);
    return slot;
  }

  void
  grow ()
  {
    constexpr std::size_t LEAST = 1024;
    std::vector<Slot> before (slots_.empty () ? LEAST : 2 * slots_.size ());
    before.swap (slots_);
    for (shift_ = 64; std::uint64_t (1) << (64 - shift_) < slots_.size ();)
      --shift_;
    for (const Slot &slot : before)
      if (slot.number >= 0)
        slots_[slotOf (slot.key)] = slot;
  }

  std::vector<Slot> slots_; // a power of two of them
  std::size_t count_ = 0;
  int shift_ = 64;
};

} // namespace erkpa
