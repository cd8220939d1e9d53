// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using namespace banyan;

bool AllFinite(const FloatImage& image)
{
  for (const glm::vec4& pixel : image.Pixels)
  {
    for (int channel = 0; channel < 4; ++channel)
    {
      if (!std::isfinite(pixel[channel]) || pixel[channel] < 0.0f || pixel[channel] > 1.0001f)
      {
        return false;
      }
    }
  }
  return true;
}

TEST(SpecialValues, NotFiniteVoxelsAreEmptySpace)
{
  const glm::ivec3 n(20);
  std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  std::mt19937 random(8);
  const float special[] = { NAN, INFINITY, -INFINITY };
  for (int i = 0; i < 300; ++i)
  {
    values[random() % values.size()] = special[i % 3];
  }
  const RayScene scene = scenes::Scene(n, { 50, 50 });
  const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
  EXPECT_TRUE(AllFinite(image));
  EXPECT_EQ(
    MaxDifference(image, scenes::Draw(scene, scenes::ArrayOf(values, n), { 3, 2, 0 }).Image), 0.0);
  const FloatImage reference =
    ReferenceImage(scene, scenes::ValueOf(values, n), scenes::NearestEntry(scene.Transfer));
  EXPECT_LE(MaxDifference(image, reference), 1e-4);

  const std::vector<double> doubles(values.begin(), values.end());
  EXPECT_LE(MaxDifference(scenes::Draw(scene, scenes::ArrayOf(doubles, n)).Image, reference), 1e-4);
}

TEST(SpecialValues, NothingButNotANumber)
{
  const glm::ivec3 n(9);
  const std::vector<float> values(729, NAN);
  const RayScene scene = scenes::Scene(n, { 20, 20 });
  const scenes::Drawn drawn = scenes::Draw(scene, scenes::ArrayOf(values, n));
  EXPECT_TRUE(drawn.Image.Rect.Empty());
  EXPECT_EQ(drawn.Statistics.SamplesTaken, 0);
  EXPECT_EQ(drawn.Statistics.BricksSkipped, 1);
}

TEST(SpecialValues, HiddenSamplesAreEmptySpace)
{
  const glm::ivec3 n(16);
  std::vector<std::int16_t> values =
    scenes::Sampled<std::int16_t>(scenes::Standard, n, 1000.0, -500.0);
  std::vector<std::uint8_t> flags(values.size(), 0);
  std::vector<float> holes(values.begin(), values.end());
  for (std::size_t i = 0; i < flags.size(); i += 37)
  {
    flags[i] = 2;
    holes[i] = NAN;
  }
  RayScene scene = scenes::Scene(n, { 50, 50 });
  scene.Transfer.Low = -500;
  scene.Transfer.High = 500;
  SampleArray array = scenes::ArrayOf(values, n);
  array.Flags = flags.data();
  const FloatImage hidden = scenes::Draw(scene, array, { 5, 2, 4000 }).Image;
  EXPECT_GT(hidden.At(25, 25).a, 0.01f);
  EXPECT_LE(MaxDifference(hidden, scenes::Draw(scene, scenes::ArrayOf(holes, n)).Image), 1e-6);
}

TEST(SpecialValues, ExtremeFloats)
{
  const glm::ivec3 n(9);
  std::vector<float> values = scenes::Sampled(scenes::Linear, n);
  values[100] = std::numeric_limits<float>::max();
  values[101] = std::numeric_limits<float>::lowest();
  values[300] = std::numeric_limits<float>::denorm_min();
  RayScene scene = scenes::Scene(n, { 30, 30 });
  EXPECT_TRUE(AllFinite(scenes::Draw(scene, scenes::ArrayOf(values, n)).Image));
  scene.Transfer.Low = -1e300;
  scene.Transfer.High = 1e300;
  EXPECT_TRUE(AllFinite(scenes::Draw(scene, scenes::ArrayOf(values, n)).Image));
}

/// An axis with a single sample has no cells, so there is nothing to draw and nothing fails.
TEST(SpecialValues, FlatVolumesDrawNothing)
{
  for (const glm::ivec3& n : { glm::ivec3(1), glm::ivec3(1, 20, 20), glm::ivec3(20, 20, 1),
         glm::ivec3(1, 1, 50), glm::ivec3(7, 1, 3) })
  {
    const std::vector<float> values = scenes::Sampled(scenes::Linear, n);
    RayScene scene = scenes::Scene(glm::ivec3(20), { 20, 20 });
    scene.DomainCells = { glm::ivec3(0), n - 1 };
    const scenes::Drawn drawn = scenes::Draw(scene, scenes::ArrayOf(values, n));
    EXPECT_TRUE(drawn.Image.Rect.Empty());
    EXPECT_TRUE(drawn.Image.Pixels.empty());
    EXPECT_EQ(drawn.Statistics.SamplesTaken, 0);
  }
}

