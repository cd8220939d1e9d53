// SPDX-License-Identifier: BSD-3-Clause
#include "Base/LargePages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace banyan
{
namespace
{

TEST(LargePages, VectorsOfAnySizeHoldWhatTheyAreGiven)
{
  for (const std::size_t bytes : { std::size_t{ 1 }, LargePages::PageBytes - 1,
         LargePages::PageBytes, LargePages::PageBytes + 1, 3 * LargePages::PageBytes + 4711 })
  {
    std::vector<std::uint8_t, InLargePages<std::uint8_t>> memory(bytes);
    EXPECT_EQ(std::count(memory.begin(), memory.end(), 0), static_cast<std::ptrdiff_t>(bytes));
    std::fill(memory.begin(), memory.end(), std::uint8_t{ 7 });
    const auto copy = memory;
    memory.resize(2 * bytes, std::uint8_t{ 9 });
    EXPECT_TRUE(std::equal(copy.begin(), copy.end(), memory.begin()));
    EXPECT_EQ(std::count(memory.begin(), memory.end(), 9), static_cast<std::ptrdiff_t>(bytes));
  }
}

TEST(LargePages, LargePiecesBeginWithAPage)
{
  std::vector<std::int16_t, InLargePages<std::int16_t>> memory(LargePages::PageBytes / 2);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory.data()) % LargePages::PageBytes, 0u);
}

TEST(LargePages, ArraysOfAnySizeAreGivenBack)
{
  for (const std::size_t count : { std::size_t{ 1 }, LargePages::PageBytes / 4 - 1,
         LargePages::PageBytes / 4, LargePages::PageBytes })
  {
    ArrayInLargePages<float> array = NewInLargePages<float>(count);
    std::fill_n(array.get(), count, 2.5f);
    ArrayInLargePages<float> moved = std::move(array);
    EXPECT_EQ(array, nullptr);
    EXPECT_EQ(
      std::count(moved.get(), moved.get() + count, 2.5f), static_cast<std::ptrdiff_t>(count));
    moved = NewInLargePages<float>(1);
    moved.reset();
  }
}

} // namespace
} // namespace banyan
