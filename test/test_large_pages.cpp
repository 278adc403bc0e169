// SPDX-License-Identifier: BSD-3-Clause
#include <erkpa/large_pages.h>

#include <gtest/gtest.h>

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
