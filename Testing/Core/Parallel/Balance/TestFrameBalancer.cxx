// SPDX-License-Identifier: BSD-3-Clause
// Whatever moves zones, the picture is that of one rank.
#include "Parallel/Balance/FrameBalancer.h"
#include "Parallel/Frame/DistributedFrame.h"
#include "Render/Bricks/SeriesBrickSource.h"
#include "Render/Sampling/ImageError.h"
#include "Render/Scenes.h"
#include "Series/SeriesTesting.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

constexpr std::uint64_t Budget = 4u << 20;
constexpr int CoarsestLevel = 2;
const glm::ivec3 Samples{ 61, 49, 53 };
const glm::ivec2 Size{ 61, 47 };

/// One step of the standard field, encoded without loss.
class EncodedField
{
public:
  EncodedField()
    : Values(scenes::Sampled<float>(scenes::Standard, Samples))
  {
    ThreadPool pool(2);
    EncodeOptions options;
    options.ErrorBound = 0.0;
    options.BrickCells = 16;
    SeriesEncoder encoder(this->Folder / "field.banyan",
      banyan::testing::GridOf(Samples.x, Samples.y, Samples.z),
      { { "field", ScalarType::Float32, { "" }, { banyan::testing::RangeOf(this->Values) } } },
      options, pool);
    encoder.AddStep(0.0, { { this->Values.data() } });
    encoder.Finish();
    this->Series = SeriesFile::Open(this->Folder / "field.banyan");
  }

  std::vector<float> Values;
  std::shared_ptr<const SeriesFile> Series;

private:
  banyan::testing::TemporaryFolder Folder;
};

/// A camera that comes closer from frame to frame, until it is inside; then a parallel one.
RayScene SceneOfFrame(int frame, bool levels)
{
  static const double distances[] = { 1.4, 0.8, 0.5, 0.1, 1.2 };
  RayScene scene = scenes::Scene(Samples, Size, glm::dmat4(1.0), distances[frame % 5], frame == 4);
  scene.Transfer = scenes::Tabulate(scenes::Sparse);
  if (levels)
  {
    auto samplings = std::make_shared<TileSamplings>(
      Size, std::vector<RaySampling>{ { 0, scene.SampleDistance },
              { 1, 2.0 * scene.SampleDistance }, { CoarsestLevel, scene.SampleDistance } });
    const glm::ivec2 tiles = samplings->Tiles();
    for (int i = 0; i < tiles.x * tiles.y; ++i)
    {
      samplings->SetNumber({ i % tiles.x, i / tiles.x }, (i + frame) % 3);
    }
    scene.Samplings = samplings;
  }
  return scene;
}

struct Outcome
{
  std::vector<FloatImage> Pictures;
  double Moved = 0.0;
};

Outcome DrawFrames(const EncodedField& field, LoadBalancing mode, int ranks, bool levels)
{
  Outcome outcome;
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      BrickCache cache(Budget);
      SeriesBrickSource source(field.Series, {}, 0, cache);
      ThreadPool pool(1);
      FrameBalancer balancer;
      FrameBalancer::Field balanced;
      balanced.Cells = Samples - 1;
      balanced.BrickCells = 16;
      balanced.CoarsestLevel = CoarsestLevel;
      for (int frame = 0; frame < 5; ++frame)
      {
        balancer.Start(mode, balanced, communicator.Size());
        RayScene scene = SceneOfFrame(frame, levels);
        balancer.BeginFrame(scene, source);
        FrameStatistics statistics;
        FloatImage picture = DrawDistributed(
          communicator, scene, { &source, balancer.Zones(), Budget, pool }, statistics);
        balancer.EndFrame(communicator);
        if (communicator.Rank() == 0)
        {
          outcome.Pictures.push_back(std::move(picture));
          outcome.Moved += balancer.BytesMoved();
        }
      }
    });
  return outcome;
}

class EveryBalancing : public ::testing::TestWithParam<int>
{
};

TEST_P(EveryBalancing, DrawsThePicturesOfOneRank)
{
  const EncodedField field;
  for (const bool levels : { false, true })
  {
    const Outcome alone = DrawFrames(field, LoadBalancing::Off, 1, levels);
    for (const LoadBalancing mode : { LoadBalancing::Off, LoadBalancing::MeasuredCost })
    {
      const Outcome together = DrawFrames(field, mode, GetParam(), levels);
      ASSERT_EQ(together.Pictures.size(), 5u);
      for (std::size_t frame = 0; frame < 5; ++frame)
      {
        EXPECT_LT(MaxDifference(alone.Pictures[frame], together.Pictures[frame]), 1e-5)
          << "frame " << frame << ", mode " << static_cast<int>(mode);
      }
      EXPECT_EQ(together.Moved > 0.0, mode != LoadBalancing::Off && GetParam() > 1)
        << static_cast<int>(mode);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ranks, EveryBalancing, ::testing::Values(1, 2, 3, 7, 16));

TEST(FrameBalancer, KeepsWhatItLearnedUntilSomethingElseIsDrawn)
{
  FrameBalancer balancer;
  FrameBalancer::Field field;
  field.Cells = glm::ivec3(40);
  balancer.Start(LoadBalancing::MeasuredCost, field, 3);
  const std::vector<Box> first = balancer.Zones();
  EXPECT_EQ(first.size(), 3u);
  balancer.Start(LoadBalancing::MeasuredCost, field, 4);
  EXPECT_EQ(balancer.Zones().size(), 4u);
  field.Cells.z = 41;
  balancer.Start(LoadBalancing::MeasuredCost, field, 4);
  Box all;
  for (const Box& zone : balancer.Zones())
  {
    all = Union(all, zone);
  }
  EXPECT_EQ(all.Hi, field.Cells);
}

} // namespace
