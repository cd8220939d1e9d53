// SPDX-License-Identifier: BSD-3-Clause
// Which bricks a maximum or minimum leaves out: none that could change a pixel, and all of one
// value that another one has already.
#include "Render/Bricks/Interpolators.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using namespace banyan;

constexpr BlendMode Modes[] = { BlendMode::Maximum, BlendMode::Minimum };

RayScene SceneOf(const glm::ivec3& n, BlendMode mode)
{
  RayScene scene = scenes::Scene(n, { 61, 50 });
  scene.Blend.Mode = mode;
  return scene;
}

/// In float, as samples between corners of a brick are.
float Between(float a, float b, float part)
{
  return a + part * (b - a);
}

TEST(ProjectionRanks, NoSampleOfABrickHasABetterOne)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (const BlendMode mode : Modes)
  {
    for (const double offset : { 0.0, 1e6, -3e7 })
    {
      for (const int entries : { 2, 256, 4096 })
      {
        RayScene scene = SceneOf(glm::ivec3(9), mode);
        scene.Transfer = scenes::Tabulate(scenes::Smooth, entries);
        scene.Transfer.Low = offset;
        scene.Transfer.High = offset + 100.0;
        const StepTable steps(scene.Transfer, 1.0);
        const ProjectionTable table(scene, steps);
        for (int i = 0; i < 2000; ++i)
        {
          double low = offset - 20.0 + 140.0 * part(random);
          double high = i % 3 == 0 ? low : low + part(random) * (i % 2 == 0 ? 1.0 : 50.0);
          const bool relative = i % 5 < 2;
          if (!relative)
          {
            low = static_cast<float>(low);
            high = static_cast<float>(high);
          }
          const float best = table.HighestRank({ low, high });
          const float a = relative ? CornerValue(low, table.Low()) : static_cast<float>(low);
          const float b = relative ? CornerValue(high, table.Low()) : static_cast<float>(high);
          for (const float value : { a, b, Between(a, b, static_cast<float>(part(random))),
                 Between(b, a, static_cast<float>(part(random))), Between(a, b, 0.99999994f) })
          {
            EXPECT_LE(table.RankOf(table.ScaleOf(relative).Lookup.IndexOf(value)), best)
              << low << " to " << high << ", " << entries << " entries";
          }
        }
      }
    }
  }
}

/// Even of 256 entries, of which each is a part of the range.
TEST(ProjectionRanks, OneValueIsNotSampledBehindTheSame)
{
  const glm::ivec3 n(65);
  std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  for (float& value : values)
  {
    value = std::clamp(value, 0.3f, 0.7f);
  }
  const auto samples = [&](const RayScene& scene)
  {
    const scenes::Drawn drawn = scenes::Draw(scene, scenes::ArrayOf(values, n), { 8 });
    EXPECT_EQ(
      MaxDifference(drawn.Image, scenes::Draw(scene, scenes::ArrayOf(values, n), { 64 }).Image),
      0.0);
    return drawn.Statistics.SamplesTaken;
  };
  const std::int64_t all = samples(SceneOf(n, BlendMode::Average));
  for (const BlendMode mode : Modes)
  {
    RayScene scene = SceneOf(n, mode);
    scene.Transfer = scenes::Tabulate(scenes::Smooth, 256);
    EXPECT_LT(samples(scene), all / 2) << static_cast<int>(mode);
  }
}

} // namespace
