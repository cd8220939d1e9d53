// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Series/Quantize/OpacityWeight.h"
#include "Series/Quantize/QuantizationError.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace banyan
{
namespace
{

OpacityFunction SomeOpacity()
{
  return OpacityFunction({ { -2.0, 0.0 }, { 0.0, 0.0 }, { 1.0, 0.5 }, { 2.0, 0.0 }, { 3.0, 0.0 },
    { 4.0, 0.0 }, { 5.0, 1.0 }, { 6.0, 0.0 }, { 7.0, 0.25 } });
}

TEST(OpacityFunction, IsLinearBetweenKnotsAndConstantBeyond)
{
  const OpacityFunction opacity = SomeOpacity();
  EXPECT_EQ(opacity(-100.0), 0.0);
  EXPECT_EQ(opacity(0.5), 0.25);
  EXPECT_EQ(opacity(1.0), 0.5);
  EXPECT_EQ(opacity(1.5), 0.25);
  EXPECT_EQ(opacity(7.0), 0.25);
  EXPECT_EQ(opacity(INFINITY), 0.25);
  EXPECT_EQ(opacity(-INFINITY), 0.0);
  EXPECT_EQ(opacity(NAN), 0.0);
  EXPECT_EQ(OpacityFunction({ { -1e308, 0.0 }, { 1e308, 1.0 } })(0.0), 0.5);
  EXPECT_EQ(OpacityFunction({ { 3.0, 0.75 } })(-9.0), 0.75);
}

TEST(OpacityFunction, NonsenseIsRejected)
{
  const std::vector<std::vector<OpacityKnot>> bad = { {}, { { 0, -0.1 } }, { { 0, 1.1 } },
    { { 0, NAN } }, { { NAN, 0 } }, { { INFINITY, 0 } }, { { 1, 0 }, { 1, 1 } },
    { { 1, 0 }, { 0, 1 } } };
  for (std::size_t i = 0; i < bad.size(); ++i)
  {
    EXPECT_THROW(OpacityFunction{ bad[i] }, Error) << i;
  }
}

TEST(InvisibleIntervals, AreMaximal)
{
  const InvisibleIntervals intervals(SomeOpacity());
  // 6 alone is invisible as well, but one value is no interval.
  ASSERT_EQ(intervals.Intervals().size(), 2u);
  EXPECT_EQ(intervals.Intervals()[0].Low, -INFINITY);
  EXPECT_EQ(intervals.Intervals()[0].High, 0.0);
  EXPECT_EQ(intervals.Intervals()[1].Low, 2.0);
  EXPECT_EQ(intervals.Intervals()[1].High, 4.0);
  EXPECT_TRUE(InvisibleIntervals().Intervals().empty());
  EXPECT_TRUE(InvisibleIntervals(OpacityFunction({ { 0.0, 1.0 } })).Intervals().empty());
  const InvisibleIntervals nothing(OpacityFunction({ { 0.0, 0.0 } }));
  EXPECT_TRUE(nothing.Invisible(-INFINITY, INFINITY));
  const InvisibleIntervals above(OpacityFunction({ { 0.0, 1.0 }, { 1.0, 0.0 } }));
  EXPECT_TRUE(above.Invisible(1.0, INFINITY));
  EXPECT_FALSE(above.Invisible(0.999, 2.0));
}

TEST(InvisibleIntervals, AnswerQueries)
{
  const InvisibleIntervals intervals(SomeOpacity());
  EXPECT_EQ(intervals.IntervalOf(0.0), 0);
  EXPECT_EQ(intervals.IntervalOf(std::nextafter(0.0, 1.0)), -1);
  EXPECT_EQ(intervals.IntervalOf(2.0), 1);
  EXPECT_EQ(intervals.IntervalOf(std::nextafter(2.0, 0.0)), -1);
  EXPECT_EQ(intervals.IntervalOf(4.0), 1);
  EXPECT_EQ(intervals.IntervalOf(9.0), -1);
  EXPECT_EQ(intervals.IntervalOf(NAN), -1);
  EXPECT_TRUE(intervals.Invisible(2.0, 4.0));
  EXPECT_FALSE(intervals.Invisible(-1.0, 3.0)) << "two intervals, and visible values between";
  EXPECT_FALSE(intervals.Invisible(4.0, 2.0));
  EXPECT_FALSE(intervals.Invisible(NAN, 3.0));
  EXPECT_FALSE(intervals.Invisible(2.5, NAN));
  EXPECT_TRUE(intervals.MayDecodeTo(2.1, 3.9, 0.0));
  EXPECT_TRUE(intervals.MayDecodeTo(3.9, 2.1, 0.0));
  EXPECT_FALSE(intervals.MayDecodeTo(3.9, 4.1, 0.1));
  EXPECT_TRUE(intervals.MayDecodeTo(3.9, 4.0625, 0.25));
  EXPECT_TRUE(intervals.MayDecodeTo(5.0, 5.25, 0.25));
  EXPECT_FALSE(intervals.MayDecodeTo(NAN, 2.0, 1.0));
  EXPECT_FALSE(intervals.MayDecodeTo(2.0, NAN, 1.0));
  EXPECT_FALSE(intervals.MayDecodeTo(NAN, NAN, 1.0));
  EXPECT_TRUE(intervals.MayDecodeTo(INFINITY, INFINITY, 0.0));
  EXPECT_FALSE(intervals.MayDecodeTo(INFINITY, 5.0, 1.0));
}

/// Whether a range is invisible must be what looking at many of its values says.
TEST(InvisibleIntervals, AgreeWithTheFunction)
{
  std::mt19937 random(31);
  for (int round = 0; round < 200; ++round)
  {
    std::vector<OpacityKnot> knots;
    for (int i = 0; i < 8; ++i)
    {
      knots.push_back({ static_cast<double>(i), random() % 3 == 0 ? 0.5 : 0.0 });
    }
    const OpacityFunction opacity(knots);
    const InvisibleIntervals intervals(opacity);
    for (int low = -4; low < 36; ++low)
    {
      for (int high = low + 1; high < 36; ++high)
      {
        bool anyVisible = false;
        for (int i = 4 * low; i <= 4 * high; ++i)
        {
          anyVisible = anyVisible || opacity(i / 16.0) > 0;
        }
        ASSERT_EQ(intervals.Invisible(low / 4.0, high / 4.0), !anyVisible) << low << " " << high;
      }
    }
  }
}

TEST(QuantizationError, EquationsAgainstAComputationByHand)
{
  const OpacityFunction opacity({ { 0.0, 0.0 }, { 4.0, 1.0 } });
  const std::vector<float> original = { 0.0f, 1.0f, 2.0f, 4.0f, NAN };
  const std::vector<float> decoded = { 1.0f, 0.5f, 2.0f, 4.5f, NAN };
  QuantizationError error;
  AddErrors(error, Transform(), &opacity, original.data(), decoded.data(), original.size());
  EXPECT_EQ(error.Count, 4);
  EXPECT_EQ(error.Greatest, 1.0);
  // (1 + 1/4 + 0 + 1/4) / 4, and (0 * 1 + 1/4 * 1/4 + 1/2 * 0 + 1 * 1/4) / 4
  EXPECT_EQ(error.MeanSquared(), 0.375);
  EXPECT_EQ(error.OpacityWeighted(), 0.078125);
  EXPECT_EQ(error.SumOpacity, 1.75);
  EXPECT_EQ(error.GreatestTransformed, 1.0);
  EXPECT_EQ(error.MeanSquaredTransformed(), 0.375);
  EXPECT_NEAR(ShareOfSquaredRange(error.OpacityWeighted(), { 0.0, 4.0 }), 0.0048828125, 1e-15);
  EXPECT_NEAR(RootShareOfRange(error.MeanSquared(), { 0.0, 4.0 }), std::sqrt(0.375) / 4.0, 1e-15);
  EXPECT_EQ(ShareOfSquaredRange(1.0, {}), 0.0);
  EXPECT_EQ(QuantizationError().MeanSquared(), 0.0);
  EXPECT_EQ(QuantizationError().OpacityWeighted(), 0.0);
}

TEST(QuantizationError, WithoutOpacityBothEquationsAreTheSame)
{
  const std::vector<std::uint8_t> original = { 0, 200, 255 };
  const std::vector<std::uint8_t> decoded = { 255, 190, 255 };
  QuantizationError error;
  AddErrors(error, Transform(), nullptr, original.data(), decoded.data(), 3);
  EXPECT_EQ(error.Greatest, 255.0);
  EXPECT_EQ(error.SumSquared, 65125.0);
  EXPECT_EQ(error.OpacityWeighted(), error.MeanSquared());
}

TEST(QuantizationError, MeasuresInTheTransformedDomain)
{
  const Transform table = Transform::Table({ { 0.0, 0.0 }, { 1.0, 10.0 }, { 100.0, 11.0 } });
  const std::vector<double> original = { 0.5, 10.0 };
  const std::vector<double> decoded = { 0.25, 43.0 };
  QuantizationError error;
  AddErrors(error, table, nullptr, original.data(), decoded.data(), 2);
  EXPECT_EQ(error.Greatest, 33.0);
  EXPECT_NEAR(error.GreatestTransformed, 2.5, 1e-12);
}

TEST(QuantizationError, LostValuesAreInfinitelyFar)
{
  const std::vector<float> original = { 1.0f, 2.0f };
  const std::vector<float> decoded = { NAN, 2.0f };
  QuantizationError error;
  AddErrors(error, Transform(), nullptr, original.data(), decoded.data(), 2);
  EXPECT_EQ(error.Greatest, INFINITY);
  EXPECT_EQ(error.GreatestTransformed, INFINITY);
  EXPECT_EQ(error.MeanSquared(), INFINITY);
}

/// Equation 1 in closed form, the sum over 200,000 values, and parts merged.
TEST(QuantizationError, UniformQuantizerHasTheErrorOfEquationOne)
{
  const ValueRange range{ -3.0, 5.0 };
  const std::int64_t levels = 256;
  const double step = range.Width() / static_cast<double>(levels);
  std::mt19937_64 random(32);
  QuantizationError whole;
  QuantizationError merged;
  for (int part = 0; part < 20; ++part)
  {
    std::vector<double> original;
    std::vector<double> decoded;
    for (int i = 0; i < 10000; ++i)
    {
      const double x = std::uniform_real_distribution<>(range.Low, range.High)(random);
      original.push_back(x);
      decoded.push_back(range.Low + (std::floor((x - range.Low) / step) + 0.5) * step);
    }
    QuantizationError some;
    AddErrors(some, Transform(), nullptr, original.data(), decoded.data(), original.size());
    AddErrors(whole, Transform(), nullptr, original.data(), decoded.data(), original.size());
    merged.Merge(some);
  }
  const double expected = UniformQuantizerError(range, levels);
  EXPECT_DOUBLE_EQ(expected, step * step / 12.0);
  EXPECT_NEAR(whole.MeanSquared(), expected, 0.01 * expected);
  EXPECT_NEAR(merged.MeanSquared(), whole.MeanSquared(), 1e-12 * expected);
  EXPECT_EQ(merged.Count, whole.Count);
  EXPECT_EQ(merged.Greatest, whole.Greatest);
  EXPECT_LT(ShareOfSquaredRange(expected, range), 0.01);
  EXPECT_LT(RootShareOfRange(expected, range), 0.01);
  EXPECT_THROW((void)UniformQuantizerError(range, 0), Error);
}

} // namespace
} // namespace banyan
