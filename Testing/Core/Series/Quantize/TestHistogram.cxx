// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Series/Quantize/Histogram.h"
#include "Series/Quantize/RangeRule.h"

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

/// Decades of magnitudes, both signs, zeros; denormals and huge ones among them.
std::vector<double> SomeValues(unsigned seed, std::size_t count)
{
  std::mt19937_64 random(seed);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i)
  {
    const double magnitude = std::exp2(std::normal_distribution<>(0.0, 12.0)(random));
    values.push_back(random() % 10 == 0 ? 0.0 : random() % 3 == 0 ? -magnitude : magnitude);
  }
  return values;
}

bool Same(const ValueHistogram& a, const ValueHistogram& b)
{
  const auto x = a.Message();
  const auto y = b.Message();
  return a.FiniteCount() == b.FiniteCount() && x.NonFinite == y.NonFinite &&
         x.Range.Low == y.Range.Low && x.Range.High == y.Range.High &&
         std::equal(x.Entries.begin(), x.Entries.end(), y.Entries.begin(), y.Entries.end(),
           [](const HistogramEntry& p, const HistogramEntry& q)
           { return p.Bin == q.Bin && p.Count == q.Count; });
}

TEST(Histogram, EveryValueLiesInItsBin)
{
  std::vector<double> values = SomeValues(1, 2000);
  for (const double special : { 0.0, -0.0, 1e-40, -1e-40, 5e-324, -5e-324, 1e38, -1e38, 1.0, -1.0,
         2.0, std::nextafter(2.0, 0.0), 1.7976931348623157e308, -1.7976931348623157e308 })
  {
    values.push_back(special);
  }
  for (const double value : values)
  {
    ValueHistogram histogram;
    histogram.Add(&value, 1);
    const std::vector<HistogramBin> bins = histogram.Bins();
    ASSERT_EQ(bins.size(), 1u);
    EXPECT_EQ(bins[0].Count, 1u);
    EXPECT_LE(bins[0].Low, value);
    EXPECT_GE(bins[0].High, value);
    EXPECT_LE(bins[0].High - bins[0].Low, std::max(std::abs(value) / 2048.0, 0x1p-1033));
    EXPECT_TRUE(value != 0.0 || bins[0].High == bins[0].Low);
    // The end nearer to zero belongs to the bin, the other does not.
    const bool largest = std::abs(value) > 1e308;
    EXPECT_TRUE(
      value == 0.0 || largest || (value > 0 ? value < bins[0].High : value > bins[0].Low));
  }
}

TEST(Histogram, BinsAreOrderedAndDisjoint)
{
  const std::vector<double> values = SomeValues(2, 50000);
  ValueHistogram histogram;
  histogram.Add(values.data(), values.size());
  const std::vector<HistogramBin> bins = histogram.Bins();
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < bins.size(); ++i)
  {
    EXPECT_TRUE(i == 0 || bins[i - 1].High <= bins[i].Low);
    total += bins[i].Count;
  }
  EXPECT_EQ(total, values.size());
  EXPECT_EQ(histogram.Range().Low, *std::min_element(values.begin(), values.end()));
  EXPECT_EQ(histogram.Range().High, *std::max_element(values.begin(), values.end()));
}

TEST(Histogram, WhatIsNotFiniteIsOnlyCounted)
{
  const std::vector<float> values = { NAN, 1.0f, INFINITY, -INFINITY, 2.0f };
  ValueHistogram histogram;
  histogram.Add(values.data(), values.size());
  EXPECT_EQ(histogram.FiniteCount(), 2u);
  EXPECT_EQ(histogram.NonFiniteCount(), 3u);
  EXPECT_EQ(histogram.Range().High, 2.0);
  EXPECT_EQ(histogram.Bins().size(), 2u);
}

