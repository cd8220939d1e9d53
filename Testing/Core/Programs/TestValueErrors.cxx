// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesTesting.h"

#include "ValueErrors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace banyan
{
namespace
{

using namespace testing;

constexpr double Infinity = std::numeric_limits<double>::infinity();

template <class T>
class ValueErrorsOf : public ::testing::Test
{
};

using AllTypes = ::testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
  std::int32_t, std::uint32_t, std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(ValueErrorsOf, AllTypes);

/// Value by value, with nothing in common with the fast way but its meaning.
template <class T>
ValueErrors Slowly(
  const std::vector<T>& original, int stride, const std::vector<T>& decoded, const Judgement& rule)
{
  ValueErrors errors;
  for (std::size_t i = 0; i < decoded.size(); ++i)
  {
    const T a = original[i * static_cast<std::size_t>(stride)];
    const T b = decoded[i];
    const long double error = std::abs(static_cast<long double>(a) - static_cast<long double>(b));
    ++errors.Finite;
    errors.Range.Include(static_cast<double>(a));
    errors.OutOfBound += error > static_cast<long double>(rule.Bound) ? 1 : 0;
    errors.OtherClass +=
      rule.Classes.ClassOf(static_cast<double>(a)) != rule.Classes.ClassOf(static_cast<double>(b))
        ? 1
        : 0;
    errors.SumSquared += static_cast<double>(error * error);
    errors.SumWeighted +=
      static_cast<double>(error * error) * (*rule.Opacity)(static_cast<double>(a));
    if (static_cast<double>(error) > errors.Greatest)
    {
      errors.Greatest = errors.WorstError = static_cast<double>(error);
      errors.Worst = static_cast<std::int64_t>(i);
    }
  }
  return errors;
}

TYPED_TEST(ValueErrorsOf, AreThoseOfASlowComparison)
{
  using T = TypeParam;
  std::mt19937 random(11);
  // More than one part of work, and not a multiple.
  const std::size_t count = 150001;
  std::vector<T> original(2 * count, T(7));
  std::vector<T> decoded(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    original[2 * i] = static_cast<T>(10 + random() % 90);
    decoded[i] = static_cast<T>(static_cast<double>(original[2 * i]) + random() % 5 - 2);
  }
  const OpacityFunction opacity({ { 10, 0 }, { 50, 1 }, { 99, 0.25 } });
  const Judgement rule{ 1.0, {}, ValueClasses({ 10, 99 }), &opacity };
  const ValueErrors slow = Slowly(original, 2, decoded, rule);
  for (const int threads : { 1, 3 })
  {
    ThreadPool pool(threads);
    const ValueErrors fast = CompareValues(ScalarTypeOf<T>(), original.data(), 2, decoded.data(),
      static_cast<std::int64_t>(count), rule, pool);
    EXPECT_EQ(fast.Finite, slow.Finite);
    EXPECT_EQ(fast.NonFinite, 0);
    EXPECT_EQ(fast.OutOfBound, slow.OutOfBound);
    EXPECT_GT(fast.OutOfBound, 0);
    EXPECT_EQ(fast.OtherClass, slow.OtherClass);
    EXPECT_EQ(fast.Greatest, 2.0);
    EXPECT_EQ(fast.SumSquared, slow.SumSquared); // whole numbers: exact in any order
    EXPECT_NEAR(fast.SumWeighted, slow.SumWeighted, 1e-9 * slow.SumWeighted);
    EXPECT_EQ(fast.Range.Low, slow.Range.Low);
    EXPECT_EQ(fast.Range.High, slow.Range.High);
    EXPECT_EQ(fast.Worst, slow.Worst);
    EXPECT_EQ(fast.WorstError, 2.0);
    EXPECT_FALSE(fast.Proven());
  }
}

template <class T>
ValueErrors Compare(const std::vector<T>& original, const std::vector<T>& decoded, double bound)
{
  ThreadPool pool(1);
  return CompareValues(ScalarTypeOf<T>(), original.data(), 1, decoded.data(),
    static_cast<std::int64_t>(original.size()), { bound, {}, ValueClasses({ 0, 1 }), nullptr },
    pool);
}

TEST(ValueErrors, DecideToTheLastBit)
{
  // 0.3f - 0.1f is not 0.2 in any precision: the bound is what the subtraction gives, exactly.
  const double exact = static_cast<double>(0.3f) - static_cast<double>(0.1f);
  EXPECT_TRUE(Compare<float>({ 0.1f }, { 0.3f }, exact).Proven());
  EXPECT_FALSE(Compare<float>({ 0.1f }, { 0.3f }, std::nextafter(exact, 0.0)).Proven());
  // A difference that a double rounds down to the bound.
  const double a = 1.0;
  const double b = -std::ldexp(1.0, -60);
  EXPECT_EQ(a - b, 1.0);
  EXPECT_FALSE(Compare<double>({ a }, { b }, 1.0).Proven());
  EXPECT_TRUE(Compare<double>({ a }, { b }, std::nextafter(1.0, 2.0)).Proven());
  // Whole numbers beyond those of a double.
  const std::int64_t big = std::int64_t{ 1 } << 60;
  EXPECT_TRUE(Compare<std::int64_t>({ big }, { big + 3 }, 3.0).Proven());
  EXPECT_FALSE(Compare<std::int64_t>({ big }, { big + 4 }, 3.0).Proven());
  const std::int64_t least = std::numeric_limits<std::int64_t>::min();
  EXPECT_FALSE(
    Compare<std::int64_t>({ least }, { std::numeric_limits<std::int64_t>::max() }, 1e18).Proven());
  EXPECT_TRUE(Compare<std::uint64_t>({ 0 }, { UINT64_MAX }, 18446744073709551616.0).Proven());
}

TEST(ValueErrors, WithATransformTheBoundIsOneOnWhatValuesBecome)
{
  // asinh is nearly the identity for 0.1 and nearly the logarithm for 1000.
  const std::vector<float> original{ 0.1f, 1000.0f, std::nanf("") };
  const std::vector<float> decoded{ 0.11f, 1005.0f, original[2] };
  ThreadPool pool(1);
  const auto compare = [&](double bound)
  {
    return CompareValues(ScalarType::Float32, original.data(), 1, decoded.data(), 3,
      { bound, Transform::Asinh(1.0), ValueClasses({ 0, 1 }), nullptr }, pool);
  };
  const double low = std::asinh(double{ decoded[0] }) - std::asinh(double{ original[0] });
  const double high = std::asinh(double{ decoded[1] }) - std::asinh(double{ original[1] });
  ASSERT_LT(high, low);
  EXPECT_TRUE(compare(1.0001 * low).Proven());
  EXPECT_EQ(compare(0.9999 * low).OutOfBound, 1);
  EXPECT_EQ(compare(0.9999 * high).OutOfBound, 2);
  EXPECT_EQ(compare(1.0).Greatest, 5.0);
  EXPECT_NEAR(compare(1.0).GreatestJudged, low, 1e-12);
  EXPECT_EQ(compare(1.0).Worst, 0);
}

TEST(ValueErrors, NaNAndInfinitiesMustKeepTheirBits)
{
  const float nan = std::nanf("1");
  const float other = std::nanf("2");
  const float inf = static_cast<float>(Infinity);
  EXPECT_TRUE(Compare<float>({ nan, inf, -inf }, { nan, inf, -inf }, 0.0).Proven());
  for (const auto& [before, after] : std::vector<std::pair<float, float>>{
         { nan, other }, { nan, -nan }, { inf, -inf }, { inf, 3.0f }, { nan, 0.0f } })
  {
    const ValueErrors errors = Compare<float>({ 1.0f, before }, { 1.5f, after }, 1e9);
    EXPECT_EQ(errors.NonFinite, 1);
    EXPECT_EQ(errors.NonFiniteChanged, 1);
    EXPECT_EQ(errors.Finite, 1);
    EXPECT_EQ(errors.Greatest, 0.5);
    EXPECT_EQ(errors.Worst, 1);
    EXPECT_EQ(errors.WorstError, Infinity);
    EXPECT_FALSE(errors.Proven());
  }
}

TEST(ValueErrors, FiniteValuesMustStayFinite)
{
  for (const double after : { std::nan(""), Infinity })
  {
    const ValueErrors errors = Compare<double>({ 1.0, 2.0 }, { 1.0, after }, 1e300);
    EXPECT_EQ(errors.OutOfBound, 1);
    EXPECT_EQ(errors.Greatest, Infinity);
    EXPECT_EQ(errors.Worst, 1);
    EXPECT_FALSE(errors.Proven());
  }
}

TEST(ValueErrors, NothingWrongHasNoWorst)
{
  const ValueErrors errors = Compare<float>({ 1.0f, -0.0f }, { 1.0f, 0.0f }, 0.0);
  EXPECT_EQ(errors.Worst, -1);
  EXPECT_TRUE(errors.Proven());
  EXPECT_EQ(errors.Rmse(), 0.0);
  EXPECT_EQ(ValueErrors{}.MeanSquared(), 0.0);
  EXPECT_EQ(ValueErrors{}.OtherClassShare(), 0.0);
}

TEST(ValueErrors, MergingInOrderKeepsTheFirstOfTheWorst)
{
  ValueErrors all;
  all.Merge(Compare<float>({ 0, 0 }, { 0, 1 }, 0.5), 0);
  all.Merge(Compare<float>({ 0, 0 }, { 1, 0 }, 0.5), 2);
  EXPECT_EQ(all.Worst, 1);
  all.Merge(Compare<float>({ 0, 0 }, { 0, 2 }, 0.5), 4);
  EXPECT_EQ(all.Worst, 5);
  EXPECT_EQ(all.WorstError, 2.0);
  EXPECT_EQ(all.OutOfBound, 3);
  EXPECT_EQ(all.Finite, 6);
  EXPECT_DOUBLE_EQ(all.MeanSquared(), 1.0);
}

TEST(ValueClasses, AreEquallyWideAndTakeEveryValue)
{
  const ValueClasses classes({ 0.0, 256.0 });
  for (int number = 0; number < 256; ++number)
  {
    EXPECT_EQ(classes.ClassOf(number), number);
    EXPECT_EQ(classes.ClassOf(number + 0.999), number);
  }
  EXPECT_EQ(classes.ClassOf(256.0), 255);
  EXPECT_EQ(classes.ClassOf(-1e300), 0);
  EXPECT_EQ(classes.ClassOf(INFINITY), 255);
  EXPECT_EQ(classes.ClassOf(std::nan("")), 0);
  const double most = std::numeric_limits<double>::max();
  EXPECT_EQ(ValueClasses({ -most, most }).ClassOf(0.0), 128);
  EXPECT_EQ(ValueClasses({ 3.0, 3.0 }).ClassOf(4.0), 0);
  EXPECT_EQ(ValueClasses(ValueRange()).ClassOf(4.0), 0);
}

} // namespace
} // namespace banyan
