// SPDX-License-Identifier: BSD-3-Clause
// Coarser levels of plain data in pieces: the picture is that of one rank's levels.
#include "Parallel/Fields/PieceField.h"
#include "Parallel/Fields/Pieces.h"
#include "Parallel/Frame/DistributedFrame.h"
#include "Render/Levels/RayCaster.h"

#include <gtest/gtest.h>

#include <mutex>
#include <random>

namespace
{

using namespace pieces;

constexpr std::uint64_t Budget = 4u << 20;
constexpr int BrickCells = 8;
constexpr int CoarsestLevel = 3;
const glm::ivec3 Samples{ 45, 37, 41 };
const glm::ivec3 FlatSamples{ 93, 37, 11 }; // the axes rest 0, 1 and 3 levels
const glm::ivec2 Size{ 61, 47 };

struct Drawn
{
  int Level;
  bool Shaded;
  double Distance; ///< of the eye
};

const std::vector<Drawn>& Frames()
{
  static const std::vector<Drawn> frames = { { 1, false, 1.4 }, { 2, false, 0.8 },
    { 3, false, 1.2 }, { 1, true, 0.8 }, { 2, true, 0.1 }, { 3, true, 1.4 } };
  return frames;
}

RayScene SceneOf(const Drawn& drawn, const glm::ivec3& samples = Samples)
{
  RayScene scene =
    scenes::Scene(samples, Size, glm::dmat4(1.0), drawn.Distance, /*parallel=*/false);
  scene.Levels = LevelEdges::Following(samples - 1);
  scene.Transfer = scenes::Tabulate(scenes::Sparse);
  scene.Shading.On = drawn.Shaded;
  scene.Shading.Specular = drawn.Shaded ? 0.3f : 0.0f;
  scene.Samplings = std::make_shared<const TileSamplings>(
    Size, std::vector{ RaySampling{ drawn.Level, scene.SampleDistance } });
  return scene;
}

template <class T>
std::vector<FloatImage> PicturesOfOne(const std::vector<T>& values,
  const std::shared_ptr<const HiddenCells>& hidden = nullptr, const glm::ivec3& samples = Samples)
{
  ThreadPool pool(1);
  const SampleArray array = scenes::ArrayOf(values, samples);
  const ValueRange range = FiniteRange(array, pool);
  ArrayBrickSource source(array, 16, { range.Low, range.High }, pool);
  source.Hide(hidden);
  std::vector<FloatImage> pictures;
  for (const Drawn& drawn : Frames())
  {
    const RayScene scene = SceneOf(drawn, samples);
    FrameStatistics statistics;
    const auto alone = MakeSelfCommunicator();
    pictures.push_back(
      DrawDistributed(*alone, scene, { &source, { scene.DomainCells }, Budget, pool }, statistics));
  }
  return pictures;
}

template <class T>
void ExpectPicturesOfOne(const std::vector<T>& values, Deal deal, LoadBalancing mode, int ranks,
  const std::shared_ptr<const HiddenCells>& hidden = nullptr, const glm::ivec3& samples = Samples)
{
  const std::vector<FloatImage> alone = PicturesOfOne(values, hidden, samples);
  const std::vector<Box> dealt = Dealt(deal, samples, ranks);
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      const Piece<T> mine(values, samples, dealt[static_cast<std::size_t>(communicator.Rank())]);
      ThreadPool pool(1);
      PieceField field;
      field.Take(communicator, dealt, mine.Array, samples - 1, BrickCells, mode, pool);
      field.Source()->Hide(hidden);
      for (std::size_t frame = 0; frame < Frames().size(); ++frame)
      {
        RayScene scene = SceneOf(Frames()[frame], samples);
        field.BeginFrame(communicator, scene, Budget);
        field.BringLevels(communicator, scene, CoarsestLevel, Budget, pool);
        FrameStatistics statistics;
        const FloatImage picture = DrawDistributed(
          communicator, scene, { field.Source(), field.Zones(), Budget, pool }, statistics);
        field.EndFrame(communicator);
        if (communicator.Rank() == 0)
        {
          EXPECT_LT(MaxDifference(picture, alone[frame]), 1e-5)
            << "frame " << frame << ", ranks " << ranks << ", deal " << static_cast<int>(deal);
          EXPECT_GT(statistics.SamplesTaken, 0);
        }
      }
    });
}

class EveryRankCountOfLevels : public ::testing::TestWithParam<int>
{
};

