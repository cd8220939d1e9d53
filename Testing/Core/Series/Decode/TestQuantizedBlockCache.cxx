// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/BlockAllocator.h"
#include "Series/Decode/QuantizedBlockCache.h"

#include <gtest/gtest.h>

#include <random>
#include <unordered_map>

namespace banyan
{
namespace
{

constexpr std::uint64_t SeriesOfTest = 17;

QuantizedBlockCache::Key KeyOf(std::uint64_t block, std::uint64_t series = SeriesOfTest)
{
  return { series, block, static_cast<std::uint32_t>(block % 7), 0, 1 };
}

QuantizedBlockCache::Box BoxOf(std::int16_t number)
{
  auto box = std::make_shared<QuantizedBlock>(100, true);
  box->Numbers<std::int16_t>()[0] = number;
  return box;
}

TEST(QuantizedBlockCache, BoxesAreFoundUntilTheyAreForgotten)
{
  QuantizedBlockCache cache(std::uint64_t{ 64 } << 20);
  constexpr int count = 5000;
  for (int i = 0; i < count; ++i)
  {
    cache.Add(KeyOf(static_cast<std::uint64_t>(i)), BoxOf(static_cast<std::int16_t>(i)));
    cache.Add(KeyOf(static_cast<std::uint64_t>(i), SeriesOfTest + 1), BoxOf(-1));
  }
  cache.Add(KeyOf(17), BoxOf(0)); // the first one stays
  for (int i = 0; i < count; ++i)
  {
    const QuantizedBlockCache::Box box = cache.Find(KeyOf(static_cast<std::uint64_t>(i)));
    ASSERT_NE(box, nullptr) << i;
    ASSERT_EQ(box->Numbers<std::int16_t>()[0], i);
    ASSERT_EQ(cache.AddressOf(KeyOf(static_cast<std::uint64_t>(i))), box->Memory());
  }
  EXPECT_EQ(cache.AddressOf(KeyOf(count)), nullptr);
  EXPECT_EQ(cache.Find(KeyOf(count)), nullptr);
  EXPECT_GE(cache.Bytes(), static_cast<std::uint64_t>(2 * count * 200));
  cache.Forget(SeriesOfTest);
  EXPECT_EQ(cache.Find(KeyOf(3)), nullptr);
  EXPECT_NE(cache.Find(KeyOf(3, SeriesOfTest + 1)), nullptr);
  cache.Forget(SeriesOfTest + 1);
  EXPECT_EQ(cache.Bytes(), 0u);
}

TEST(QuantizedBlockCache, ForgetsTheFinestPlanesOrAll)
{
  QuantizedBlockCache cache(std::uint64_t{ 64 } << 20);
  const auto keyOf = [](int i)
  {
    return QuantizedBlockCache::Key{ SeriesOfTest, static_cast<std::uint64_t>(i), 0, 0,
      static_cast<std::uint16_t>(i % 3) };
  };
  constexpr int count = 3000;
  const auto fill = [&]
  {
    for (int i = 0; i < count; ++i)
    {
      cache.Add(keyOf(i), BoxOf(static_cast<std::int16_t>(i)), i % 3 == 0 && i % 2 == 0);
    }
  };
  fill();
  const std::uint64_t all = cache.Bytes();
  cache.ForgetFinest();
  EXPECT_EQ(cache.Bytes(), all / 3 * 2);
  for (int i = 0; i < count; ++i)
  {
    ASSERT_EQ(cache.Find(keyOf(i)) != nullptr, i % 3 != 0) << i;
  }
  cache.ForgetAll();
  EXPECT_EQ(cache.Bytes(), 0u);
  EXPECT_EQ(cache.Find(keyOf(1)), nullptr);
  EXPECT_EQ(cache.AddressOf(keyOf(1)), nullptr);
  fill(); // there is room again
  EXPECT_EQ(cache.Bytes(), all);
  ASSERT_NE(cache.Find(keyOf(count - 1)), nullptr);
  EXPECT_EQ(cache.Find(keyOf(count - 1))->Numbers<std::int16_t>()[0], count - 1);
}

TEST(QuantizedBlockCache, StaysWithinItsBudgetAndKeepsWhatIsUsed)
{
  QuantizedBlockCache cache(400 * 1000);
  std::unordered_map<std::uint64_t, std::int16_t> added;
  std::mt19937 random(5);
  int kept = 0;
  for (int i = 0; i < 20000; ++i)
  {
    const std::uint64_t block = 100 + random() % 5000;
    const QuantizedBlockCache::Box found = cache.Find(KeyOf(block));
    if (found)
    {
      ASSERT_EQ(found->Numbers<std::int16_t>()[0], added[block]);
    }
    else
    {
      added[block] = static_cast<std::int16_t>(i);
      cache.Add(KeyOf(block), BoxOf(static_cast<std::int16_t>(i)));
    }
    ASSERT_LE(cache.Bytes(), 400u * 1000);
    // Some are asked for all the time.
    const std::uint64_t favourite = static_cast<std::uint64_t>(i) % 50;
    kept += cache.Find(KeyOf(favourite)) ? 1 : 0;
    cache.Add(KeyOf(favourite), BoxOf(0));
  }
  EXPECT_GT(kept, 18000);
}

TEST(QuantizedBlockCache, WithoutABudgetNothingStays)
{
  QuantizedBlockCache cache(0);
  cache.Add(KeyOf(1), BoxOf(1));
  EXPECT_EQ(cache.Bytes(), 0u);
  EXPECT_EQ(cache.Find(KeyOf(1)), nullptr);
}

/// Boxes in slabs are limited by what all caches may keep.
TEST(QuantizedBlockCache, CachesThatGoGiveTheirSlabsBack)
{
  BlockAllocator::KeepAtMost(0); // empty ones of other tests go
  const std::size_t before = BlockAllocator::BytesOfSlabs();
  {
    QuantizedBlockCache one(std::uint64_t{ 32 } << 20);
    QuantizedBlockCache other(std::uint64_t{ 32 } << 20);
    for (QuantizedBlockCache* const cache : { &one, &other })
    {
      for (std::uint64_t i = 0; i < 2800; ++i)
      {
        cache->Add(KeyOf(i), std::make_shared<QuantizedBlock>(std::size_t{ 17 * 17 * 17 }, true));
      }
      EXPECT_GT(cache->Bytes(), std::uint64_t{ 20 } << 20);
    }
#ifndef BANYAN_HAS_ADDRESS_SANITIZER
    EXPECT_GT(BlockAllocator::BytesOfSlabs(), before + (std::size_t{ 40 } << 20));
#endif
  }
  EXPECT_LE(BlockAllocator::BytesOfSlabs(), before);
}

/// Boxes of one size in a cache with room for about 1600 of them.
TEST(QuantizedBlockCache, BriefBoxesLeaveTheRoomToOthers)
{
  QuantizedBlockCache cache(640 * 1000);
  constexpr std::uint64_t others = 1000, briefs = 20000, first = 100000;
  for (std::uint64_t i = 0; i < others; ++i)
  {
    cache.Add(KeyOf(i), BoxOf(static_cast<std::int16_t>(i)));
  }
  for (std::uint64_t i = 0; i < briefs; ++i)
  {
    cache.Add(KeyOf(first + i), BoxOf(static_cast<std::int16_t>(i)), true);
    const QuantizedBlockCache::Box newest = cache.Find(KeyOf(first + i));
    ASSERT_NE(newest, nullptr);
    ASSERT_EQ(newest->Numbers<std::int16_t>()[0], static_cast<std::int16_t>(i));
    ASSERT_LE(cache.Bytes(), 640u * 1000);
  }
  std::uint64_t left = 0;
  for (std::uint64_t i = 0; i < briefs; ++i)
  {
    left += cache.Find(KeyOf(first + i)) ? 1 : 0;
  }
  EXPECT_GT(left, 300u);
  EXPECT_LT(left, 700u); // what others leave
  for (std::uint64_t i = 0; i < others; ++i)
  {
    ASSERT_NE(cache.Find(KeyOf(i)), nullptr) << i;
  }
  // Those that others push out are forgotten in every respect.
  for (std::uint64_t i = 0; i < 4 * others; ++i)
  {
    cache.Add(KeyOf(1000000 + i), BoxOf(0), i % 3 == 0);
    ASSERT_LE(cache.Bytes(), 640u * 1000);
  }
  cache.Forget(SeriesOfTest);
  EXPECT_EQ(cache.Find(KeyOf(first + briefs - 1)), nullptr);
  cache.Add(KeyOf(1), BoxOf(1), true);
  EXPECT_NE(cache.Find(KeyOf(1)), nullptr);
}

} // namespace
} // namespace banyan
