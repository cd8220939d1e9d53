// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Series/Quantize/AdaptiveTransform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace banyan
{
namespace
{

ValueHistogram HistogramOf(const std::vector<double>& values)
{
  ValueHistogram histogram;
  histogram.Add(values.data(), values.size());
  return histogram;
}

/// Slope over an interval, as f itself says.
double SlopeOver(const Transform& transform, double low, double high)
{
  return (transform.Forward(high) - transform.Forward(low)) / (high - low);
}

/// Values in the middles of cells, so that no bin of the histogram straddles an edge.
std::vector<double> InCells(double low, double high, const std::vector<int>& counts)
{
  std::vector<double> values;
  for (std::size_t c = 0; c < counts.size(); ++c)
  {
    const double middle =
      low + (high - low) * (static_cast<double>(c) + 0.5) / static_cast<double>(counts.size());
    values.insert(values.end(), static_cast<std::size_t>(counts[c]), middle);
  }
  return values;
}

/// The documented formula over values one by one.
std::vector<double> ExpectedSlopes(const std::vector<int>& counts, const AdaptiveRule& rule)
{
  double total = 0.0;
  for (const int count : counts)
  {
    total += count;
  }
  const double cells = static_cast<double>(counts.size());
  const double w = rule.Equalization;
  const double cap = (rule.SlopeRatio - 1.0) * (1.0 - w) / w;
  std::vector<double> slopes;
  double mean = 0.0;
  for (const int count : counts)
  {
    slopes.push_back((1.0 - w) + w * std::min(count * cells / total, cap));
    mean += slopes.back() / cells;
  }
  for (double& slope : slopes)
  {
    slope /= mean;
  }
  return slopes;
}

TEST(AdaptiveTransform, FollowsTheFormula)
{
  std::mt19937 random(21);
  for (const ValueRange& range : { ValueRange{ 1.0, 5.0 }, ValueRange{ -7.0, -3.0 },
         ValueRange{ -8.0, 8.0 }, ValueRange{ 1e-40, 9e-40 }, ValueRange{ -1e38, 3e38 } })
  {
    for (int round = 0; round < 10; ++round)
    {
      AdaptiveRule rule;
      rule.Cells = 16;
      rule.Equalization = round % 2 == 0 ? 0.75 : 0.9;
      rule.SlopeRatio = round % 3 == 0 ? 4.0 : 100.0;
      std::vector<int> counts(16);
      for (int& count : counts)
      {
        count = random() % 4 == 0 ? 0 : static_cast<int>(random() % (round < 5 ? 10 : 500));
      }
      counts[3] = 1000 * (round % 2);
      counts[5] = 1;
      const ValueHistogram histogram = HistogramOf(InCells(range.Low, range.High, counts));
      const Transform transform = MakeAdaptive(histogram, range, rule);
      ASSERT_EQ(transform.Kind(), TransformKind::Table);
      const std::vector<double> expected = ExpectedSlopes(counts, rule);
      for (std::size_t c = 0; c < counts.size(); ++c)
      {
        const double low = range.Low + range.Width() * static_cast<double>(c) / 16.0;
        const double high = low + range.Width() / 16.0;
        EXPECT_NEAR(SlopeOver(transform, low, high), expected[c], 1e-9) << c;
      }
      EXPECT_NEAR(transform.TransformedWidth(range) / range.Width(), 1.0, 1e-12);
    }
  }
}

TEST(AdaptiveTransform, HasTheErrorsItPromises)
{
  std::mt19937_64 random(22);
  std::vector<double> values;
  for (int i = 0; i < 50000; ++i)
  {
    values.push_back(std::normal_distribution<>(3.0, 0.01)(random));
    values.push_back(std::uniform_real_distribution<>(-1.0, 9.0)(random));
  }
  values.insert(values.end(), 300000, 7.25); // an ambient value
  const ValueHistogram histogram = HistogramOf(values);
  const ValueRange range = histogram.Range();
  AdaptiveRule rule;
  rule.Equalization = 0.8;
  rule.SlopeRatio = 40.0;
  const Transform transform = MakeAdaptive(histogram, range, rule);
  const auto& knots = transform.Knots();
  EXPECT_LE(knots.size(), 258u);
  double least = INFINITY;
  double greatest = 0.0;
  for (std::size_t i = 1; i < knots.size(); ++i)
  {
    const double slope = (knots[i].Y - knots[i - 1].Y) / (knots[i].X - knots[i - 1].X);
    least = std::min(least, slope);
    greatest = std::max(greatest, slope);
  }
  EXPECT_GE(least, 1.0 - rule.Equalization);
  EXPECT_LE(greatest / least, rule.SlopeRatio * (1.0 + 1e-9));
  EXPECT_GT(greatest / least, 0.6 * rule.SlopeRatio);
  // More levels where there are more values: with as many levels, the mean squared error is less.
  const double step = range.Width() / 256.0;
  double uniform = 0.0;
  double adaptive = 0.0;
  for (const double value : values)
  {
    const double plain = std::nearbyint((value - range.Low) / step) * step + range.Low;
    const double y = transform.Forward(value);
    const double curved = transform.Inverse(std::nearbyint(y / step) * step);
    EXPECT_LE(std::abs(curved - value), 0.5 * step / (1.0 - rule.Equalization) * (1 + 1e-9));
    uniform += (plain - value) * (plain - value);
    adaptive += (curved - value) * (curved - value);
  }
  EXPECT_LT(adaptive, 0.5 * uniform);
}

TEST(AdaptiveTransform, ZeroIsAKnotAndNeedsNoLevels)
{
  // No edge of ten cells lies at 0 by itself: one is moved, added, or the end itself.
  for (const ValueRange& range : { ValueRange{ -1.0, 2.9 }, ValueRange{ -1.0, 2.2 },
         ValueRange{ -1e-9, 1.0 }, ValueRange{ -0.01, 1.0 }, ValueRange{ 0.0, 1.0 },
         ValueRange{ -1.0, 0.0 }, ValueRange{ -1.0, 1e-12 } })
  {
    AdaptiveRule rule;
    rule.Cells = 10;
    std::mt19937_64 random(23);
    std::vector<double> values;
    for (int i = 0; i < 1000; ++i)
    {
      values.push_back(std::uniform_real_distribution<>(range.Low, range.High)(random));
    }
    const Transform without = MakeAdaptive(HistogramOf(values), range, rule);
    values.insert(values.end(), 100000, 0.0);
    const Transform with = MakeAdaptive(HistogramOf(values), range, rule);
    EXPECT_EQ(with.Forward(0.0), 0.0);
    EXPECT_EQ(with.Inverse(0.0), 0.0);
    EXPECT_TRUE(with == without);
    EXPECT_LE(with.Knots().size(), 12u);
    EXPECT_NEAR(with.TransformedWidth(range), range.Width(), 1e-6 * range.Width());
  }
}

TEST(AdaptiveTransform, ZeroIsAKnotBetweenEqualSlopesToo)
{
  AdaptiveRule rule;
  rule.Equalization = 0.0;
  const Transform transform = MakeAdaptive(HistogramOf({ 1.0 }), { -0.3, 7.7 }, rule);
  ASSERT_EQ(transform.Knots().size(), 3u);
  EXPECT_EQ(transform.Knots()[1].X, 0.0);
  EXPECT_EQ(transform.Knots()[1].Y, 0.0);
}

/// A bin reaches over the edge of a cell, the values in it do not.
TEST(AdaptiveTransform, BinsEndWhereTheDataEnd)
{
  AdaptiveRule rule;
  rule.Cells = 2;
  const Transform below = MakeAdaptive(HistogramOf({ -3.0, -3.0 }), { -6.0, 0.0 }, rule);
  EXPECT_GT(SlopeOver(below, -3.0, 0.0), 2.0 * SlopeOver(below, -6.0, -3.0));
  const double last = std::nextafter(3.001, 0.0);
  const Transform above = MakeAdaptive(HistogramOf({ last, last }), { 0.002, 6.0 }, rule);
  EXPECT_GT(SlopeOver(above, 0.002, 3.001), 2.0 * SlopeOver(above, 3.001, 6.0));
}

TEST(AdaptiveTransform, DoesNotDependOnOrder)
{
  std::mt19937_64 random(24);
  std::vector<double> values;
  for (int i = 0; i < 20000; ++i)
  {
    values.push_back(std::normal_distribution<>(0.0, 2.0)(random));
  }
  const Transform one = MakeAdaptive(HistogramOf(values), { -3.0, 5.0 });
  std::shuffle(values.begin(), values.end(), random);
  values.front() = -values.front() + values.front() * 2.0; // the same number, computed
  EXPECT_TRUE(one == MakeAdaptive(HistogramOf(values), { -3.0, 5.0 }));
}

TEST(AdaptiveTransform, DegenerateDataGiveTheIdentity)
{
  EXPECT_TRUE(MakeAdaptive({}, { 0.0, 1.0 }).IsIdentity());
  EXPECT_TRUE(MakeAdaptive(HistogramOf({ 3.0, 3.0 }), { 3.0, 3.0 }).IsIdentity());
  EXPECT_TRUE(MakeAdaptive(HistogramOf({ 7.0 }), { 0.0, 1.0 }).IsIdentity()) << "none within";
  EXPECT_TRUE(MakeAdaptive(HistogramOf({ 0.0 }), { 0.0, 1.0 }).IsIdentity()) << "zeros alone";
  const double next = std::nextafter(1e6, 2e6);
  EXPECT_TRUE(MakeAdaptive(HistogramOf({ 1e6, next }), { 1e6, next }).IsIdentity());
  EXPECT_TRUE(MakeAdaptive(HistogramOf({ 5e-324 }), { 0.0, 1e-320 }).IsIdentity());
  AdaptiveRule uniform;
  uniform.Equalization = 0.0;
  EXPECT_NEAR(MakeAdaptive(HistogramOf({ 0.1 }), { 0.0, 1.0 }, uniform).Forward(0.3), 0.3, 1e-12);
  const auto reject = [](AdaptiveRule rule, const ValueRange& range)
  { EXPECT_THROW((void)MakeAdaptive(HistogramOf({ 0.5 }), range, rule), Error); };
  reject({}, {});
  reject({}, { 0.0, INFINITY });
  reject({}, { NAN, 1.0 });
  reject({ 1.0, 64.0, 256 }, { 0.0, 1.0 });
  reject({ -0.1, 64.0, 256 }, { 0.0, 1.0 });
  reject({ NAN, 64.0, 256 }, { 0.0, 1.0 });
  reject({ 0.5, 0.9, 256 }, { 0.0, 1.0 });
  reject({ 0.5, 1e9, 256 }, { 0.0, 1.0 });
  reject({ 0.5, 2.0, 0 }, { 0.0, 1.0 });
  reject({ 0.5, 2.0, 4095 }, { 0.0, 1.0 });
}

TEST(AdaptiveTransform, ExtremeRulesGiveTables)
{
  std::mt19937_64 random(25);
  std::vector<double> values;
  for (int i = 0; i < 100000; ++i)
  {
    values.push_back(std::uniform_real_distribution<>(-1.0, 1.7)(random));
  }
  AdaptiveRule rule{ 0.999, 0x1p20, AdaptiveRule::GreatestCells };
  const Transform transform = MakeAdaptive(HistogramOf(values), { -1.0, 1.7 }, rule);
  EXPECT_GT(transform.Knots().size(), 4000u);
  EXPECT_EQ(transform.Inverse(0.0), 0.0);
}

TEST(AsinhScale, IsAPercentileOfMagnitudes)
{
  std::vector<double> values(5000, 0.0);
  for (int i = 1; i <= 1000; ++i)
  {
    values.push_back(i % 2 == 0 ? i : -i);
  }
  const ValueHistogram histogram = HistogramOf(values);
  AsinhRule rule;
  EXPECT_NEAR(AsinhScale(histogram, histogram.Range(), rule), 100.0, 0.1);
  rule.Share = 0.5;
  EXPECT_NEAR(AsinhScale(histogram, histogram.Range(), rule), 500.0, 0.5);
  rule.Share = 0.0;
  rule.LeastShareOfGreatest = 0.25;
  EXPECT_EQ(AsinhScale(histogram, histogram.Range(), rule), 250.0);
  EXPECT_EQ(AsinhScale(histogram, { -10.0, 20.0 }, rule), 5.0);
  rule.Share = 1.0;
  EXPECT_EQ(AsinhScale(histogram, { -10.0, 20.0 }, rule), 20.0);
  EXPECT_EQ(AsinhScale(HistogramOf({ 0.0 }), { 0.0, 0.0 }), 1.0);
  EXPECT_EQ(AsinhScale({}, {}), 1.0);
  EXPECT_EQ(AsinhScale(HistogramOf({ 5e-324 }), { 0.0, 5e-324 }), 0x1p-1000);
  rule.Share = 1.5;
  EXPECT_THROW((void)AsinhScale(histogram, histogram.Range(), rule), Error);
}

} // namespace
} // namespace banyan
