// SPDX-License-Identifier: BSD-3-Clause
// Colours of plain data in pieces: the pictures are those of one rank, at all levels.
#include "Parallel/Fields/PieceField.h"
#include "Parallel/Fields/Pieces.h"
#include "Parallel/Frame/DistributedFrame.h"
#include "Render/ColouredFields.h"
#include "Render/Levels/RayCaster.h"

#include <gtest/gtest.h>

namespace
{

using namespace pieces;

constexpr std::uint64_t Budget = 8u << 20;
const glm::ivec3 Samples{ 45, 37, 41 };
const glm::ivec2 Size{ 61, 47 };

RayScene SceneOf(int level, bool shaded)
{
  RayScene scene = coloured::SceneOf(Samples, Size, coloured::SparseWhite, 0.8);
  scene.Shading.On = shaded;
  scene.Samplings = std::make_shared<const TileSamplings>(
    Size, std::vector{ RaySampling{ level, scene.SampleDistance } });
  return scene;
}

std::vector<FloatImage> PicturesOfOne(const std::vector<std::uint8_t>& values)
{
  ThreadPool pool(1);
  ArrayBrickSource source(coloured::ArrayOf(values, Samples, 4), 16, { 0.0, 255.0 }, pool);
  std::vector<FloatImage> pictures;
  for (int frame = 0; frame < 6; ++frame)
  {
    const RayScene scene = SceneOf(frame / 2, frame % 2 == 1);
    FrameStatistics statistics;
    const auto alone = MakeSelfCommunicator();
    pictures.push_back(
      DrawDistributed(*alone, scene, { &source, { scene.DomainCells }, Budget, pool }, statistics));
  }
  return pictures;
}

class ColouredPieces : public ::testing::TestWithParam<int>
{
};

TEST_P(ColouredPieces, DrawThePicturesOfOneRank)
{
  const std::vector<std::uint8_t> values = coloured::Sampled(Samples, 4);
  const std::vector<double> numbers = coloured::NumbersOf(values, 4);
  const std::vector<FloatImage> alone = PicturesOfOne(values);
  EXPECT_GT(coloured::Most(alone[0], coloured::ColourOf), 0.05f);
  const int ranks = GetParam();
  for (const Deal deal : { Deal::Slabs, Deal::SomeIdle, Deal::OneHasAll, Deal::Pinwheel })
  {
    const std::vector<Box> dealt = Dealt(deal, Samples, ranks);
    RunOnSimulatedRanks(ranks,
      [&](Communicator& communicator)
      {
        Piece<double> mine(numbers, Samples, dealt[static_cast<std::size_t>(communicator.Rank())]);
        mine.Array.Component = SampleArray::Colours;
        ThreadPool pool(1);
        PieceField field;
        field.Take(
          communicator, dealt, mine.Array, Samples - 1, 8, LoadBalancing::MeasuredCost, pool);
        EXPECT_TRUE(field.Source()->HasColours());
        for (std::size_t frame = 0; frame < alone.size(); ++frame)
        {
          RayScene scene = SceneOf(static_cast<int>(frame) / 2, frame % 2 == 1);
          field.BeginFrame(communicator, scene, Budget);
          field.BringLevels(communicator, scene, 2, Budget, pool);
          FrameStatistics statistics;
          const FloatImage picture = DrawDistributed(
            communicator, scene, { field.Source(), field.Zones(), Budget, pool }, statistics);
          field.EndFrame(communicator);
          if (communicator.Rank() == 0)
          {
            EXPECT_LT(MaxDifference(picture, alone[frame]), 1e-5)
              << "frame " << frame << ", deal " << static_cast<int>(deal);
          }
        }
      });
  }
}

INSTANTIATE_TEST_SUITE_P(Ranks, ColouredPieces, ::testing::Values(1, 2, 3, 7));

} // namespace
