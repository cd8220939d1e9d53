// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Parallel/Balance/Zones.h"
#include "Parallel/Composite/CompositeWhileCasting.h"
#include "Parallel/Frame/DistributedFrame.h"
#include "Render/Bricks/ArrayBrickSource.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>

namespace
{

using namespace banyan;

const glm::ivec3 Samples{ 41, 33, 37 };
constexpr std::uint64_t Budget = 1u << 20;
constexpr int CellsOfBrick = 4;

/// Bricks of the standard field, of which one at a time cannot be read.
class FailingSource final : public ArrayBrickSource
{
public:
  /// @param loadsUntilFailure of all bricks; negative for none
  FailingSource(const std::vector<float>& values, ThreadPool& pool, int loadsUntilFailure)
    : ArrayBrickSource(scenes::ArrayOf(values, Samples), CellsOfBrick, MaskRange{ 0.0, 1.0 }, pool)
    , Left(loadsUntilFailure)
  {
  }

  BrickView Load(std::int64_t brick) override
  {
    if (this->Left-- == 0)
    {
      throw Error("The disk is full of holes.");
    }
    return ArrayBrickSource::Load(brick);
  }

private:
  std::atomic<int> Left;
};

/// Large enough for compositing to go in several chunks.
RayScene SceneOf(double distance)
{
  RayScene scene = scenes::Scene(Samples, { 301, 282 }, glm::dmat4(1.0), distance, false);
  scene.Transfer = scenes::Tabulate(scenes::Sparse);
  return scene;
}

std::vector<Box> ZonesFor(const RayScene& scene, int ranks)
{
  std::vector<Box> zones;
  const glm::ivec3 bricks = (Samples - 1 + CellsOfBrick - 1) / CellsOfBrick;
  for (const Box& box : StaticZones(bricks, ranks))
  {
    zones.push_back(CellsOfBricks(box, CellsOfBrick, scene.DomainCells.Hi));
  }
  return zones;
}

FloatImage Draw(const RayScene& scene, const std::vector<float>& values, int ranks, int threads,
  const CompositeOptions& compositing)
{
  FloatImage drawn;
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      ThreadPool pool(threads);
      FailingSource source(values, pool, -1);
      FrameStatistics statistics;
      FloatImage picture = DrawDistributed(communicator, scene,
        { &source, ZonesFor(scene, ranks), Budget, pool }, statistics, compositing);
      if (communicator.Rank() == 0)
      {
        drawn = std::move(picture);
      }
    });
  return drawn;
}

/// Samples of two levels and of less than one ray per pixel, tile by tile.
void SampleInSeveralWays(RayScene& scene)
{
  const glm::ivec2 size = scene.Camera.ImageSize();
  auto samplings = std::make_shared<TileSamplings>(
    size, std::vector<RaySampling>{ { 0, scene.SampleDistance }, { 1, 2.0 * scene.SampleDistance },
            { 0, scene.SampleDistance, 2 } });
  const glm::ivec2 tiles = TileSamplings::TilesOf(size);
  for (int y = 0; y < tiles.y; ++y)
  {
    for (int x = 0; x < tiles.x; ++x)
    {
      samplings->SetNumber({ x, y }, (x + 2 * y) % 3);
    }
  }
  scene.Samplings = samplings;
}

class WhileCasting : public ::testing::TestWithParam<int>
{
};

TEST_P(WhileCasting, CompositesTheSamePictureToTheLastBit)
{
  const std::vector<float> values = scenes::Sampled<float>(scenes::Standard, Samples);
  for (const bool fewBits : { false, true })
  {
    for (const bool several : { false, true })
    {
      // The camera outside and inside of the volume.
      for (const double distance : { 1.4, 0.1 })
      {
        RayScene scene = SceneOf(distance);
        if (several)
        {
          SampleInSeveralWays(scene);
        }
        CompositeOptions options;
        options.Transport = fewBits ? PixelTransport::WithinOne : PixelTransport::Floats;
        options.WhileCasting = false;
        const FloatImage after = Draw(scene, values, GetParam(), 1, options);
        options.WhileCasting = true;
        for (const int threads : { 1, 3 })
        {
          const FloatImage during = Draw(scene, values, GetParam(), threads, options);
          ASSERT_EQ(after.Pixels.size(), during.Pixels.size());
          EXPECT_TRUE(after.Pixels == during.Pixels) << distance << " " << threads;
        }
      }
    }
  }
}

