// SPDX-License-Identifier: BSD-3-Clause
// Bricks that are decoded before anybody asks for them are those that are asked for later.
#include "Series/SeriesTesting.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"
#include "Render/Bricks/SeriesBrickSource.h"
#include "Render/Scenes.h"
#include "Render/Steps/EnhancedBrickSource.h"
#include "Render/Steps/TimeStepPrefetcher.h"

#include <numeric>

namespace banyan::testing
{
namespace
{

constexpr int Steps = 6;
constexpr std::uint64_t Plenty = std::uint64_t{ 1 } << 30;
constexpr std::uint64_t BrickBytes = 17 * 17 * 17 * sizeof(float) + 256;

/// 4 x 2 x 2 bricks of 16 that all change from step to step, but for one, which has one value.
class Ahead : public ::testing::Test
{
protected:
  void SetUp() override
  {
    const auto values = Sample<float>(this->Domain, Steps,
      [](int x, int y, int z, int s)
      { return x >= 48 && y >= 16 && z >= 16 ? 1.0 : Wavy<float>(x, y, z, s); });
    EncodeOptions options;
    options.BrickCells = 16;
    Encode(this->Folder / "s.banyan", this->Domain, values, options);
    this->File = SeriesFile::Open(this->Folder / "s.banyan");
  }

  std::vector<std::int64_t> All() const
  {
    std::vector<std::int64_t> bricks(16);
    std::iota(bricks.begin(), bricks.end(), 0);
    return bricks;
  }

  void Draw(const SeriesBrickSource& source, int first, int last) const
  {
    for (int brick = first; brick < last; ++brick)
    {
      const_cast<SeriesBrickSource&>(source).Load(brick);
    }
  }

  /// All bricks are on the screen, and visible.
  RayScene Scene() const
  {
    return scenes::Scene(this->Domain.Samples(), { 64, 64 }, glm::dmat4(1.0), 2.0);
  }