TEST(SpecialValues, NothingAskedForOrOutOfSight)
{
  const glm::ivec3 n(10);
  const std::vector<float> values = scenes::Sampled(scenes::Linear, n);
  RayScene scene = scenes::Scene(n, { 20, 20 });
  ThreadPool pool(2);
  ArrayBrickSource source(scenes::ArrayOf(values, n), 4, { 0, 1 }, pool);
  RayStatistics statistics;
  EXPECT_TRUE(CastRays(scene, source, {}, 0, pool, statistics).Rect.Empty());
  EXPECT_EQ(statistics.BricksSkipped, 0);

  scene.Viewport = {};
  EXPECT_TRUE(CastRays(scene, source, scene.DomainCells, 0, pool, statistics).Rect.Empty());

  // The viewer looks away.
  const glm::dmat4 view =
    glm::lookAt(glm::dvec3(50, 5, 5), glm::dvec3(90, 5, 5), glm::dvec3(0, 1, 0));
  scene.Viewport = { { 0, 0 }, { 20, 20 } };
  scene.Camera =
    RayCamera(glm::perspective(0.8, 1.0, 1.0, 200.0) * view, { 20, 20 }, glm::dvec3(0.0));
  statistics = {};
  EXPECT_TRUE(CastRays(scene, source, scene.DomainCells, 0, pool, statistics).Rect.Empty());
  EXPECT_EQ(statistics.BricksSkipped, 27);
  EXPECT_EQ(statistics.BricksDrawn, 0);
}

TEST(SpecialValues, ScenesThatCannotBeDrawnAreRefused)
{
  const glm::ivec3 n(10);
  const std::vector<float> values = scenes::Sampled(scenes::Linear, n);
  const RayScene good = scenes::Scene(n, { 20, 20 });
  const auto refused = [&](const std::function<void(RayScene&)>& change)
  {
    RayScene scene = good;
    change(scene);
    EXPECT_THROW(scenes::Draw(scene, scenes::ArrayOf(values, n)), Error);
  };
  refused([](RayScene& s) { s.SampleDistance = 0.0; });
  refused([](RayScene& s) { s.SampleDistance = -1.0; });
  refused([](RayScene& s) { s.SampleDistance = NAN; });
  refused([](RayScene& s) { s.SampleDistance = 1e-9; });
  refused([](RayScene& s) { s.Transfer.Entries.clear(); });
  refused([](RayScene& s) { s.Transfer.UnitDistance = 0.0; });
  refused([](RayScene& s) { s.Depth.resize(3); });
  refused([](RayScene& s) { s.Viewport.Hi.x = 21; });
  refused([](RayScene& s) { s.IndexToWorld[1] = glm::dvec4(0.0); });
  refused([](RayScene& s) { s.IndexToWorld[1][1] = NAN; });
  refused([](RayScene& s) { s.DomainCells.Hi.x = 1 << 27; });
}

/// A source that fails on one brick.
class Failing : public ArrayBrickSource
{
public:
  using ArrayBrickSource::ArrayBrickSource;
  BrickView Load(std::int64_t brick) override
  {
    if (brick == 5)
    {
      throw Error("Brick 5 is damaged");
    }
    return ArrayBrickSource::Load(brick);
  }
};

TEST(SpecialValues, FailuresToLoadComeOut)
{
  const glm::ivec3 n(10);
  const std::vector<float> values = scenes::Sampled(scenes::Linear, n);
  const RayScene scene = scenes::Scene(n, { 20, 20 });
  for (const int threads : { 1, 3 })
  {
    ThreadPool pool(threads);
    Failing source(scenes::ArrayOf(values, n), 4, { 0, 1 }, pool);
    RayStatistics statistics;
    EXPECT_THROW(CastRays(scene, source, scene.DomainCells, 0, pool, statistics), Error);
  }
}

TEST(ImageError, DifferenceAndPsnr)
{
  FloatImage a;
  a.Rect = { { 0, 0 }, { 2, 1 } };
  a.Pixels.assign(2, glm::vec4(0.5f));
  FloatImage b = a;
  EXPECT_EQ(MaxDifference(a, b), 0.0);
  EXPECT_EQ(Psnr(a, b, a.Rect), INFINITY);
  b.Pixels[1].g = 0.25f;
  EXPECT_EQ(MaxDifference(a, b), 0.25);
  EXPECT_NEAR(Psnr(a, b, a.Rect), -10.0 * std::log10(0.0625 / 6.0), 1e-9);
  b.Rect = { { 1, 0 }, { 3, 1 } }; // what one has not is transparent
  EXPECT_EQ(MaxDifference(a, b), 0.5);
  b.Pixels[0].r = NAN;
  EXPECT_EQ(MaxDifference(a, b), INFINITY);
  EXPECT_EQ(Psnr(a, b, a.Rect), -INFINITY);
}

} // namespace
