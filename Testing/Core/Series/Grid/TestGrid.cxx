// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Series/Grid/Grid.h"

#include <gtest/gtest.h>

#include <vector>

namespace banyan
{
namespace
{

const std::vector<int> Lengths = { 1, 2, 3, 7, 8, 9, 10, 15, 16, 17, 18, 31, 33, 97 };

TEST(BrickLayout, EachCellLiesInOneBrickAndBricksShareOneLayer)
{
  for (const int length : Lengths)
  {
    for (int level = 0; level < BrickLayout::LevelCount({ length, 1, 1 }, 8); ++level)
    {
      const BrickLayout layout({ length, 1, 5 }, 8, level);
      std::vector<int> owners(static_cast<std::size_t>(layout.Samples().x), 0);
      int last = 0;
      for (std::int64_t b = 0; b < layout.BrickCount(); ++b)
      {
        EXPECT_EQ(layout.IndexOf(layout.PositionOf(b)), b);
        const Box cells = layout.CellsOf(b);
        const Box samples = layout.SamplesOf(b);
        EXPECT_EQ(cells.Lo, samples.Lo);
        EXPECT_EQ(cells.Hi + 1, samples.Hi);
        EXPECT_LE(samples.Hi.x, layout.Samples().x);
        EXPECT_EQ(samples.Size().y, 1);
        EXPECT_LE(cells.Size().x, 8);
        EXPECT_EQ(cells.Lo.x, last);
        last = cells.Hi.x;
        for (int c = cells.Lo.x; c < cells.Hi.x; ++c)
        {
          ++owners[static_cast<std::size_t>(c)];
        }
      }
      EXPECT_EQ(last, layout.Samples().x - 1) << length << " at level " << level;
      for (int c = 0; c + 1 < layout.Samples().x; ++c)
      {
        EXPECT_EQ(owners[static_cast<std::size_t>(c)], 1);
      }
    }
  }
}

TEST(BrickLayout, LevelsKeepEverySecondSampleAndTheLastOne)
{
  for (const int length : Lengths)
  {
    const int levels = BrickLayout::LevelCount({ 1, length, 1 }, 8);
    for (int level = 0; level < levels; ++level)
    {
      const BrickLayout layout({ 1, length, 1 }, 8, level);
      const int step = 1 << level;
      EXPECT_EQ(layout.Samples().y, (length - 1 + step - 1) / step + 1);
      for (int s = 0; s < layout.Samples().y; ++s)
      {
        EXPECT_EQ(layout.FineSample({ 0, s, 0 }).y, std::min(s * step, length - 1));
      }
      EXPECT_EQ(layout.FineSample({ 0, layout.Samples().y - 1, 0 }).y, length - 1);
      EXPECT_EQ(layout.BrickCount() == 1, level + 1 == levels) << length;
    }
  }
}

/// Fewest bricks that hold samples [lo, hi) of an axis, by trying all.
int FewestBricks(const BrickLayout& layout, int lo, int hi)
{
  int fewest = 1 << 30;
  for (int first = 0; first < layout.Bricks().x; ++first)
  {
    for (int last = first; last < layout.Bricks().x; ++last)
    {
      const int start = layout.SamplesOf(first).Lo.x;
      const int end = layout.SamplesOf(last).Hi.x;
      fewest = start <= lo && end >= hi ? std::min(fewest, last - first + 1) : fewest;
    }
  }
  return fewest;
}

TEST(BrickLayout, CoversARegionWithTheFewestBricks)
{
  for (const int length : { 1, 8, 9, 16, 17, 18, 40 })
  {
    const BrickLayout layout({ length, 1, 1 }, 8, 0);
    for (int lo = 0; lo < length; ++lo)
    {
      for (int hi = lo + 1; hi <= length; ++hi)
      {
        const Box bricks = layout.BricksCovering({ { lo, 0, 0 }, { hi, 1, 1 } });
        ASSERT_FALSE(bricks.Empty());
        EXPECT_EQ(bricks.Size().x, FewestBricks(layout, lo, hi)) << lo << " to " << hi;
        EXPECT_LE(layout.SamplesOf(bricks.Lo.x).Lo.x, lo);
        EXPECT_GE(layout.SamplesOf(bricks.Hi.x - 1).Hi.x, hi);
      }
    }
    EXPECT_TRUE(layout.BricksCovering({ { 0, 0, 0 }, { 0, 1, 1 } }).Empty());
  }
}

TEST(BrickLayout, LongestAxesDoNotOverflow)
{
  const int longest = 2147483647;
  const BrickLayout layout({ longest, 1, 1 }, 128, 0);
  EXPECT_EQ(layout.Samples().x, longest);
  const Box last = layout.SamplesOf(layout.BrickCount() - 1);
  EXPECT_EQ(last.Hi.x, longest);
  EXPECT_EQ(BrickLayout({ longest, 1, 1 }, 128, 31).Samples().x, 2);
  EXPECT_EQ(BrickLayout::LevelCount({ longest, 1, 1 }, 128), 25);
}

TEST(BrickLayout, RejectsWhatCannotBe)
{
  EXPECT_THROW(BrickLayout({ 0, 1, 1 }, 8, 0), Error);
  EXPECT_THROW(BrickLayout({ 1, 1, 1 }, 12, 0), Error);
  EXPECT_THROW(BrickLayout({ 1, 1, 1 }, 2, 0), Error);
  EXPECT_THROW(BrickLayout({ 1, 1, 1 }, 256, 0), Error);
  EXPECT_THROW(BrickLayout({ 1, 1, 1 }, 8, -1), Error);
  EXPECT_THROW(BrickLayout({ 1, 1, 1 }, 8, 32), Error);
}

} // namespace
} // namespace banyan
