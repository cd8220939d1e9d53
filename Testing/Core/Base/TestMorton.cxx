// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Morton.h"
#include "Base/RadixSort.h"

#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace
{

using namespace banyan;

TEST(Morton, KeysInterleaveBits)
{
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i)
  {
    const glm::ivec3 p(random() % MortonEdge, random() % MortonEdge, random() % MortonEdge);
    MortonKey slow = 0;
    for (int bit = 0; bit < MortonBits; ++bit)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        slow |= MortonKey(p[axis] >> bit & 1) << (3 * bit + axis);
      }
    }
    ASSERT_EQ(KeyOf(p), slow);
    ASSERT_EQ(PositionOfKey(slow), p);
  }
  EXPECT_EQ(KeyOf(glm::ivec3(MortonEdge - 1)), (MortonKey(1) << 63) - 1);
}

class RadixSortTest : public testing::TestWithParam<int>
{
};

TEST_P(RadixSortTest, SortsAsTheLibraryDoes)
{
  ThreadPool pool(GetParam());
  std::mt19937_64 random(5);
  for (const std::size_t count : { 0u, 1u, 2u, 3u, 1000u, 50021u })
  {
    for (const int bits : { 1, 7, 11, 12, 33, 63, 64 })
    {
      std::vector<std::uint64_t> keys(count);
      for (std::uint64_t& key : keys)
      {
        key = random() >> (64 - bits);
      }
      std::vector<std::uint32_t> values(count);
      std::iota(values.begin(), values.end(), 0u);
      std::vector<std::uint32_t> expected = values;
      std::stable_sort(expected.begin(), expected.end(),
        [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
      const std::vector<std::uint64_t> unsorted = keys;
      RadixSort(keys, values, bits, pool);
      ASSERT_EQ(values, expected) << count << " of " << bits;
      ASSERT_TRUE(std::is_sorted(keys.begin(), keys.end()));
      for (std::size_t i = 0; i < count; ++i)
      {
        ASSERT_EQ(keys[i], unsorted[values[i]]);
      }
    }
  }
}

TEST_P(RadixSortTest, SortsByABitRangeAlone)
{
  ThreadPool pool(GetParam());
  std::mt19937_64 random(6);
  for (const auto& [first, end] : { std::pair(3, 4), std::pair(5, 27), std::pair(31, 64) })
  {
    KeyedNumbers numbers(20011);
    std::generate_n(numbers.Keys.get(), numbers.Count, random);
    std::iota(numbers.Values.get(), numbers.Values.get() + numbers.Count, 0u);
    const std::vector<std::uint64_t> keys(numbers.Keys.get(), numbers.Keys.get() + numbers.Count);
    std::vector<std::uint32_t> expected(keys.size());
    std::iota(expected.begin(), expected.end(), 0u);
    const auto part = [&, from = first, to = end](std::uint32_t i)
    { return keys[i] << (64 - to) >> (64 - to + from); };
    std::stable_sort(expected.begin(), expected.end(),
      [&](std::uint32_t a, std::uint32_t b) { return part(a) < part(b); });
    RadixSort(numbers, first, end, pool);
    for (std::size_t i = 0; i < keys.size(); ++i)
    {
      ASSERT_EQ(numbers.Values[i], expected[i]);
      ASSERT_EQ(numbers.Keys[i], keys[expected[i]]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, RadixSortTest, testing::Values(1, 2, 5));

} // namespace
