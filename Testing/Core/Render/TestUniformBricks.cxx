// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/RayTile.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <atomic>

namespace
{

using namespace banyan;

/// Does or does not tell which bricks are uniform, and counts loads.
class Telling : public ArrayBrickSource
{
public:
  using ArrayBrickSource::ArrayBrickSource;

  std::optional<UniformValue> UniformValueOf(std::int64_t brick) const override
  {
    return this->Tells ? ArrayBrickSource::UniformValueOf(brick) : std::nullopt;
  }
  BrickView Load(std::int64_t brick) override
  {
    ++this->Loads;
    return ArrayBrickSource::Load(brick);
  }

  bool Tells = true;
  std::atomic<int> Loads{ 0 };
};

constexpr int Brick = 8;

/// A few plateaus with slopes between, so that some bricks are uniform and some are not.
double Plateaus(const glm::dvec3& p)
{
  return std::fmin(std::fmax(3.0 * (p.x - 0.4), 0.2), 0.7) + (p.y > 0.8 && p.z > 0.7 ? 0.1 : 0.0);
}

struct Drawn
{
  FloatImage Picture;
  RayStatistics Statistics;
  int Loads;
};

template <class T>
Drawn Draw(const std::vector<T>& values, const glm::ivec3& n, const RayScene& scene, bool tells,
  int cells = Brick)
{
  ThreadPool pool(2);
  Telling source(
    scenes::ArrayOf(values, n), cells, { scene.Transfer.Low, scene.Transfer.High }, pool);
  source.Tells = tells;
  Drawn drawn;
  drawn.Picture = CastRays(scene, source, scene.DomainCells, 1 << 24, pool, drawn.Statistics);
  drawn.Loads = source.Loads;
  return drawn;
}

template <class T>
void ExpectTheSamePicture(const std::vector<T>& values, const glm::ivec3& n, const RayScene& scene)
{
  const Drawn quick = Draw(values, n, scene, true);
  const Drawn slow = Draw(values, n, scene, false);
  EXPECT_GT(quick.Statistics.BricksUniform, 0);
  EXPECT_EQ(slow.Statistics.BricksUniform, 0);
  EXPECT_EQ(
    quick.Statistics.BricksDrawn + quick.Statistics.BricksUniform, slow.Statistics.BricksDrawn);
  EXPECT_EQ(quick.Loads, quick.Statistics.BricksDrawn);
  EXPECT_LT(quick.Statistics.SamplesTaken, slow.Statistics.SamplesTaken);
  ASSERT_EQ(quick.Picture.Pixels.size(), slow.Picture.Pixels.size());
  EXPECT_TRUE(quick.Picture.Pixels == slow.Picture.Pixels);
}

TEST(UniformBricks, ChangeNoBitAndAreNotLoaded)
{
  const glm::ivec3 n(41, 38, 35);
  const std::vector<float> values = scenes::Sampled(Plateaus, n);
  for (const bool parallel : { false, true })
  {
    RayScene scene = scenes::Scene(n, { 70, 50 }, glm::dmat4(1.0), 1.4, parallel);
    scene.Transfer = scenes::Tabulate(scenes::Smooth);
    ExpectTheSamePicture(values, n, scene);
    scene.Interpolation = SampleInterpolation::Nearest;
    ExpectTheSamePicture(values, n, scene);
  }
}

TEST(UniformBricks, AreDrawnTogetherWhereAllOfABlockAreAlike)
{
  // Blocks of 2 x 2 x 2 bricks: of one value, of several bricks of one value each, and others.
  const glm::ivec3 n(97, 90, 65);
  std::vector<float> values = scenes::Sampled(Plateaus, n);
  const auto set = [&](const Box& samples, float value)
  {
    for (int z = samples.Lo.z; z < samples.Hi.z; ++z)
    {
      for (int y = samples.Lo.y; y < samples.Hi.y; ++y)
      {
        std::fill_n(&values[samples.Lo.x + n.x * (y + static_cast<std::size_t>(n.y) * z)],
          samples.Size().x, value);
      }
    }
  };
  set({ { 64, 0, 0 }, { 97, 33, 33 } }, 0.3f);
  set({ { 80, 17, 17 }, { 97, 33, 33 } }, 0.6f);
  for (const bool parallel : { false, true })
  {
    RayScene scene = scenes::Scene(n, { 90, 70 }, glm::dmat4(1.0), 1.4, parallel);
    scene.Transfer = scenes::Tabulate(scenes::Smooth);
    const Drawn quick = Draw(values, n, scene, true, 16);
    const Drawn slow = Draw(values, n, scene, false, 16);
    EXPECT_GT(quick.Statistics.BricksUniform, 40);
    EXPECT_EQ(
      quick.Statistics.BricksDrawn + quick.Statistics.BricksUniform, slow.Statistics.BricksDrawn);
    EXPECT_TRUE(quick.Picture.Pixels == slow.Picture.Pixels);
    EXPECT_TRUE(quick.Picture.Pixels == Draw(values, n, scene, true, 8).Picture.Pixels);
  }
}

TEST(UniformBricks, MayBeOfTypesThatFloatCannotHold)
{
  const glm::ivec3 n(33);
  RayScene scene = scenes::Scene(n, { 40, 40 });
  scene.Transfer = scenes::Tabulate(scenes::Smooth);
  scene.Transfer.Low = 1e6;
  scene.Transfer.High = 1e6 + 1.0;
  ExpectTheSamePicture(scenes::Sampled<double>(Plateaus, n, 1.0, 1e6), n, scene);
  scene.Transfer.Low = 2e9;
  scene.Transfer.High = 2e9 + 100.0;
  ExpectTheSamePicture(scenes::Sampled<std::int32_t>(Plateaus, n, 100.0, 2e9), n, scene);
}

TEST(UniformBricks, EndRaysCutsAndGeometryAsOthersDo)
{
  const glm::ivec3 n(41);
  const std::vector<float> values = scenes::Sampled(Plateaus, n);
  RayScene scene = scenes::Scene(n, { 60, 60 });
  // Rays end within a brick.
  scene.OpacityLimit = 0.99f;
  scene.Transfer = scenes::Tabulate([](double v) { return glm::dvec4(v, 1.0 - v, 0.5, 0.6); });
  ExpectTheSamePicture(values, n, scene);
  scene.Transfer = scenes::Tabulate(scenes::Smooth);
  scene.ClipPlanes.push_back({ glm::dvec3(1.0, 0.3, 0.1), -7.3 });
  ExpectTheSamePicture(values, n, scene);
  scene.Depth.assign(static_cast<std::size_t>(scene.Viewport.Count()), 1.0f);
  for (std::size_t i = 0; i < scene.Depth.size(); i += 3)
  {
    scene.Depth[i] = 0.93f;
  }
  ExpectTheSamePicture(values, n, scene);
}

TEST(UniformBricks, StepsThatPacketsCannotTakeAreDrawnRayByRay)
{
  const glm::ivec3 n(81);
  const std::vector<float> values = scenes::Sampled(Plateaus, n);
  RayScene scene = scenes::Scene(n, { 40, 40 });
  scene.Transfer = scenes::Tabulate(scenes::Smooth);
  scene.SampleDistance = 1.5 * RayTile::LongestStep;
  ExpectTheSamePicture(values, n, scene);
}

TEST(UniformBricks, OfTheWholeVolumeGiveTheIntegral)
{
  const glm::ivec3 n(33);
  const std::vector<float> values(static_cast<std::size_t>(n.x) * n.y * n.z, 0.5f);
  RayScene scene = scenes::Scene(n, { 31, 31 }, glm::dmat4(1.0), 1.4, /*parallel=*/true);
  scene.Transfer = scenes::Tabulate([](double) { return glm::dvec4(1.0, 0.5, 0.25, 0.03); });
  const Drawn drawn = Draw(values, n, scene, true);
  EXPECT_EQ(drawn.Loads, 0);
  EXPECT_EQ(drawn.Statistics.SamplesTaken, 0);
  const FloatImage reference = ReferenceImage(
    scene, scenes::ValueOf(values, n), [](double) { return glm::dvec4(1.0, 0.5, 0.25, 0.03); });
  EXPECT_LT(MaxDifference(drawn.Picture, reference), 1e-4);
}

TEST(UniformBricks, WithASampleThatIsNotFiniteAreNone)
{
  const glm::ivec3 n(Brick + 1);
  std::vector<float> values(static_cast<std::size_t>(n.x) * n.y * n.z, 0.5f);
  ThreadPool pool(1);
  const ArrayBrickSource even(scenes::ArrayOf(values, n), Brick, { 0, 1 }, pool);
  ASSERT_TRUE(even.UniformValueOf(0).has_value());
  EXPECT_EQ(even.UniformValueOf(0)->Value, 0.5);
  values[100] = std::numeric_limits<float>::quiet_NaN();
  const ArrayBrickSource hole(scenes::ArrayOf(values, n), Brick, { 0, 1 }, pool);
  EXPECT_FALSE(hole.UniformValueOf(0).has_value());
}

} // namespace
