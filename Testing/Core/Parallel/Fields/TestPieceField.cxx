// SPDX-License-Identifier: BSD-3-Clause
// Wherever plain data lies and whoever draws it, the picture is that of one rank.
#include "Parallel/Fields/PieceField.h"
#include "Parallel/Fields/Pieces.h"
#include "Parallel/Frame/DistributedFrame.h"
#include "Render/Levels/RayCaster.h"

#include <gtest/gtest.h>

#include <mutex>

namespace
{

using namespace pieces;

constexpr std::uint64_t Budget = 4u << 20;
constexpr int BrickCells = 8;
constexpr int Frames = 5;
const glm::ivec3 Samples{ 45, 37, 41 };
const glm::ivec2 Size{ 61, 47 };

/// A camera that comes closer from frame to frame, until it is inside; then a parallel one.
RayScene SceneOfFrame(int frame, bool shaded)
{
  static const double distances[] = { 1.4, 0.8, 0.5, 0.1, 1.2 };
  RayScene scene = scenes::Scene(Samples, Size, glm::dmat4(1.0), distances[frame % 5], frame == 4);
  scene.Transfer = scenes::Tabulate(scenes::Sparse);
  scene.Shading.On = shaded;
  scene.Shading.Specular = shaded ? 0.3f : 0.0f;
  return scene;
}

struct Outcome
{
  std::vector<FloatImage> Pictures;
  double Moved = 0.0;
  std::uint64_t Hits = 0;
  std::uint64_t Misses = 0;
  std::uint64_t MostHeld = 0; ///< by a rank
};

struct Case
{
  Deal Dealing = Deal::Blocks;
  LoadBalancing Mode = LoadBalancing::MeasuredCost;
  bool Shaded = false;
  std::uint64_t Budget = ::Budget; ///< for fetched bricks
};

template <class T>
Outcome DrawFrames(const std::vector<T>& values, const Case& drawn, int ranks)
{
  Outcome outcome;
  std::mutex mutex;
  const std::vector<Box> dealt = Dealt(drawn.Dealing, Samples, ranks);
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      const Piece<T> mine(values, Samples, dealt[static_cast<std::size_t>(communicator.Rank())]);
      ThreadPool pool(1);
      PieceField field;
      field.Take(communicator, dealt, mine.Array, Samples - 1, BrickCells, drawn.Mode, pool);
      for (int frame = 0; frame < Frames; ++frame)
      {
        RayScene scene = SceneOfFrame(frame, drawn.Shaded);
        field.BeginFrame(communicator, scene, drawn.Budget);
        FrameStatistics statistics;
        FloatImage picture = DrawDistributed(
          communicator, scene, { field.Source(), field.Zones(), Budget, pool }, statistics);
        field.EndFrame(communicator);
        const std::lock_guard<std::mutex> lock(mutex);
        outcome.MostHeld = std::max(outcome.MostHeld, field.FetchedBytes());
        if (communicator.Rank() == 0)
        {
          outcome.Pictures.push_back(std::move(picture));
          outcome.Moved += static_cast<double>(field.FrameStatistics().BytesMoved);
          outcome.Hits += field.FrameStatistics().Hits;
          outcome.Misses += field.FrameStatistics().Misses;
        }
      }
    });
  return outcome;
}

/// The pictures of one process that has everything in one array.
template <class T>
std::vector<FloatImage> PicturesOfOne(const std::vector<T>& values, bool shaded)
{
  ThreadPool pool(1);
  const SampleArray array = scenes::ArrayOf(values, Samples);
  const ValueRange range = FiniteRange(array, pool);
  ArrayBrickSource source(array, 16, { range.Low, range.High }, pool);
  std::vector<FloatImage> pictures;
  for (int frame = 0; frame < Frames; ++frame)
  {
    RayScene scene = SceneOfFrame(frame, shaded);
    FrameStatistics statistics;
    const auto alone = MakeSelfCommunicator();
    pictures.push_back(
      DrawDistributed(*alone, scene, { &source, { scene.DomainCells }, Budget, pool }, statistics));
  }
  return pictures;
}

void ExpectSame(const std::vector<FloatImage>& a, const std::vector<FloatImage>& b, double most)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t frame = 0; frame < a.size(); ++frame)
  {
    EXPECT_LT(MaxDifference(a[frame], b[frame]), most) << "frame " << frame;
  }
}

std::vector<float> StandardValues()
{
  return scenes::Sampled<float>(scenes::Standard, Samples);
}

