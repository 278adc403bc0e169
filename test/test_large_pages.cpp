// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/large_pages.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <vector>

TEST (LargeVector, HoldsManyElementsWhileItGrowsAcrossPages)
{
  erkpa::LargeVector<int> numbers;
  for (int i = 0; i < 1000000; ++i)
    numbers.push_back (i);
  const erkpa::LargeVector<int> copy = numbers;
  numbers = erkpa::LargeVector<int> ();
  for (int i = 0; i < 1000000; i += 999)
    ASSERT_EQ (copy[static_cast<std::size_t> (i)], i);
}

TEST (LargeVector, RefusesMoreElementsThanBytesCanCount)
{
  erkpa::LargePageAllocator<double> allocator;
  EXPECT_THROW (allocator.allocate (std::numeric_limits<std::size_t>::max () / 4), std::bad_alloc);
}

TEST (LargeVector, ReservesForOthersToo)
{
  std::vector<std::uint8_t> bytes;
  erkpa::reserveLarge (10000000, bytes);
  EXPECT_GE (bytes.capacity (), 10000000U);
  erkpa::reserveLarge (10, bytes);
  EXPECT_TRUE (bytes.empty ());
}

TEST (LargeVector, GetsTheMemoryThatAnotherGaveUpWhileAKeeperKeepsIt)
{
  constexpr std::size_t MANY = 3000000;
  const erkpa::LargePageKeeper keeper;
  erkpa::LargeVector<char> first (MANY, 'a');
  const char *const memory = first.data ();
  first = erkpa::LargeVector<char> ();
  const erkpa::LargeVector<char> second (MANY, 'b');
#ifndef __SANITIZE_ADDRESS__ // which finds more if memory is not used again
  EXPECT_EQ (second.data (), memory);
#endif
  const erkpa::LargeVector<char> third (MANY, 'c');
  EXPECT_EQ (second.front (), 'b');
  EXPECT_EQ (second.back (), 'b');
  EXPECT_EQ (third.back (), 'c');
}

TEST (LargeVector, JoinsTheMemoryOfNeighborsAndDividesItAgain)
{
  constexpr std::size_t PAGE = std::size_t (1) << 21;
  const erkpa::LargePageKeeper keeper;
  erkpa::LargePageAllocator<char> allocator;
  char *const whole = allocator.allocate (4 * PAGE);
  allocator.deallocate (whole, 4 * PAGE);
  char *const low = allocator.allocate (PAGE), *const high = allocator.allocate (3 * PAGE);
  std::fill_n (low, PAGE, 'l');
  std::fill_n (high, 3 * PAGE, 'h');
  EXPECT_EQ (std::count (low, low + PAGE, 'l'), PAGE);
  EXPECT_EQ (std::count (high, high + 3 * PAGE, 'h'), 3 * PAGE);
  allocator.deallocate (high, 3 * PAGE);
  allocator.deallocate (low, PAGE);
  char *const again = allocator.allocate (4 * PAGE);
#ifndef __SANITIZE_ADDRESS__
  EXPECT_EQ (again, whole);
#endif
  allocator.deallocate (again, 4 * PAGE);
}

TEST (LargeVector, MayOutliveTheKeeper)
{
  erkpa::LargeVector<int> numbers;
  {
    const erkpa::LargePageKeeper keeper;
    numbers.assign (1000000, 7);
  }
  EXPECT_EQ (std::count (numbers.begin (), numbers.end (), 7), 1000000);
}
