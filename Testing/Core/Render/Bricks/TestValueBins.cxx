// SPDX-License-Identifier: BSD-3-Clause
// Bins of rows of values, and masks of what lies between, against one value after the other.
#include "Render/Bricks/ValueBins.h"

#include "Targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace
{

using namespace banyan;

constexpr double Infinity = std::numeric_limits<double>::infinity();

/// Anything from far below the range to far above, on edges of bins, and what is no number.
template <class T>
std::vector<T> Values(std::size_t count, const MaskRange& over)
{
  std::mt19937 random(7);
  std::vector<T> values;
  for (std::size_t i = 0; i < count; ++i)
  {
    const double width = over.High - over.Low;
    const double anywhere = over.Low + width * (std::ldexp(random() % 1024, -9) - 0.5);
    const double edge = over.Low + width * (random() % 65) / 64.0;
    const double special[] = { Infinity, -Infinity, std::nan(""), -0.0 };
    const unsigned kind = random() % 8;
    values.push_back(static_cast<T>(kind == 0   ? special[random() % 4]
                                    : kind == 1 ? edge
                                                : anywhere));
  }
  return values;
}

/// As the header says.
struct Expected
{
  std::vector<std::uint8_t> Low;
  std::vector<std::uint8_t> High;
  ValueRange Range;

  template <class T>
  Expected(const ValueRows<T>& rows, const MaskRange& over, const ValueRange& before)
    : Range(before)
  {
    const double scale = over.High > over.Low ? 64.0 / (over.High - over.Low) : 0.0;
    for (int y = 0; y < rows.Rows; ++y)
    {
      for (int x = 0; x <= rows.Width; ++x)
      {
        const double value =
          x < rows.Width ? static_cast<double>(rows.Values[y * rows.Stride + x]) : Infinity;
        const double position = std::fmin(std::fmax((value - over.Low) * scale, 0.0), 63.0);
        const bool none = !std::isfinite(value);
        this->Low.push_back(none ? 255 : static_cast<std::uint8_t>(position));
        this->High.push_back(none ? 0 : static_cast<std::uint8_t>(position));
        if (!none)
        {
          this->Range.Include(value);
        }
      }
    }
  }
};

template <class T>
void ExpectAllRows(const MaskRange& over)
{
  for (int width = 1; width <= 37; ++width)
  {
    const std::ptrdiff_t stride = width + 3;
    const std::vector<T> values = Values<T>(static_cast<std::size_t>(5 * stride), over);
    const ValueRows<T> rows{ values.data(), stride, width, 5 };
    for (const ValueRange& before : { ValueRange{}, ValueRange{ -1e30, 1e30 } })
    {
      const Expected expected(rows, over, before);
      std::vector<std::uint8_t> low(expected.Low.size() + 1, 77);
      std::vector<std::uint8_t> high(low);
      ValueRange range = before;
      BinValues(rows, over, { low.data(), high.data() }, range);
      EXPECT_EQ(low.back(), 77) << "beyond the slice";
      EXPECT_EQ(high.back(), 77);
      low.pop_back();
      high.pop_back();
      EXPECT_EQ(low, expected.Low) << width;
      EXPECT_EQ(high, expected.High) << width;
      EXPECT_EQ(range.Low, expected.Range.Low);
      EXPECT_EQ(range.High, expected.Range.High);
    }
  }
}

TEST(ValueBins, AreThoseOfEachValueOnAllProcessors)
{
  for (const std::int64_t target : targets::OfThisMachine())
  {
    const targets::OnlyTarget only(target);
    for (const MaskRange& over : { MaskRange{ 0.0, 1.0 }, MaskRange{ 273.15, 273.25 },
           MaskRange{ -1e20, 3e20 }, MaskRange{ 2.0, 2.0 } })
    {
      ExpectAllRows<float>(over);
      ExpectAllRows<double>(over);
    }
  }
}

TEST(ValueBins, BetweenLowestAndHighestAreAllInTheMask)
{
  std::mt19937 random(3);
  for (const std::int64_t target : targets::OfThisMachine())
  {
    const targets::OnlyTarget only(target);
    for (std::size_t count = 0; count < 70; ++count)
    {
      std::vector<std::uint8_t> low(count);
      std::vector<std::uint8_t> high(count);
      ValueMask expected = 0;
      for (std::size_t i = 0; i < count; ++i)
      {
        const bool none = random() % 4 == 0;
        const auto first = static_cast<unsigned>(random() % 64);
        const unsigned last = std::min(63u, first + static_cast<unsigned>(random() % 3));
        low[i] = static_cast<std::uint8_t>(none ? 255 : first);
        high[i] = static_cast<std::uint8_t>(none ? 0 : last);
        for (unsigned bin = first; bin <= last && !none; ++bin)
        {
          expected |= ValueMask{ 1 } << bin;
        }
      }
      ASSERT_EQ(BinsBetween(low.data(), high.data(), count), expected) << count;
    }
    const std::uint8_t all[2] = { 0, 63 };
    EXPECT_EQ(BinsBetween(all, all + 1, 1), ~ValueMask{ 0 });
  }
}

} // namespace