class EveryRankCountOfPieces : public ::testing::TestWithParam<int>
{
};

TEST_P(EveryRankCountOfPieces, DrawsThePicturesOfOneRank)
{
  const std::vector<float> values = StandardValues();
  for (const bool shaded : { false, true })
  {
    const std::vector<FloatImage> alone = PicturesOfOne(values, shaded);
    for (const LoadBalancing mode : { LoadBalancing::Off, LoadBalancing::MeasuredCost })
    {
      SCOPED_TRACE(::testing::Message() << "mode " << static_cast<int>(mode) << shaded);
      const Outcome together = DrawFrames(values, { Deal::Blocks, mode, shaded }, GetParam());
      ExpectSame(alone, together.Pictures, 1e-5);
      const bool moves = mode != LoadBalancing::Off && GetParam() > 1;
      EXPECT_EQ(together.Misses > 0, moves);
      EXPECT_EQ(together.Moved > 0.0, moves || (shaded && GetParam() > 1));
      EXPECT_EQ(together.MostHeld > 0, moves);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ranks, EveryRankCountOfPieces, ::testing::Values(1, 2, 3, 7, 16));

class EveryDeal : public ::testing::TestWithParam<Deal>
{
};

TEST_P(EveryDeal, DrawsThePicturesOfOneRank)
{
  const std::vector<float> values = StandardValues();
  for (const bool shaded : { false, true })
  {
    const std::vector<FloatImage> alone = PicturesOfOne(values, shaded);
    for (const int ranks : { 2, 6 })
    {
      for (const LoadBalancing mode : { LoadBalancing::Off, LoadBalancing::MeasuredCost })
      {
        SCOPED_TRACE(::testing::Message() << ranks << " ranks, mode " << static_cast<int>(mode));
        ExpectSame(alone, DrawFrames(values, { GetParam(), mode, shaded }, ranks).Pictures, 1e-5);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Deals, EveryDeal,
  ::testing::Values(
    Deal::Slabs, Deal::Ghosts, Deal::OneHasAll, Deal::Everybody, Deal::SomeIdle, Deal::Pinwheel));

TEST(PieceField, DrawsAroundAHoleInAllModesAlike)
{
  const std::vector<float> values = StandardValues();
  for (const bool shaded : { false, true })
  {
    const Outcome stays = DrawFrames(values, { Deal::Hole, LoadBalancing::Off, shaded }, 5);
    const Outcome moves =
      DrawFrames(values, { Deal::Hole, LoadBalancing::MeasuredCost, shaded }, 5);
    ExpectSame(stays.Pictures, moves.Pictures, 1e-5);
    EXPECT_GT(moves.Misses, 0u);
    const std::vector<FloatImage> whole = PicturesOfOne(values, shaded);
    EXPECT_GT(MaxDifference(whole[0], stays.Pictures[0]), 0.02) << "nothing is missing";
  }
}

TEST(PieceField, KeepsWhatItFetchedWithinTheBudget)
{
  const std::vector<float> values = StandardValues();
  const std::vector<FloatImage> alone = PicturesOfOne(values, false);
  const Outcome plenty = DrawFrames(values, { Deal::OneHasAll }, 4);
  EXPECT_GT(plenty.Hits, 0u);
  for (const std::uint64_t budget : { std::uint64_t{ 0 }, plenty.MostHeld / 3 })
  {
    Case little{ Deal::OneHasAll };
    little.Budget = budget;
    const Outcome outcome = DrawFrames(values, little, 4);
    EXPECT_LE(outcome.MostHeld, budget);
    EXPECT_EQ(outcome.Misses > 0, budget > 0);
    ExpectSame(alone, outcome.Pictures, 1e-5);
  }
}

TEST(PieceField, MovesValuesOfAllTypes)
{
  const auto check = [](const auto& values)
  {
    for (const bool shaded : { false, true })
    {
      const Outcome outcome =
        DrawFrames(values, { Deal::Slabs, LoadBalancing::MeasuredCost, shaded }, 3);
      EXPECT_GT(outcome.Misses, 0u);
      ExpectSame(PicturesOfOne(values, shaded), outcome.Pictures, 1e-5);
    }
  };
  check(scenes::Sampled<double>(scenes::Standard, Samples));
  check(scenes::Sampled<std::uint8_t>(scenes::Standard, Samples, 1.9));
  check(scenes::Sampled<std::int32_t>(scenes::Standard, Samples, 1.9));
}

} // namespace