TEST_P(WhileCasting, KeepsTheScheduleWhileNothingMoves)
{
  const std::vector<float> values = scenes::Sampled<float>(scenes::Standard, Samples);
  const int ranks = GetParam();
  // Twice the same view, another one twice, the first one again; then the root blends its picture
  // over something.
  const std::vector<double> distances{ 1.4, 1.4, 0.8, 0.8, 1.4, 1.4 };
  std::vector<FloatImage> anew;
  for (const double distance : distances)
  {
    anew.push_back(Draw(SceneOf(distance), values, ranks, 1, {}));
  }
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      ThreadPool pool(1);
      FailingSource source(values, pool, -1);
      CompositePlanCache plans;
      CompositeOptions options;
      options.Plans = &plans;
      for (std::size_t frame = 0; frame < distances.size(); ++frame)
      {
        const RayScene scene = SceneOf(distances[frame]);
        options.Behind = frame == 5 ? scene.Viewport : PixelRect{};
        FrameStatistics statistics;
        const FloatImage picture = DrawDistributed(communicator, scene,
          { &source, ZonesFor(scene, ranks), Budget, pool }, statistics, options);
        if (communicator.Rank() == 0)
        {
          EXPECT_TRUE(picture.Pixels == anew[frame].Pixels) << "frame " << frame;
        }
      }
      EXPECT_EQ(plans.Misses(), ranks > 1 ? 4 : 0);
      EXPECT_EQ(plans.Hits(), ranks > 1 ? 2 : 0);
    });
}

/// Wherever and whenever a rank fails, others have sent, and wait for, what it has not.
TEST_P(WhileCasting, AFailureOfOneRankIsThrownOnAll)
{
  const std::vector<float> values = scenes::Sampled<float>(scenes::Standard, Samples);
  const RayScene scene = SceneOf(1.4);
  const int ranks = GetParam();
  for (int failing = 0; failing < ranks; failing += std::max(1, ranks / 4))
  {
    for (const int loads : { 0, 1, 40 / ranks })
    {
      std::atomic<int> thrown{ 0 };
      RunOnSimulatedRanks(ranks,
        [&](Communicator& communicator)
        {
          ThreadPool pool(1);
          // Few bricks at a time, so that some are drawn before the one that fails.
          FailingSource source(values, pool, communicator.Rank() == failing ? loads : -1);
          FrameStatistics statistics;
          try
          {
            DrawDistributed(
              communicator, scene, { &source, ZonesFor(scene, ranks), 4096, pool }, statistics);
          }
          catch (const Error& error)
          {
            const std::string expected =
              "Rank " + std::to_string(failing) + ": The disk is full of holes.";
            EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
            ++thrown;
          }
        });
      EXPECT_EQ(thrown, ranks) << failing << " " << loads;
    }
  }
}

TEST_P(WhileCasting, BeginsBeforeTheLastRay)
{
  const std::vector<float> values = scenes::Sampled<float>(scenes::Standard, Samples);
  const RayScene scene = SceneOf(1.4);
  const int ranks = GetParam();
  const std::vector<Box> zones = ZonesFor(scene, ranks);
  // All bricks at once: what is behind is drawn before the next tile.
  constexpr std::uint64_t allMemory = ~std::uint64_t{ 0 };
  std::atomic<int> ahead{ 0 };
  std::atomic<int> chunks{ 0 };
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      ThreadPool pool(1);
      FailingSource source(values, pool, -1);
      std::vector<int> order(static_cast<std::size_t>(ranks));
      for (int rank = 0; rank < ranks; ++rank)
      {
        order[static_cast<std::size_t>(rank)] = rank;
      }
      CompositeOptions options;
      options.Footprints =
        FootprintsOfZones(scene.Camera, scene.IndexToWorld, zones, scene.Viewport);
      CompositeStatistics sent;
      CompositeWhileCasting compositor(communicator, order, scene.Viewport, options, sent);
      RayStatistics rays;
      const FloatImage mine = CastRaysWatched(scene, source,
        zones[static_cast<std::size_t>(communicator.Rank())], allMemory, pool, rays, compositor);
      ahead += compositor.ChunksAhead();
      chunks += PlanCompositing(options.Footprints, scene.Viewport, {}, true).Chunks;
      compositor.Finish(&mine);
    });
  EXPECT_GE(chunks, 4 * ranks);
  EXPECT_GT(ahead, chunks / 2);
}

INSTANTIATE_TEST_SUITE_P(Ranks, WhileCasting, ::testing::Values(2, 3, 4, 7, 16));

} // namespace