  const Box Cells{ glm::ivec3(0), { 64, 32, 32 } };
  const TemporaryFolder Folder;
  const Grid Domain = GridOf(65, 33, 33);
  std::shared_ptr<SeriesFile> File;
};

TEST_F(Ahead, BricksAreDecodedOnceAndCountedWhenTheyAreAskedFor)
{
  for (const int threads : { 1, 3 })
  {
    BrickCache cache(Plenty);
    BackgroundDecoder decoder(cache, threads);
    cache.Get(*this->File, { 1, 0, 0, 0 }, 3);
    decoder.Start(this->File, { { { 1, 0, 0, 0 }, this->All() } }, Plenty);
    decoder.Finish();
    EXPECT_EQ(cache.GetAheadStatistics().Decoded, 14u) << "one was there, one has one value";
    EXPECT_EQ(cache.GetAheadStatistics().Hits, 0u);
    EXPECT_EQ(cache.GetStatistics().Misses, 15u);
    for (int round = 0; round < 2; ++round)
    {
      for (const std::int64_t brick : this->All())
      {
        std::vector<float> expected(
          static_cast<std::size_t>(this->File->Layout(0).SamplesOf(brick).Count()));
        this->File->DecodeBrick({ 1, 0, 0, 0 }, brick, expected.data());
        const auto values = cache.Get(*this->File, { 1, 0, 0, 0 }, brick);
        EXPECT_EQ(std::memcmp(values->Bytes.data(), expected.data(), values->Bytes.size()), 0);
      }
    }
    EXPECT_EQ(cache.GetStatistics().Misses, 15u);
    EXPECT_EQ(cache.GetAheadStatistics().Hits, 14u) << "each counts once";
  }
}

TEST_F(Ahead, KeepsToItsBytesAndToThoseOfTheCache)
{
  BrickCache cache(Plenty);
  BackgroundDecoder decoder(cache, 2);
  decoder.Start(this->File, { { { 1, 0, 0, 0 }, this->All() } }, 4 * BrickBytes);
  decoder.Finish();
  EXPECT_GE(cache.GetAheadStatistics().Decoded, 4u);
  EXPECT_LE(cache.GetAheadStatistics().Decoded, 5u) << "each thread may be at one brick";
  decoder.Start(this->File, { { { 2, 0, 0, 0 }, this->All() } }, 0);
  decoder.Finish();
  EXPECT_LE(cache.GetAheadStatistics().Decoded, 5u);

  BrickCache little(3 * BrickBytes);
  BackgroundDecoder other(little, 2);
  other.Start(this->File, { { { 1, 0, 0, 0 }, this->All() } }, Plenty);
  other.Finish();
  EXPECT_LE(little.GetStatistics().PeakBytes, 3 * BrickBytes);
}

TEST_F(Ahead, StopsAndBeginsAgainAtAnyTime)
{
  BrickCache cache(Plenty);
  BackgroundDecoder decoder(cache, 2);
  decoder.Stop();
  for (int i = 0; i < 200; ++i)
  {
    decoder.Start(this->File, { { { i % Steps, 0, 0, 0 }, this->All() } }, Plenty);
    if (i % 3 == 0)
    {
      decoder.Stop();
    }
    cache.Get(*this->File, { i % Steps, 0, 0, 0 }, i % 16);
  }
  decoder.Stop();
  decoder.Finish();
  const std::uint64_t decoded = cache.GetAheadStatistics().Decoded;
  cache.Clear();
  decoder.Finish();
  EXPECT_EQ(cache.GetAheadStatistics().Decoded, decoded);
}

TEST_F(Ahead, WhatCannotBeReadIsLeftToWhoeverAsks)
{
  BrickCache cache(Plenty);
  BackgroundDecoder decoder(cache, 2);
  decoder.Start(this->File,
    { { { Steps, 0, 0, 0 }, { 0 } }, { { 0, 7, 0, 0 }, { 0 } },
      { { 0, 0, 0, 0 }, { -1, 1, 1000 } } },
    Plenty);
  decoder.Finish();
  EXPECT_EQ(cache.GetAheadStatistics().Decoded, 1u);
  EXPECT_THROW(cache.Get(*this->File, { Steps, 0, 0, 0 }, 0), Error);
}

TEST_F(Ahead, FetchedBricksTakeTheRoomOfDecodedOnes)
{
  BrickCache cache(10 * BrickBytes);
  for (const std::int64_t brick : this->All())
  {
    cache.Get(*this->File, {}, brick);
  }
  EXPECT_GT(cache.GetStatistics().Bytes, 8 * BrickBytes);
  cache.Reserve(6 * static_cast<std::int64_t>(BrickBytes));
  EXPECT_LE(cache.GetStatistics().Bytes, 4 * BrickBytes);
  EXPECT_EQ(cache.Budget(), 10 * BrickBytes);
  cache.Reserve(6 * static_cast<std::int64_t>(BrickBytes));
  EXPECT_EQ(cache.GetStatistics().Bytes, 0u);
  cache.Reserve(-12 * static_cast<std::int64_t>(BrickBytes));
  cache.Get(*this->File, {}, 0);
  EXPECT_GT(cache.GetStatistics().Bytes, 0u);
}

TEST_F(Ahead, TheStepThatComesNextInTheDirectionOfPlayIsRead)
{
  BrickCache cache(Plenty);
  TimeStepPrefetcher ahead(cache, 2);
  const auto play = [&](int step)
  {
    const SeriesBrickSource source(this->File, { step, 0, 0, 0 }, 0, cache);
    ahead.Drawing(*this->File, step);
    this->Draw(source, 2, 9);
    ahead.Drawn(this->File, this->Scene(), this->Cells, source);
    ahead.Work().Finish();
    return ahead.Next();
  };
  EXPECT_EQ(play(0), -1) << "it does not play yet";
  EXPECT_EQ(play(1), 2);
  EXPECT_EQ(cache.GetAheadStatistics().Decoded, 7u * TimeStepPrefetcher::StepsAhead);
  EXPECT_EQ(cache.GetAheadStatistics().Hits, 0u);
  EXPECT_EQ(play(2), 3);
  EXPECT_EQ(cache.GetAheadStatistics().Hits, 7u) << "nothing of it was decoded when it was drawn";
  EXPECT_EQ(play(2), 3) << "the camera moves";
  EXPECT_EQ(play(1), 0) << "backwards";
  EXPECT_EQ(play(0), 5) << "and round";
  EXPECT_EQ(play(5), 4) << "as before";
  EXPECT_EQ(play(3), 1) << "every other step";
  const auto other = SeriesFile::Open(this->Folder / "s.banyan");
  ahead.Drawing(*other, 4);
  EXPECT_EQ(ahead.Next(), -1);
}

TEST_F(Ahead, ALoopGoesOnAfterItsLastStep)
{
  PlayDirection direction;
  EXPECT_EQ(direction.After(3), -1);
  direction.Asked(*this->File, 4);
  EXPECT_EQ(direction.Asked(*this->File, 5), 0);
  EXPECT_EQ(direction.Asked(*this->File, 0), 1) << "that was no turn";
  EXPECT_EQ(direction.Asked(*this->File, 4), 0) << "this was a leap";
  EXPECT_EQ(direction.Asked(*this->File, 3), 2);
}

TEST_F(Ahead, BricksThatComeIntoSightAreExpected)
{
  const auto values = Sample<float>(this->Domain, 3,
    [](int x, int, int, int s)
    {
      return s == 2 || x < 20 ? 1.0f + 0.01f * static_cast<float>(x)
                              : 0.001f * static_cast<float>(x);
    });
  EncodeOptions options;
  options.BrickCells = 16;
  Encode(this->Folder / "comes.banyan", this->Domain, values, options);
  const auto file = SeriesFile::Open(this->Folder / "comes.banyan");
  BrickCache cache(Plenty);
  TimeStepPrefetcher ahead(cache, 2);
  RayScene scene = this->Scene();
  scene.Transfer.Low = 0.5;
  scene.Transfer.Entries.front().a = 0.0f;
  for (const int step : { 0, 1 })
  {
    SeriesBrickSource source(file, { step, 0, 0, 0 }, 0, cache);
    ahead.Drawing(*file, step);
    source.Load(0);
    ahead.Drawn(file, scene, this->Cells, source);
    ahead.Work().Finish();
  }
  const SeriesBrickSource next(file, { 2, 0, 0, 0 }, 0, cache);
  const std::uint64_t hits = cache.GetAheadStatistics().Hits;
  for (const std::int64_t brick : { 0, 3, 15 })
  {
    const_cast<SeriesBrickSource&>(next).Load(brick);
  }
  EXPECT_EQ(cache.GetAheadStatistics().Hits, hits + 3);
}

TEST_F(Ahead, AnEnhancedStepNeedsOneThatIsAfterTheNext)
{
  BrickCache cache(Plenty);
  TimeStepPrefetcher ahead(cache, 2);
  const auto play = [&](int step)
  {
    const auto at = [&](int other) -> std::unique_ptr<BrickSource>
    {
      return other < 0 || other >= Steps ? nullptr
                                         : std::make_unique<SeriesBrickSource>(
                                             this->File, FieldKey{ other, 0, 0, 0 }, 0, cache);
    };
    EnhancedBrickSource source({ 0.5, 1.0, 0.0 }, at(step - 1), at(step), at(step + 1));
    ahead.Drawing(*this->File, step);
    for (int brick = 2; brick < 9; ++brick)
    {
      source.Load(brick);
    }
    ahead.Drawn(this->File, this->Scene(), this->Cells, source);
    ahead.Work().Finish();
  };
  play(1); // steps 0 to 2
  EXPECT_EQ(cache.GetAheadStatistics().Decoded, 0u);
  play(2); // 3 too, then 4 and 5
  EXPECT_EQ(cache.GetAheadStatistics().Decoded, 14u);
  play(3);
  EXPECT_EQ(cache.GetAheadStatistics().Hits, 7u);
  EXPECT_EQ(cache.GetAheadStatistics().Decoded, 14u) << "there is no step after the last";
  play(4);
  EXPECT_EQ(cache.GetAheadStatistics().Hits, 14u);
  EXPECT_EQ(cache.GetAheadStatistics().Decoded, 14u);
  EXPECT_EQ(cache.GetStatistics().Misses, 6 * 7u);
}

TEST_F(Ahead, SourcesKnowWhatWasLoadedOfTheirLevels)
{
  BrickCache cache(Plenty);
  SeriesBrickSource source(this->File, { 2, 0, 0, 0 }, 0, cache);
  EXPECT_TRUE(source.Loaded().empty());
  source.Load(5);
  source.Load(1);
  source.Load(5);
  BrickSource* const coarse = source.AtLevel(1, Box{ glm::ivec3(0), { 64, 32, 32 } });
  ASSERT_TRUE(coarse);
  coarse->Load(0);
  const std::vector<FieldBricks> loaded = source.Loaded();
  ASSERT_EQ(loaded.size(), 2u);
  EXPECT_EQ(loaded[0].Bricks, (std::vector<std::int64_t>{ 5, 1 }));
  EXPECT_EQ(loaded[0].Field.Level, 0);
  EXPECT_EQ(loaded[0].Field.Step, 2);
  EXPECT_EQ(loaded[1].Bricks, std::vector<std::int64_t>{ 0 });
  EXPECT_EQ(loaded[1].Field.Level, 1);
}

} // namespace
} // namespace banyan::testing
