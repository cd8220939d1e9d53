// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>

namespace
{

using namespace banyan;

/// Counts loads, and the memory that loaded bricks hold at once.
class Counting : public ArrayBrickSource
{
public:
  using ArrayBrickSource::ArrayBrickSource;

  std::size_t LoadBytes(std::int64_t) const override { return BytesPerBrick; }

  BrickView Load(std::int64_t brick) override
  {
    BrickView view = ArrayBrickSource::Load(brick);
    const std::lock_guard<std::mutex> lock(this->Mutex);
    EXPECT_TRUE(this->Loaded.insert(brick).second); // never twice in a picture
    this->Held += BytesPerBrick;
    this->MostHeld = std::max(this->MostHeld, this->Held);
    view.Owner = std::shared_ptr<const void>(view.Values,
      [this](const void*)
      {
        const std::lock_guard<std::mutex> last(this->Mutex);
        this->Held -= BytesPerBrick;
      });
    return view;
  }

  static constexpr std::size_t BytesPerBrick = 1000;
  std::mutex Mutex;
  std::set<std::int64_t> Loaded;
  std::size_t Held = 0;
  std::size_t MostHeld = 0;
};

bool CanBeSeen(const BrickSource& source, std::int64_t brick, const TransferFunction& transfer)
{
  return (source.MaskOf(brick) & transfer.VisibleBins(source.MasksAreOver())) != 0 &&
         transfer.AnyVisible(source.RangeOf(brick).Low, source.RangeOf(brick).High);
}

TEST(Skipping, OnlyBricksThatCanBeSeenAreLoaded)
{
  const glm::ivec3 n(41);
  // A small ball in a corner; elsewhere 0.
  const std::vector<float> values = scenes::Sampled(
    [](const glm::dvec3& p) { return std::fmax(0.0, 1.0 - 8.0 * glm::length(p - 0.25)); }, n);
  RayScene scene = scenes::Scene(n, { 50, 50 });
  scene.Transfer =
    scenes::Tabulate([](double v) { return glm::dvec4(1.0, 1.0, 1.0, v > 0.1 ? 0.2 : 0.0); });
  ThreadPool pool(2);
  Counting source(scenes::ArrayOf(values, n), 8, { 0, 1 }, pool);
  RayStatistics statistics;
  CastRays(scene, source, scene.DomainCells, 1 << 20, pool, statistics);
  std::int64_t visible = 0;
  for (std::int64_t brick = 0; brick < 125; ++brick)
  {
    visible += CanBeSeen(source, brick, scene.Transfer) ? 1 : 0;
    EXPECT_EQ(source.Loaded.count(brick) == 1, CanBeSeen(source, brick, scene.Transfer));
  }
  EXPECT_GT(visible, 0);
  EXPECT_LT(visible, 30);
  EXPECT_EQ(statistics.BricksDrawn, visible);
  EXPECT_EQ(statistics.BricksSkipped, 125 - visible);
}

TEST(Skipping, TheMaskSeesWhatTheRangeDoesNot)
{
  // Every brick reaches from 0 to 1, but only one has values between.
  const glm::ivec3 n(17);
  std::vector<float> values(n.x * n.y * n.z, 0.0f);
  RayScene scene = scenes::Scene(n, { 30, 30 });
  scene.Transfer =
    scenes::Tabulate([](double v) { return glm::dvec4(1.0, 1.0, 1.0, v > 0.9 ? 0.2 : 0.0); });
  values[5 + 17 * (5 + 17 * 5)] = 1.0f;
  ThreadPool pool(1);
  Counting source(scenes::ArrayOf(values, n), 8, { 0, 1 }, pool);
  RayStatistics statistics;
  CastRays(scene, source, scene.DomainCells, 1 << 20, pool, statistics);
  EXPECT_EQ(source.Loaded, (std::set<std::int64_t>{ 0 }));
}

TEST(Skipping, NothingVisibleLoadsNothing)
{
  const glm::ivec3 n(20);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  RayScene scene = scenes::Scene(n, { 30, 30 });
  scene.Transfer.Entries.assign(16, glm::vec4(1, 1, 1, 0));
  ThreadPool pool(1);
  Counting source(scenes::ArrayOf(values, n), 8, { 0, 1 }, pool);
  RayStatistics statistics;
  const FloatImage image = CastRays(scene, source, scene.DomainCells, 1 << 20, pool, statistics);
  EXPECT_TRUE(image.Rect.Empty());
  EXPECT_TRUE(source.Loaded.empty());
  EXPECT_EQ(statistics.BricksSkipped, 27);
}

TEST(Skipping, SkippingChangesNoBit)
{
  const glm::ivec3 n(33);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  RayScene scene = scenes::Scene(n, { 60, 60 });
  scene.Transfer = scenes::Tabulate(scenes::Sparse);
  const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n), { 4, 1, 0 }).Image;
  const FloatImage oneBrick = scenes::Draw(scene, scenes::ArrayOf(values, n), { 64, 1, 0 }).Image;
  EXPECT_EQ(MaxDifference(image, oneBrick), 0.0);
}