TEST(Histogram, OrderDoesNotMatter)
{
  std::vector<double> values = SomeValues(3, 30000);
  values[7] = NAN;
  ValueHistogram whole;
  whole.Add(values.data(), values.size());
  std::mt19937 random(4);
  for (int round = 0; round < 5; ++round)
  {
    std::shuffle(values.begin(), values.end(), random);
    std::vector<ValueHistogram> parts(7);
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      parts[random() % (parts.size() - 1)].Add(&values[i], 1); // one of them stays empty
    }
    std::shuffle(parts.begin(), parts.end(), random);
    ValueHistogram merged;
    ValueHistogram fromMessages;
    for (const ValueHistogram& part : parts)
    {
      merged.Merge(part);
      fromMessages.Merge(part.Message());
    }
    EXPECT_TRUE(Same(whole, merged));
    EXPECT_TRUE(Same(whole, fromMessages));
    ValueHistogram copy = merged;
    copy.Add(values.data(), 1);
    EXPECT_TRUE(Same(whole, merged)) << "a copy shares something";
    EXPECT_FALSE(Same(whole, copy));
  }
}

TEST(Histogram, MessagesWithUnknownBinsAreRejected)
{
  HistogramMessage message;
  message.Entries = { { 0xffffffffu, 1 } };
  EXPECT_THROW(ValueHistogram().Merge(message), Error);
  message.Entries = { { 2047u * 2048u + 5u, 1 } };
  EXPECT_THROW(ValueHistogram().Merge(message), Error) << "the page of zero has one bin";
  message.Entries = { { 2047u * 2048u, 1 } };
  ValueHistogram().Merge(message);
}

template <class T>
void ExpectPercentilesOfSorting(std::vector<T> values)
{
  ValueHistogram histogram;
  histogram.Add(values.data(), values.size());
  std::sort(values.begin(), values.end());
  for (const double share : { 0.0, 0.0001, 0.01, 0.1, 0.25, 0.5, 0.77, 0.99, 0.9999, 1.0 })
  {
    const double exact = std::ceil(share * static_cast<double>(values.size()));
    const std::size_t rank = std::max<std::size_t>(1, static_cast<std::size_t>(exact));
    const double expected = static_cast<double>(values[rank - 1]);
    const ValueRange found = histogram.Percentile(share);
    EXPECT_LE(found.Low, expected) << share;
    EXPECT_GE(found.High, expected) << share;
    EXPECT_LE(found.Width(), std::abs(expected) / 2048.0) << share;
  }
}

TEST(Histogram, PercentilesAreThoseOfSorting)
{
  for (const std::size_t count : { 1, 2, 3, 10, 1000, 40001 })
  {
    ExpectPercentilesOfSorting(SomeValues(5, count));
    std::vector<float> floats;
    std::vector<std::uint8_t> bytes;
    std::vector<std::int64_t> longs;
    for (const double value : SomeValues(6, count))
    {
      floats.push_back(static_cast<float>(value * 1e-40));
      bytes.push_back(static_cast<std::uint8_t>(std::fmod(std::abs(value), 200.0)));
      longs.push_back(static_cast<std::int64_t>(std::fmod(value * 1e3, 1e15)));
    }
    ExpectPercentilesOfSorting(floats);
    ExpectPercentilesOfSorting(bytes);
    ExpectPercentilesOfSorting(longs);
  }
  EXPECT_THROW((void)ValueHistogram().Percentile(0.5), Error);
  ValueHistogram one;
  const double value = 3.0;
  one.Add(&value, 1);
  EXPECT_THROW((void)one.Percentile(-0.1), Error);
  EXPECT_THROW((void)one.Percentile(1.1), Error);
  EXPECT_THROW((void)one.Percentile(NAN), Error);
  EXPECT_EQ(one.Percentile(0.3).Low, 3.0);
  EXPECT_EQ(one.Percentile(0.3).High, 3.0);
}

