// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/FrameCost.h"
#include "Parallel/Balance/ZoneTree.h"
#include "Parallel/Balance/Zones.h"
#include "Render/Sampling/ImageError.h"
#include "Render/Scenes.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace banyan;

const glm::ivec3 Samples{ 65, 49, 57 };
constexpr std::uint64_t Budget = 64u << 20;

struct Drawn
{
  FloatImage Picture;
  RayStatistics Statistics;
  BrickWork Work;
};

class FrameCostTest : public ::testing::Test
{
protected:
  FrameCostTest()
    : Pool(3)
    , Values(scenes::Sampled<float>(scenes::Standard, Samples))
    , Source(scenes::ArrayOf(this->Values, Samples), 16, { 0.0, 1.0 }, this->Pool)
    , Scene(scenes::Scene(Samples, { 101, 87 }, glm::dmat4(1.0), 1.2, false))
  {
    this->Scene.Transfer = scenes::Tabulate(scenes::Sparse);
  }

  Drawn Draw(const Box& cells, bool record = true)
  {
    Drawn drawn;
    RayScene scene = this->Scene;
    scene.Work = record ? &drawn.Work : nullptr;
    drawn.Picture = CastRays(scene, this->Source, cells, Budget, this->Pool, drawn.Statistics);
    return drawn;
  }

  ThreadPool Pool;
  std::vector<float> Values;
  ArrayBrickSource Source;
  RayScene Scene;
};

TEST_F(FrameCostTest, EverySampleIsThatOfABrickAndThePictureIsTheSame)
{
  const Drawn measured = this->Draw(this->Scene.DomainCells);
  const Drawn plain = this->Draw(this->Scene.DomainCells, false);
  EXPECT_EQ(MaxDifference(measured.Picture, plain.Picture), 0.0);
  const DrawnWork total = measured.Work.Total();
  EXPECT_EQ(total.Samples, measured.Statistics.SamplesTaken);
  EXPECT_EQ(static_cast<std::int64_t>(measured.Work.Parts.size()),
    measured.Statistics.BricksDrawn + measured.Statistics.BricksUniform);
  EXPECT_GT(total.Pixels, 0);
  EXPECT_GT(total.Seconds, 0.0);
  EXPECT_GT(measured.Work.DrawSeconds, 0.0);
  // Each ray is made once; those of tiles without bricks are not.
  EXPECT_GT(total.Rays, 0.0);
  EXPECT_LE(total.Rays, static_cast<double>(measured.Picture.Rect.Count()) + 1e-6);
  for (const BrickWork::Part& part : measured.Work.Parts)
  {
    EXPECT_TRUE(this->Scene.DomainCells.Contains(part.Cells));
    EXPECT_LE(std::max({ part.Cells.Size().x, part.Cells.Size().y, part.Cells.Size().z }), 16);
  }
  EXPECT_TRUE(plain.Work.Parts.empty());
}

TEST_F(FrameCostTest, CellsOfCoarserLevelsAreThoseOfTheFinest)
{
  auto samplings = std::make_shared<TileSamplings>(
    this->Scene.Camera.ImageSize(), std::vector<RaySampling>{ { 2, this->Scene.SampleDistance } });
  this->Scene.Samplings = samplings;
  const Drawn drawn = this->Draw(this->Scene.DomainCells);
  ASSERT_FALSE(drawn.Work.Parts.empty());
  Box all;
  for (const BrickWork::Part& part : drawn.Work.Parts)
  {
    all = Union(all, part.Cells);
    EXPECT_TRUE(this->Scene.DomainCells.Contains(part.Cells));
  }
  EXPECT_GT(all.Count(), this->Scene.DomainCells.Count() / 2);
}