TEST(Skipping, OffScreenBricksAreNotLoaded)
{
  const glm::ivec3 n(33);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  RayScene scene = scenes::Scene(n, { 60, 60 });
  scene.Viewport = { { 28, 28 }, { 31, 31 } };
  ThreadPool pool(1);
  Counting source(scenes::ArrayOf(values, n), 8, { 0, 1 }, pool);
  RayStatistics statistics;
  CastRays(scene, source, scene.DomainCells, 1 << 20, pool, statistics);
  EXPECT_GT(statistics.BricksDrawn, 0);
  EXPECT_LT(statistics.BricksDrawn, 32);
  EXPECT_EQ(statistics.BricksDrawn + statistics.BricksSkipped, 64);
}

TEST(Skipping, BricksBehindOpaquePixelsAreNotLoaded)
{
  const glm::ivec3 n(33);
  std::vector<float> values(n.x * n.y * n.z, 1.0f);
  for (std::size_t i = 0; i < values.size(); i += 2)
  {
    values[i] = 0.5f; // bricks of one value are not loaded anyway
  }
  RayScene scene = scenes::Scene(n, { 40, 40 });
  scene.Transfer.Entries.assign(2, glm::vec4(1.0f));
  scene.OpacityLimit = 0.99f;
  ThreadPool pool(2);
  Counting source(scenes::ArrayOf(values, n), 4, { 0, 1 }, pool);
  RayStatistics statistics;
  // Eight bricks at a time: the front faces fill all pixels.
  CastRays(scene, source, scene.DomainCells, 8000, pool, statistics);
  EXPECT_LT(statistics.BricksDrawn, 320);
  EXPECT_EQ(statistics.BricksDrawn + statistics.BricksSkipped, 512);
}

TEST(Skipping, BatchesStayWithinTheBudget)
{
  const glm::ivec3 n(33);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  const RayScene scene = scenes::Scene(n, { 40, 40 });
  for (const std::uint64_t budget : { 0, 999, 1000, 1001, 5500 })
  {
    ThreadPool pool(2);
    Counting source(scenes::ArrayOf(values, n), 8, { 0, 1 }, pool);
    RayStatistics statistics;
    CastRays(scene, source, scene.DomainCells, budget, pool, statistics);
    EXPECT_EQ(statistics.BricksDrawn, 64);
    EXPECT_LE(source.MostHeld, std::max<std::uint64_t>(budget, 1000));
    EXPECT_EQ(source.Held, 0u);
  }
}

/// Without skipping and early end, a ray takes the samples that its length asks for.
TEST(Skipping, SamplesAreCountedExactly)
{
  const glm::ivec3 n(25, 18, 21);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  const RayScene scene = scenes::Scene(n, { 31, 29 });
  std::int64_t expected = 0;
  for (int y = 0; y < 29; ++y)
  {
    for (int x = 0; x < 31; ++x)
    {
      const Ray ray = scene.Camera.RayOf(x, y);
      double enter = ray.Near;
      double exit = ray.Far;
      for (int axis = 0; axis < 3; ++axis)
      {
        const double a = -ray.Origin[axis] / ray.Direction[axis];
        const double b = (n[axis] - 1 - ray.Origin[axis]) / ray.Direction[axis];
        enter = std::fmax(enter, std::fmin(a, b));
        exit = std::fmin(exit, std::fmax(a, b));
      }
      if (enter < exit)
      {
        expected += static_cast<std::int64_t>(std::ceil(exit) - std::floor(enter));
      }
    }
  }
  EXPECT_GT(expected, 3000);
  EXPECT_EQ(
    scenes::Draw(scene, scenes::ArrayOf(values, n), { 5, 2, 0 }).Statistics.SamplesTaken, expected);
}

} // namespace
