// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Grid/NumberBox.h"
#include "Targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace banyan
{
namespace
{

constexpr int Pitch = 70, Slice = 5 * Pitch;

/// Numbers of two steps; what lies between and beyond the samples of a box is larger and smaller
/// than all of them, and another number in the other step.
template <class Number>
struct TwoSteps
{
  std::vector<Number> Now, Before;
  NumberBox<Number> Box;
  NumberExtremes Expected;

  TwoSteps(int count, int stride, unsigned seed)
  {
    const int size = 3 * Slice + 2;
    std::mt19937 random(seed);
    for (int i = 0; i < size; ++i)
    {
      this->Now.push_back(static_cast<Number>(i % 2 == 0 ? 7777 : -7777));
      this->Before.push_back(static_cast<Number>(i % 2 == 0 ? -7777 : 7777));
    }
    const Number* const next = count % 2 == 0 ? this->Before.data() + 1 : nullptr;
    this->Box = { this->Now.data() + 1, this->Before.data() + 1, next, count, stride,
      stride * Pitch, Slice, 4 / stride, 3 };
    this->ForEachSample(
      [&](Number& now, Number& before)
      {
        now = before = static_cast<Number>(static_cast<int>(random() % 2000) - 1000);
        this->Expected.Low = std::min<std::int32_t>(this->Expected.Low, now);
        this->Expected.High = std::max<std::int32_t>(this->Expected.High, now);
      });
  }

  template <class Body>
  void ForEachSample(const Body& body)
  {
    for (int z = 0; z < this->Box.Slices; ++z)
    {
      for (int y = 0; y < this->Box.Rows; ++y)
      {
        for (int x = 0; x < this->Box.Count; ++x)
        {
          const std::size_t at = static_cast<std::size_t>(
            1 + z * this->Box.SliceGap + y * this->Box.RowGap + x * this->Box.Stride);
          body(this->Now[at], this->Before[at]);
        }
      }
    }
  }
};

template <class Number>
void ExpectExtremesOfEveryCount()
{
  for (const int stride : { 1, 2 })
  {
    for (int count = 1; (count - 1) * stride + 1 <= 65; ++count)
    {
      SCOPED_TRACE("stride " + std::to_string(stride) + ", " + std::to_string(count) + " samples");
      TwoSteps<Number> steps(count, stride, static_cast<unsigned>(count));
      NumberExtremes found;
      IncludeBox(steps.Box, found);
      ASSERT_EQ(found.Low, steps.Expected.Low);
      ASSERT_EQ(found.High, steps.Expected.High);
      ASSERT_TRUE(SameAsBefore(steps.Box));
      // Each sample counts.
      steps.ForEachSample(
        [&](Number& now, Number& before)
        {
          const Number was = now;
          for (const int extreme : { -3000, 3000 })
          {
            now = before = static_cast<Number>(extreme);
            NumberExtremes other;
            IncludeBox(steps.Box, other);
            ASSERT_EQ(extreme < 0 ? other.Low : other.High, extreme);
            ASSERT_TRUE(SameAsBefore(steps.Box));
          }
          now = was;
          before = static_cast<Number>(was + 1);
          ASSERT_FALSE(SameAsBefore(steps.Box));
          before = was;
        });
    }
  }
}

TEST(NumberBox, EverySampleCountsAndNothingBesideThem)
{
  for (const std::int64_t target : targets::OfThisMachine())
  {
    SCOPED_TRACE(target);
    const targets::OnlyTarget only(target);
    ExpectExtremesOfEveryCount<std::int16_t>();
    ExpectExtremesOfEveryCount<std::int32_t>();
  }
}

TEST(NumberBox, SeveralBoxesAddUp)
{
  const std::vector<std::int16_t> now{ 5, -2, 9 }, before{ 5, -2, 8 };
  NumberExtremes found;
  for (std::size_t i = 0; i < now.size(); ++i)
  {
    NumberBox<std::int16_t> box;
    box.Numbers = &now[i];
    box.Before = &before[i];
    IncludeBox(box, found);
    EXPECT_EQ(SameAsBefore(box), i < 2);
  }
  EXPECT_EQ(found.Low, -2);
  EXPECT_EQ(found.High, 9);
}

} // namespace
} // namespace banyan
