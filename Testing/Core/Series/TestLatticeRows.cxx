#include "Series/LatticeRows.h"
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

using namespace banyan::testing;

const LatticeScale Scale{ 0.125, 0.03, -10, 130, -300, 4000 };

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
    ASSERT_TRUE(NumbersOnLattice(values.data(), count, Scale, numbers.data()));
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
        ASSERT_FALSE(NumbersOnLattice(spoilt.data(), count, Scale, numbers.data()))
          << bad << " at " << i << " of " << count;
      }
    }
  }
}

TEST(LatticeRows, NumbersAreTheNearestOnesAndWhatIsNotHeldIsTold)
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
    ASSERT_TRUE(AddRowErrors(values.data(), numbers.data(), count, Scale, bound, row));
    ASSERT_TRUE(AddRowErrors(values.data(), numbers.data(), count, Scale, bound, sums));
    RowErrors expected;
    for (std::size_t i = 0; i < count; ++i)
    {
      const T decoded =
        static_cast<T>(Scale.Origin + static_cast<double>(numbers[i]) * Scale.Step);
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
        ASSERT_FALSE(AddRowErrors(spoilt.data(), numbers.data(), count, Scale, bound, ignored))
          << bad << " at " << i << " of " << count;
      }
    }
  }
}

TEST(LatticeRows, ErrorsAreThoseOfEachValueAndWhatIsBeyondTheBoundIsTold)
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

} // namespace
} // namespace banyan
