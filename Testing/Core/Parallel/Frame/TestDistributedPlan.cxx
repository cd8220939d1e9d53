// SPDX-License-Identifier: BSD-3-Clause
// Plans and their probes on ranks, held to those of one rank.
#include "Parallel/Balance/Zones.h"
#include "Parallel/Frame/DistributedFrame.h"
#include "Parallel/Frame/DistributedPlan.h"
#include "Parallel/Frame/DistributedProbe.h"
#include "Render/Bricks/ArrayBrickSource.h"
#include "Render/Sampling/ImageError.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <mutex>

namespace
{

using namespace banyan;

constexpr std::uint64_t Budget = 1u << 26;
constexpr int BrickCells = 8;
const glm::ivec3 Samples{ 41, 33, 37 };

/// Cannot read one of its bricks.
class BrokenSource : public ArrayBrickSource
{
public:
  using ArrayBrickSource::ArrayBrickSource;
  BrickView Load(std::int64_t brick) override
  {
    throw Error("Brick " + std::to_string(brick) + " cannot be read.");
  }
};

/// The standard field, of which each rank has all and draws a zone.
class DistributedPlans : public ::testing::Test
{
protected:
  DistributedPlans()
    : Values(scenes::Sampled<float>(scenes::Standard, Samples))
    , Scene(scenes::Scene(Samples, { 310, 290 }, glm::dmat4(1.0), 1.4, false))
  {
    this->Scene.Transfer = scenes::Tabulate(scenes::Sparse);
    this->Wish.LeastCells = 7;
    this->Wish.CoarsestLevel = 2;
    this->Wish.Distance = this->Scene.SampleDistance;
  }

  template <class Source = ArrayBrickSource>
  Source MakeSource(ThreadPool& pool) const
  {
    return Source(scenes::ArrayOf(this->Values, Samples), BrickCells, MaskRange{ 0.0, 1.0 }, pool);
  }

  static std::vector<Box> ZonesOf(int ranks)
  {
    const glm::ivec3 cells = Samples - 1;
    std::vector<Box> zones;
    for (const Box& bricks : StaticZones((cells + BrickCells - 1) / BrickCells, ranks))
    {
      zones.push_back(CellsOfBricks(bricks, BrickCells, cells));
    }
    return zones;
  }

