// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/BrickStatistics.h"
#include "Series/SeriesTesting.h"

namespace banyan::testing
{
namespace
{

TEST(BrickStatistics, RangesAreThoseOfTheFiniteValues)
{
  std::mt19937 random(23);
  std::uniform_real_distribution<float> uniform(-1, 2);
  for (const std::size_t count : { 1, 2, 27, 1000 })
  {
    std::vector<float> v(count);
    for (float& value : v)
    {
      const auto dice = random() % 20;
      value = dice == 0 ? std::nanf("") : dice == 1 ? -INFINITY : uniform(random);
    }
    const BrickSummary summary = Summarize(v.data(), v.size());
    EXPECT_EQ(summary.Range.Low, RangeOf(v).Low);
    EXPECT_EQ(summary.Range.High, RangeOf(v).High);
  }
}

TEST(BrickStatistics, NothingFiniteGivesAnEmptyRange)
{
  const std::vector<double> v(27, std::nan(""));
  const BrickSummary summary = Summarize(v.data(), v.size());
  EXPECT_TRUE(summary.Range.Empty());
  EXPECT_TRUE(summary.HasNonFinite);
  EXPECT_FALSE(summary.Uniform);
}

TEST(BrickStatistics, RangesOfLongIntegersGoOutward)
{
  const std::int64_t odd = (std::int64_t{ 1 } << 60) + 1;
  const std::vector<std::int64_t> v = { -odd, odd };
  const BrickSummary summary = Summarize(v.data(), v.size());
  EXPECT_LE(static_cast<long double>(summary.Range.Low), static_cast<long double>(-odd));
  EXPECT_GE(static_cast<long double>(summary.Range.High), static_cast<long double>(odd));
  EXPECT_NEAR(summary.Range.High, static_cast<double>(odd), 300);
  const std::vector<std::int64_t> equal(2, odd);
  EXPECT_FALSE(Summarize(equal.data(), equal.size()).Uniform);
  const std::vector<std::uint64_t> top(2, std::numeric_limits<std::uint64_t>::max());
  EXPECT_FALSE(Summarize(top.data(), top.size()).Uniform);
}

TEST(BrickStatistics, UniformMeansEqualBits)
{
  const std::vector<float> zeros = { 0.0f, -0.0f };
  EXPECT_FALSE(Summarize(zeros.data(), zeros.size()).Uniform);
  const std::vector<float> minus(2, -0.0f);
  const BrickSummary summary = Summarize(minus.data(), minus.size());
  EXPECT_TRUE(summary.Uniform);
  EXPECT_TRUE(std::signbit(summary.Range.Low));
}

} // namespace
} // namespace banyan::testing