TEST(RangeRule, CutsOffOutliers)
{
  std::vector<float> values;
  for (int i = 0; i < 100000; ++i)
  {
    values.push_back(static_cast<float>(i) / 1000.0f);
  }
  values[500] = 1e20f;
  values[501] = -1e20f;
  values[502] = NAN;
  ValueHistogram histogram;
  histogram.Add(values.data(), values.size());
  EXPECT_EQ(ChooseRange({}, histogram).High, static_cast<double>(1e20f));
  RangeRule rule;
  rule.From = RangeRule::Source::Percentiles;
  rule.LowShare = 0.01;
  rule.HighShare = 0.99;
  const ValueRange range = ChooseRange(rule, histogram);
  EXPECT_NEAR(range.Low, 1.0, 0.005);
  EXPECT_NEAR(range.High, 99.0, 0.1);
  // About one value in fifty lies outside; bins at the ends count as inside.
  EXPECT_NEAR(static_cast<double>(histogram.CountOutside(range)), 2000.0, 100.0);
  EXPECT_EQ(histogram.CountOutside(histogram.Range()), 0u);
  EXPECT_EQ(histogram.CountOutside({}), 0u);
  rule.From = RangeRule::Source::Given;
  EXPECT_THROW((void)ChooseRange(rule, histogram), Error);
  rule.Given = { -3.0, 7.0 };
  EXPECT_EQ(ChooseRange(rule, histogram).Low, -3.0);
  rule.Given.High = INFINITY;
  EXPECT_THROW((void)ChooseRange(rule, histogram), Error);
  rule.From = RangeRule::Source::Percentiles;
  rule.HighShare = rule.LowShare;
  EXPECT_THROW((void)ChooseRange(rule, histogram), Error);
  rule.HighShare = 0.99;
  EXPECT_TRUE(ChooseRange(rule, ValueHistogram()).Empty());
}

TEST(RangeRule, ClampsAndCounts)
{
  const std::vector<float> values = { -1.0f, 0.05f, 0.1f, 0.2f, 0.9f, 5.0f, NAN, INFINITY,
    -INFINITY };
  std::vector<float> clamped(values.size());
  // 0.1 as a double lies below 0.1f, 0.9 above 0.9f.
  EXPECT_EQ(ClampToRange({ 0.1, 0.9 }, values.data(), values.size(), clamped.data()), 3);
  EXPECT_EQ(clamped[0], 0.1f);
  EXPECT_EQ(clamped[2], 0.1f);
  EXPECT_EQ(clamped[3], 0.2f);
  EXPECT_LE(static_cast<double>(clamped[5]), 0.9);
  EXPECT_EQ(clamped[5], std::min(0.9f, clamped[5]));
  EXPECT_TRUE(std::isnan(clamped[6]));
  EXPECT_EQ(clamped[7], INFINITY);
  EXPECT_EQ(clamped[8], -INFINITY);
  EXPECT_EQ(ClampToRange({}, values.data(), 6, clamped.data()), 0);
  EXPECT_EQ(clamped[5], 5.0f);
  EXPECT_EQ(ClampToRange({ -1e300, 1e300 }, values.data(), 6, clamped.data()), 0);
  // 0.7f lies below 0.7.
  const float below = 0.5f;
  float inside = 0.0f;
  EXPECT_EQ(ClampToRange({ 0.7, 0.9 }, &below, 1, &inside), 1);
  EXPECT_EQ(inside, std::nextafter(0.7f, 1.0f));
  EXPECT_THROW((void)ClampToRange({ 1e300, 1e301 }, values.data(), 6, clamped.data()), Error);
}

TEST(RangeRule, ClampsIntegers)
{
  std::vector<std::int8_t> values = { -128, -3, -2, 0, 7, 8, 127 };
  EXPECT_EQ(ClampToRange({ -2.5, 7.9 }, values.data(), values.size(), values.data()), 4);
  EXPECT_EQ(values, (std::vector<std::int8_t>{ -2, -2, -2, 0, 7, 7, 7 }));
  EXPECT_THROW((void)ClampToRange({ 0.2, 0.8 }, values.data(), 1, values.data()), Error);
  EXPECT_THROW((void)ClampToRange({ 500.0, 900.0 }, values.data(), 1, values.data()), Error);
  std::vector<std::uint64_t> large = { 0, std::numeric_limits<std::uint64_t>::max() };
  EXPECT_EQ(ClampToRange({ 0.0, 0x1p64 }, large.data(), 2, large.data()), 0);
  EXPECT_EQ(large[1], std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(ClampToRange({ 1.0, 0x1p60 }, large.data(), 2, large.data()), 2);
  EXPECT_EQ(large, (std::vector<std::uint64_t>{ 1, std::uint64_t{ 1 } << 60 }));
}

} // namespace
} // namespace banyan