  std::vector<float> Values;
  RayScene Scene;
  SamplingWish Wish;
};

TEST_F(DistributedPlans, ProbesAreThePicturesOfOneRankOnEveryRank)
{
  for (const double distance : { 1.4, 0.1 })
  {
    RayScene scene = scenes::Scene(Samples, { 61, 47 }, glm::dmat4(1.0), distance, false);
    scene.Transfer = this->Scene.Transfer;
    FloatImage alone;
    FrameStatistics aloneTook;
    for (const int ranks : { 1, 2, 3, 7, 131 })
    {
      SCOPED_TRACE(ranks);
      std::mutex mutex;
      RunOnSimulatedRanks(ranks,
        [&](Communicator& communicator)
        {
          ThreadPool pool(1);
          ArrayBrickSource source = this->MakeSource(pool);
          FrameStatistics took;
          const FloatImage picture = DrawDistributedProbe(
            communicator, scene, { &source, ZonesOf(ranks), Budget, pool }, took);
          const std::lock_guard<std::mutex> lock(mutex);
          EXPECT_EQ(took.BytesComposited > 0, ranks > 1);
          EXPECT_EQ(picture.Rect, scene.Viewport);
          if (ranks == 1)
          {
            alone = picture;
            aloneTook = took;
            return;
          }
          EXPECT_LT(MaxDifference(picture, alone), 1e-5);
          EXPECT_EQ(took.SamplesTaken, aloneTook.SamplesTaken);
        });
    }
    EXPECT_GT(alone.At(30, 23).a, 0.05f);
  }
}

TEST_F(DistributedPlans, ArePlansOfOneRank)
{
  SamplingPlan alone;
  for (const int ranks : { 1, 2, 5 })
  {
    SCOPED_TRACE(ranks);
    std::mutex mutex;
    RunOnSimulatedRanks(ranks,
      [&](Communicator& communicator)
      {
        ThreadPool pool(1);
        ArrayBrickSource source = this->MakeSource(pool);
        FrameStatistics took;
        const SamplingPlan plan = PlanDistributed(
          communicator, this->Scene, { &source, ZonesOf(ranks), Budget, pool }, this->Wish, took);
        const std::lock_guard<std::mutex> lock(mutex);
        ASSERT_TRUE(plan.Samplings);
        EXPECT_GT(took.SamplesTaken, 0);
        if (ranks == 1)
        {
          alone = plan;
          return;
        }
        EXPECT_EQ(plan.Probes, alone.Probes);
        EXPECT_NEAR(plan.EstimatedError, alone.EstimatedError, 1e-2 * alone.EstimatedError);
        EXPECT_EQ(plan.Samplings->Samplings().size(), alone.Samplings->Samplings().size());
      });
  }
}

/// Tiles that two plans sample otherwise.
int TilesThatDiffer(const TileSamplings& a, const TileSamplings& b)
{
  int differ = 0;
  for (int y = 0; y < a.Tiles().y; ++y)
  {
    for (int x = 0; x < a.Tiles().x; ++x)
    {
      differ += !(a.Samplings()[a.NumberAt({ x, y })] == b.Samplings()[b.NumberAt({ x, y })]);
    }
  }
  return differ;
}

/// Rays that end early end elsewhere where zones are others. What is expected of samplings, and
/// which one is chosen, does not depend on that.
TEST_F(DistributedPlans, AreThoseOfOneRankWhereRaysEndEarly)
{
  const auto waves = [](const glm::dvec3& p)
  {
    const glm::dvec3 from = p - 0.5;
    return 0.75 * std::exp(-2.0 * glm::dot(from, from)) + 0.03 * std::sin(62.0 * p.x) +
           0.06 * std::sin(30.0 * p.y) + 0.02 * std::sin(40.0 * p.z);
  };
  this->Values = scenes::Sampled<float>(waves, Samples);
  int tiles = 0;
  int differ = 0;
  for (const double distance : { 0.7, 1.0, 1.3 })
  {
    RayScene scene = scenes::Scene(Samples, { 310, 290 }, glm::dmat4(1.0), distance, false);
    scene.Transfer =
      scenes::Tabulate([](double x) { return glm::dvec4(x, 1.0 - x, 0.5, 0.99 * x); });
    SamplingPlan alone;
    for (const int ranks : { 1, 2, 5 })
    {
      SCOPED_TRACE(ranks);
      std::mutex mutex;
      RunOnSimulatedRanks(ranks,
        [&](Communicator& communicator)
        {
          ThreadPool pool(1);
          ArrayBrickSource source = this->MakeSource(pool);
          FrameStatistics took;
          const SamplingPlan plan = PlanDistributed(
            communicator, scene, { &source, ZonesOf(ranks), Budget, pool }, this->Wish, took);
          const std::lock_guard<std::mutex> lock(mutex);
          ASSERT_TRUE(plan.Samplings);
          if (ranks == 1)
          {
            alone = plan;
          }
          else if (communicator.Rank() == 0)
          {
            EXPECT_NEAR(plan.EstimatedError, alone.EstimatedError, 5e-3 * alone.EstimatedError);
            EXPECT_EQ(plan.OpacityLimit, alone.OpacityLimit);
            tiles += plan.Samplings->Tiles().x * plan.Samplings->Tiles().y;
            differ += TilesThatDiffer(*plan.Samplings, *alone.Samplings);
          }
        });
    }
  }
  EXPECT_LE(differ, tiles / 200);
}

TEST_F(DistributedPlans, PicturesWithFewRaysAreThoseOfOneRank)
{
  FloatImage alone;
  auto tiles = std::make_shared<TileSamplings>(this->Scene.Camera.ImageSize(),
    std::vector<RaySampling>{ { 0, this->Scene.SampleDistance, 8 },
      { 0, this->Scene.SampleDistance, 2 }, { 1, 2.0 * this->Scene.SampleDistance, 4 },
      { 0, this->Scene.SampleDistance, 1 } });
  for (int y = 0; y < tiles->Tiles().y; ++y)
  {
    for (int x = 0; x < tiles->Tiles().x; ++x)
    {
      tiles->SetNumber({ x, y }, (x + 2 * y) % 4);
    }
  }
  RayScene scene = this->Scene;
  scene.Samplings = tiles;
  for (const BlendMode mode : { BlendMode::Composite, BlendMode::Maximum, BlendMode::Average })
  {
    SCOPED_TRACE(static_cast<int>(mode));
    scene.Blend.Mode = mode;
    for (const int ranks : { 1, 2, 5 })
    {
      SCOPED_TRACE(ranks);
      RunOnSimulatedRanks(ranks,
        [&](Communicator& communicator)
        {
          ThreadPool pool(1);
          ArrayBrickSource source = this->MakeSource(pool);
          FrameStatistics took;
          const FloatImage picture =
            DrawDistributed(communicator, scene, { &source, ZonesOf(ranks), Budget, pool }, took);
          if (communicator.Rank() != 0)
          {
            return;
          }
          if (ranks == 1)
          {
            alone = picture;
            // Pixels without rays have been filled.
            EXPECT_GT(alone.At(150, 150).a * alone.At(151, 150).a * alone.At(151, 151).a, 0.0f);
            return;
          }
          EXPECT_LT(MaxDifference(picture, alone), 1e-5);
        });
    }
  }
}

TEST_F(DistributedPlans, AFailureOnOneRankIsThrownOnAll)
{
  std::mutex mutex;
  std::vector<std::string> sentences;
  RunOnSimulatedRanks(4,
    [&](Communicator& communicator)
    {
      ThreadPool pool(1);
      ArrayBrickSource source = this->MakeSource(pool);
      BrokenSource broken = this->MakeSource<BrokenSource>(pool);
      BrickSource* const mine =
        communicator.Rank() == 2 ? static_cast<BrickSource*>(&broken) : &source;
      FrameStatistics took;
      try
      {
        SamplingWish wish = this->Wish;
        wish.CoarsestLevel = 0;
        PlanDistributed(communicator, this->Scene, { mine, ZonesOf(4), Budget, pool }, wish, took);
      }
      catch (const Error& error)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        sentences.emplace_back(error.what());
      }
    });
  ASSERT_EQ(sentences.size(), 4u);
  for (const std::string& sentence : sentences)
  {
    EXPECT_EQ(sentence, sentences.front());
    EXPECT_NE(sentence.find("cannot be read"), std::string::npos);
    EXPECT_NE(sentence.find("Rank 2"), std::string::npos) << sentence;
  }
}

} // namespace
