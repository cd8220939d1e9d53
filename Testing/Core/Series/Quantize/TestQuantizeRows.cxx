// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/QuantizeRows.h"
#include "Targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace banyan
{
namespace
{

const LatticeScale Scale{ 0.125, 0.03, -10, 130, -300, 4000 };

/// One row of values without gaps.
template <class T, class Number>
QuantizedRows<T, Number> RowOf(const std::vector<T>& values, Number* numbers)
{
  QuantizedRows<T, Number> rows;
  rows.Values = values.data();
  rows.Numbers = numbers;
  rows.Count = static_cast<int>(values.size());
  rows.Rows = 1;
  rows.Slices = 1;
  return rows;
}

template <class T>
std::vector<T> SomeValues(std::size_t count)
{
  std::mt19937 random(static_cast<unsigned>(count));
  std::uniform_real_distribution<double> values(-9.9, 129.9); // beyond the numbers, but held
  std::vector<T> result;
  for (std::size_t i = 0; i < count; ++i)
  {
    result.push_back(static_cast<T>(values(random)));
  }
  return result;
}

template <class Number>
Number SlowNumber(double value)
{
  const double number = std::nearbyint((value - Scale.Origin) * (1.0 / Scale.Step));
  return static_cast<Number>(std::clamp<double>(number, Scale.Least, Scale.Greatest));
}

template <class T, class Number>
void ExpectNumbersOfEveryCount()
{
  for (std::size_t count = 1; count <= 40; ++count)
  {
    const std::vector<T> values = SomeValues<T>(count);
    std::vector<Number> numbers(count + 1, Number{ 77 });
    ASSERT_TRUE(QuantizeRows(RowOf(values, numbers.data()), Scale));
    for (std::size_t i = 0; i < count; ++i)
    {
      ASSERT_EQ(numbers[i], SlowNumber<Number>(values[i])) << i << " of " << count;
    }
    ASSERT_EQ(numbers[count], 77) << "behind the row's end";
    for (std::size_t i = 0; i < count; ++i)
    {
      for (const double bad : { double(NAN), double(INFINITY), -10.01, 130.01 })
      {
        std::vector<T> spoilt = values;
        spoilt[i] = static_cast<T>(bad);
        ASSERT_FALSE(QuantizeRows(RowOf(spoilt, numbers.data()), Scale))
          << bad << " at " << i << " of " << count;
      }
    }
  }
}

TEST(QuantizedRows, NumbersAreTheNearestOnesAndWhatIsNotHeldIsTold)
{
  for (const std::int64_t target : targets::OfThisMachine())
  {
    SCOPED_TRACE(hwy::TargetName(target));
    const targets::OnlyTarget only(target);
    ExpectNumbersOfEveryCount<float, std::int16_t>();
    ExpectNumbersOfEveryCount<float, std::int32_t>();
    ExpectNumbersOfEveryCount<double, std::int16_t>();
    ExpectNumbersOfEveryCount<double, std::int32_t>();
  }
}

/// What rows of many lengths add up to, sample by sample.
template <class T, class Number>
void ExpectErrorsOfEveryCount()
{
  constexpr double bound = 0.02; // numbers are at most half a step away
  RowErrors sums, slow;
  for (std::size_t count = 1; count <= 40; ++count)
  {
    std::vector<T> values = SomeValues<T>(count);
    std::vector<Number> numbers(count);
    for (std::size_t i = 0; i < count; ++i)
    {
      values[i] = std::min<T>(values[i], 119);
      values[i] = std::max<T>(values[i], -8);
      numbers[i] = SlowNumber<Number>(values[i]);
    }
    RowErrors row;
    const Number* const all = numbers.data();
    ASSERT_TRUE(ErrorsOnLattice(RowOf(values, all), Scale, bound, row));
    ASSERT_TRUE(ErrorsOnLattice(RowOf(values, all), Scale, bound, sums));
    RowErrors expected;
    for (std::size_t i = 0; i < count; ++i)
    {
      const T decoded = static_cast<T>(Scale.Origin + static_cast<double>(numbers[i]) * Scale.Step);
      const double error = std::abs(static_cast<double>(values[i]) - static_cast<double>(decoded));
      for (RowErrors* to : { &expected, &slow })
      {
        to->Greatest[i % RowErrors::Lanes] = std::max(to->Greatest[i % RowErrors::Lanes], error);
        to->Squares[i % RowErrors::Lanes] += error * error;
        to->Low = std::min<std::int32_t>(to->Low, numbers[i]);
        to->High = std::max<std::int32_t>(to->High, numbers[i]);
      }
    }
    for (int lane = 0; lane < RowErrors::Lanes; ++lane)
    {
      ASSERT_EQ(row.Greatest[lane], expected.Greatest[lane]) << lane << " of " << count;
      ASSERT_EQ(row.Squares[lane], expected.Squares[lane]) << lane << " of " << count;
      ASSERT_EQ(sums.Greatest[lane], slow.Greatest[lane]) << lane << " up to " << count;
      ASSERT_EQ(sums.Squares[lane], slow.Squares[lane]) << lane << " up to " << count;
    }
    ASSERT_EQ(sums.Low, slow.Low);
    ASSERT_EQ(sums.High, slow.High);
    for (std::size_t i = 0; i < count; ++i)
    {
      for (const double bad : { double(NAN), -double(INFINITY), values[i] + 0.04 })
      {
        std::vector<T> spoilt = values;
        spoilt[i] = static_cast<T>(bad);
        RowErrors ignored;
        ASSERT_FALSE(ErrorsOnLattice(RowOf(spoilt, all), Scale, bound, ignored))
          << bad << " at " << i << " of " << count;
      }
    }
  }
}

TEST(QuantizedRows, ErrorsAreThoseOfEachValueAndWhatIsBeyondTheBoundIsTold)
{
  for (const std::int64_t target : targets::OfThisMachine())
  {
    SCOPED_TRACE(hwy::TargetName(target));
    const targets::OnlyTarget only(target);
    ExpectErrorsOfEveryCount<float, std::int16_t>();
    ExpectErrorsOfEveryCount<float, std::int32_t>();
    ExpectErrorsOfEveryCount<double, std::int16_t>();
    ExpectErrorsOfEveryCount<double, std::int32_t>();
  }
}

/// A box inside of larger arrays, whose values have gaps.
template <class T>
void ExpectBoxesOfAnyStrides(int gap)
{
  constexpr int count = 11, height = 5, slices = 3;
  const int row = count * gap + 4, slice = row * height + 7;
  const std::vector<T> values = SomeValues<T>(static_cast<std::size_t>(slice * slices));
  std::vector<std::int32_t> numbers(1000, 77);
  QuantizedRows<T, std::int32_t> rows;
  rows.Values = values.data();
  rows.Gap = gap;
  rows.ValueRow = row;
  rows.ValueSlice = slice;
  rows.Numbers = numbers.data();
  rows.NumberRow = 20;
  rows.NumberSlice = 200;
  rows.Count = count;
  rows.Rows = height;
  rows.Slices = slices;
  ASSERT_TRUE(QuantizeRows(rows, Scale));
  double greatest = 0;
  for (int i = 0; i < 1000; ++i)
  {
    const int x = i % 20, y = i / 20 % 10, z = i / 200;
    const bool inside = x < count && y < height && z < slices;
    const double value =
      inside ? values[static_cast<std::size_t>(z * slice + y * row + x * gap)] : 0;
    const std::int32_t number = numbers[static_cast<std::size_t>(i)];
    ASSERT_EQ(number, inside ? SlowNumber<std::int32_t>(value) : 77) << i;
    const T decoded = static_cast<T>(Scale.Origin + number * Scale.Step);
    greatest =
      inside ? std::max(greatest, std::abs(value - static_cast<double>(decoded))) : greatest;
  }
  QuantizedRows<T, const std::int32_t> all;
  all.Values = rows.Values;
  all.Gap = rows.Gap;
  all.ValueRow = rows.ValueRow;
  all.ValueSlice = rows.ValueSlice;
  all.Numbers = rows.Numbers;
  all.NumberRow = rows.NumberRow;
  all.NumberSlice = rows.NumberSlice;
  all.Count = rows.Count;
  all.Rows = rows.Rows;
  all.Slices = rows.Slices;
  RowErrors errors;
  ASSERT_TRUE(ErrorsOnLattice(all, Scale, greatest, errors));
  EXPECT_EQ(*std::max_element(std::begin(errors.Greatest), std::end(errors.Greatest)), greatest);
  EXPECT_FALSE(ErrorsOnLattice(all, Scale, std::nextafter(greatest, 0.0), errors));
}

TEST(QuantizedRows, BoxesOfAnyStridesAreTakenSampleBySample)
{
  for (const int gap : { 1, 3 })
  {
    ExpectBoxesOfAnyStrides<float>(gap);
    ExpectBoxesOfAnyStrides<double>(gap);
  }
}

} // namespace
} // namespace banyan