TEST_F(FrameCostTest, AllRanksGatherWhatOneWouldAddUp)
{
  for (const int ranks : { 1, 3, 7 })
  {
    const glm::ivec3 cells = this->Scene.DomainCells.Hi;
    const std::vector<Box> zones = ZonesOf(EqualZoneTree(cells, ranks));
    const BrickCosts view = ViewCosts(this->Scene, cells, 8);
    std::vector<BrickWork> work;
    for (const Box& zone : zones)
    {
      work.push_back(this->Draw(zone).Work);
    }
    const FrameCost expected = SumCost(work, view);
    RunOnSimulatedRanks(ranks,
      [&](Communicator& communicator)
      {
        const FrameCost all = GatherCost(
          communicator, work[static_cast<std::size_t>(communicator.Rank())], zones, view);
        for (int rank = 0; rank < ranks; ++rank)
        {
          EXPECT_EQ(all.Ranks[rank].Seconds, expected.Ranks[rank].Seconds);
          EXPECT_EQ(all.Ranks[rank].Work, expected.Ranks[rank].Work);
        }
        for (std::size_t i = 0; i < expected.Blocks.Values.size(); ++i)
        {
          EXPECT_NEAR(all.Blocks.Values[i], expected.Blocks.Values[i],
            1e-5 * (1.0 + expected.Blocks.Values[i]));
        }
      });
  }
}

TEST_F(FrameCostTest, TheViewTellsWhatBlocksTake)
{
  // Everything visible and nothing hidden: samples are those of the volume on the screen.
  for (glm::vec4& entry : this->Scene.Transfer.Entries)
  {
    entry.a = 0.001f;
  }
  for (const bool parallel : { false, true })
  {
    for (const double distance : { 1.4, 0.4, 0.1 })
    {
      const RayScene seen =
        scenes::Scene(Samples, { 101, 87 }, glm::dmat4(1.0), distance, parallel);
      this->Scene.Camera = seen.Camera;
      const BrickCosts view = ViewCosts(this->Scene, this->Scene.DomainCells.Hi, 16);
      BrickCosts truth(this->Scene.DomainCells.Hi, 16);
      for (const BrickWork::Part& part : this->Draw(this->Scene.DomainCells).Work.Parts)
      {
        truth.Add(part.Cells, static_cast<double>(part.Took.Samples));
      }
      double product = 0.0;
      double a = 0.0;
      double b = 0.0;
      for (std::size_t i = 0; i < truth.Values.size(); ++i)
      {
        product += truth.Values[i] * view.Values[i];
        a += truth.Values[i] * truth.Values[i];
        b += view.Values[i] * view.Values[i];
      }
      EXPECT_GT(product / std::sqrt(a * b), distance > 1.0   ? 0.99
                                            : distance > 0.2 ? 0.95
                                                             : 0.8)
        << distance << parallel;
    }
  }
}

TEST_F(FrameCostTest, PartsThatCanBeSeenAreThoseOfBricks)
{
  const glm::ivec3 cells = this->Scene.DomainCells.Hi;
  for (const float part : VisibleParts(this->Scene, this->Source, cells, 32))
  {
    EXPECT_GE(part, 0.0f);
    EXPECT_LE(part, 1.0f + 1e-6f);
  }
  for (glm::vec4& entry : this->Scene.Transfer.Entries)
  {
    entry.a = 0.0f;
  }
  const std::vector<float> none = VisibleParts(this->Scene, this->Source, cells, 32);
  EXPECT_TRUE(std::all_of(none.begin(), none.end(), [](float part) { return part == 0.0f; }));
  const BrickCosts view = ViewCosts(this->Scene, cells, 32, none);
  EXPECT_EQ(CostSums(view).Total(), 0.0);
  EXPECT_THROW(ViewCosts(this->Scene, cells, 16, none), Error);
  this->Scene.Blend.Mode = BlendMode::Maximum;
  for (const float part : VisibleParts(this->Scene, this->Source, cells, 32))
  {
    EXPECT_NEAR(part, 1.0f, 1e-6f);
  }
}

} // namespace