TEST_P(EveryRankCountOfLevels, DrawsThePicturesOfOneRank)
{
  const std::vector<float> values = scenes::Sampled<float>(scenes::Standard, Samples);
  for (const Deal deal : { Deal::Slabs, Deal::Blocks, Deal::Ghosts, Deal::OneHasAll,
         Deal::Everybody, Deal::SomeIdle, Deal::Pinwheel })
  {
    ExpectPicturesOfOne(values, deal, LoadBalancing::Off, GetParam());
  }
  ExpectPicturesOfOne(values, Deal::Blocks, LoadBalancing::MeasuredCost, GetParam());
}

TEST_P(EveryRankCountOfLevels, DrawsThePicturesOfOneRankOfAFlatGrid)
{
  const std::vector<float> values = scenes::Sampled<float>(scenes::Standard, FlatSamples);
  for (const Deal deal : { Deal::Slabs, Deal::Blocks, Deal::Ghosts, Deal::Pinwheel })
  {
    ExpectPicturesOfOne(values, deal, LoadBalancing::Off, GetParam(), nullptr, FlatSamples);
  }
  ExpectPicturesOfOne(
    values, Deal::Blocks, LoadBalancing::MeasuredCost, GetParam(), nullptr, FlatSamples);
}

// 24 leave ranks with pieces in which no coarse cell begins, and with none.
INSTANTIATE_TEST_SUITE_P(Ranks, EveryRankCountOfLevels, ::testing::Values(1, 2, 3, 5, 7, 24));

TEST(PieceLevels, OfBytesAreThoseOfOneRank)
{
  std::vector<unsigned char> values;
  for (const float value : scenes::Sampled<float>(scenes::Standard, Samples))
  {
    values.push_back(static_cast<unsigned char>(value > 0.4f ? 1 : 0));
  }
  ExpectPicturesOfOne(values, Deal::Blocks, LoadBalancing::Off, 3);
}

/// Cells that are hidden on one rank and drawn by another, at all levels; bricks of one value too.
TEST(PieceLevels, HiddenCellsAreThoseOfOneRank)
{
  const glm::ivec3 cells = Samples - 1;
  std::mt19937 random(5);
  for (const bool uniform : { false, true })
  {
    const std::vector<float> values = scenes::Sampled<float>(
      [uniform](const glm::dvec3& p) { return uniform ? 0.75 : scenes::Standard(p); }, Samples);
    std::vector<std::uint8_t> flags(static_cast<std::size_t>(cells.x) * cells.y * cells.z);
    for (std::size_t i = 0; i < flags.size(); ++i)
    {
      const auto x = static_cast<int>(i) % cells.x;
      flags[i] = x > 20 && x < 30 ? 32 : random() % 20 == 0 ? 33 : 1;
    }
    const auto hidden = std::make_shared<HiddenCells>(cells);
    hidden->Hide({ glm::ivec3(0), cells }, flags.data(), 32);
    for (const LoadBalancing mode : { LoadBalancing::Off, LoadBalancing::MeasuredCost })
    {
      ExpectPicturesOfOne(values, Deal::Blocks, mode, 3, hidden);
      ExpectPicturesOfOne(values, Deal::OneHasAll, mode, 3, hidden);
    }
    const FloatImage whole = PicturesOfOne(values)[0];
    EXPECT_GT(MaxDifference(whole, PicturesOfOne(values, hidden)[0]), 0.05);
  }
}

TEST(PieceLevels, PiecesWithAHoleAreDrawnWhereTheyAreKnown)
{
  const std::vector<float> values = scenes::Sampled<float>(scenes::Standard, Samples);
  const std::vector<Box> dealt = Dealt(Deal::Hole, Samples, 4);
  RunOnSimulatedRanks(4,
    [&](Communicator& communicator)
    {
      const Piece<float> mine(
        values, Samples, dealt[static_cast<std::size_t>(communicator.Rank())]);
      ThreadPool pool(1);
      PieceField field;
      field.Take(
        communicator, dealt, mine.Array, Samples - 1, BrickCells, LoadBalancing::Off, pool);
      RayScene scene = SceneOf({ 1, true, 1.4 });
      field.BeginFrame(communicator, scene, Budget);
      field.BringLevels(communicator, scene, CoarsestLevel, Budget, pool);
      FrameStatistics statistics;
      const FloatImage picture = DrawDistributed(
        communicator, scene, { field.Source(), field.Zones(), Budget, pool }, statistics);
      EXPECT_GT(statistics.SamplesTaken, 0);
      for (const glm::vec4& pixel : picture.Pixels)
      {
        EXPECT_TRUE(std::isfinite(pixel.r + pixel.g + pixel.b + pixel.a));
      }
    });
}

} // namespace
