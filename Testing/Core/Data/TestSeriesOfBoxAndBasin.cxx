// SPDX-License-Identifier: BSD-3-Clause
// The catalogue's entries "convection", "wave" and "wavep".
#include "SeriesCatalog.h"

#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

struct Series
{
  std::vector<double> Times;
  std::vector<std::vector<float>> Steps;
};

Series Make(const std::string& name, std::uint64_t seed, int threads, double duration)
{
  const banyan::SeriesKind& kind = banyan::FindSeriesKind(name);
  banyan::GenerateOptions options;
  options.Series = name;
  options.Size = 16;
  options.Steps = 5;
  options.Seed = seed;
  options.Duration = duration;
  options.Arrays = { kind.Arrays.at(0) };
  banyan::ThreadPool pool(threads);
  Series series;
  kind.Generate(options, pool,
    [&](double time, const std::vector<banyan::ImageArray>& arrays)
    {
      series.Times.push_back(time);
      series.Steps.push_back(arrays.at(0).Values);
    });
  return series;
}

float Largest(const std::vector<std::vector<float>>& steps)
{
  float largest = 0.0f;
  for (const auto& values : steps)
  {
    largest = std::max(largest, *std::max_element(values.begin(), values.end()));
  }
  return largest;
}

} // namespace

TEST(SeriesOfBoxAndBasin, EqualSeedsGiveEqualBytesWithAnyNumberOfThreads)
{
  for (const char* name : { "convection", "wave", "wavep" })
  {
    const Series one = Make(name, 5, 1, 4.0);
    ASSERT_EQ(one.Steps.size(), 5u);
    EXPECT_EQ(one.Times, (std::vector<double>{ 0.0, 1.0, 2.0, 3.0, 4.0 }));
    EXPECT_EQ(one.Steps[4].size(), 16u * 16u * 16u);
    EXPECT_GT(Largest(one.Steps), 0.0f);
    EXPECT_TRUE(one.Steps == Make(name, 5, 3, 4.0).Steps) << name;
    EXPECT_FALSE(one.Steps == Make(name, 6, 1, 4.0).Steps) << name;
  }
}

TEST(SeriesOfBoxAndBasin, TheClippedWavesAreTheWavesBelowTheirPercentile)
{
  const Series whole = Make("wave", 1, 2, 6.0), clipped = Make("wavep", 1, 2, 6.0);
  const float largest = Largest(clipped.Steps);
  // 5 * 4096 values: the two largest lie above the percentile.
  std::size_t changed = 0;
  for (int step = 0; step < 5; ++step)
  {
    for (std::size_t i = 0; i < whole.Steps[step].size(); ++i)
    {
      ASSERT_EQ(clipped.Steps[step][i], std::min(whole.Steps[step][i], largest));
      changed += clipped.Steps[step][i] != whole.Steps[step][i];
    }
  }
  EXPECT_EQ(changed, 2u);
}

TEST(SeriesOfBoxAndBasin, ArraysAreSpeedAndVelocityOfTheSameWaves)
{
  const banyan::SeriesKind& kind = banyan::FindSeriesKind("wave");
  banyan::GenerateOptions options;
  options.Size = 12;
  options.Steps = 1;
  options.Duration = 3.0;
  options.Arrays = { "velocity", "speed" };
  banyan::ThreadPool pool(2);
  kind.Generate(options, pool,
    [&](double, const std::vector<banyan::ImageArray>& arrays)
    {
      ASSERT_EQ(arrays.size(), 2u);
      EXPECT_EQ(arrays[0].Components, 3);
      for (std::size_t i = 0; i < arrays[1].Values.size(); ++i)
      {
        const float* v = &arrays[0].Values[3 * i];
        ASSERT_NEAR(v[0] * v[0] + v[1] * v[1] + v[2] * v[2],
          arrays[1].Values[i] * arrays[1].Values[i], 1e-6f * arrays[1].Values[i]);
      }
    });
}
