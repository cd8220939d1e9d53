// SPDX-License-Identifier: BSD-3-Clause
// The field of the standard scenes: as written down a second time by the tests of the ray caster,
// and the same whichever way it is made.
#include "SeriesCatalog.h"
#include "StandardField.h"

#include "Base/ThreadPool.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace
{

std::vector<float> Whole(int size)
{
  const banyan::StandardFieldSlices field(size);
  std::vector<float> values(static_cast<std::size_t>(size) * size * size);
  for (int z = 0; z < size; ++z)
  {
    field.Slice(z, values.data() + static_cast<std::size_t>(z) * size * size);
  }
  return values;
}

} // namespace

TEST(StandardField, IsTheFormula)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(0.0, 1.0);
  for (int i = 0; i < 1000; ++i)
  {
    const glm::dvec3 p(coordinate(random), coordinate(random), coordinate(random));
    EXPECT_NEAR(banyan::StandardField(p), scenes::Standard(p), 1e-12);
  }
}

TEST(StandardField, SlicesHoldTheFormula)
{
  for (const int size : { 2, 7, 33 })
  {
    const std::vector<float> values = Whole(size);
    std::size_t i = 0;
    for (int z = 0; z < size; ++z)
    {
      for (int y = 0; y < size; ++y)
      {
        for (int x = 0; x < size; ++x)
        {
          EXPECT_NEAR(values[i++], banyan::StandardField(glm::dvec3(x, y, z) / (size - 1.0)), 1e-7);
        }
      }
    }
  }
}

TEST(StandardField, FillsItsRangeAndIsMostlyLow)
{
  const std::vector<float> values = Whole(64);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  EXPECT_GE(*low, 0.0f);
  EXPECT_LT(*low, 0.02f);
  EXPECT_GT(*high, 0.97f);
  EXPECT_LE(*high, 1.0f);
  const auto invisible =
    std::count_if(values.begin(), values.end(), [](float value) { return value < 64.0 / 255.0; });
  EXPECT_NEAR(static_cast<double>(invisible) / values.size(), 0.9, 0.02); // in the scene S2
}

TEST(StandardField, IsTheSamePieceByPieceAndAtOnce)
{
  const banyan::SeriesKind& kind = banyan::FindSeriesKind("standard");
  const auto options = banyan::ParseGenerateOptions(
    { "--output", "o", "--series", "standard", "--size", "34", "--steps", "2" });
  banyan::ThreadPool pool(2);
  std::vector<float> atOnce;
  kind.Generate(options, pool,
    [&](double, const std::vector<banyan::ImageArray>& arrays)
    { atOnce.insert(atOnce.end(), arrays[0].Values.begin(), arrays[0].Values.end()); });
  std::vector<float> pieces;
  kind.GenerateSlabs(options, pool,
    [&](const std::vector<float>& values)
    { pieces.insert(pieces.end(), values.begin(), values.end()); });
  EXPECT_EQ(atOnce.size(), 2u * 34 * 34 * 34);
  EXPECT_TRUE(atOnce == pieces);
}
