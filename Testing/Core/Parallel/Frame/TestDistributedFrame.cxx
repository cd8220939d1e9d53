// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/Zones.h"
#include "Parallel/Frame/DistributedFrame.h"
#include "Render/Bricks/ArrayBrickSource.h"
#include "Render/Bricks/SeriesBrickSource.h"
#include "Render/Sampling/ImageError.h"
#include "Render/Scenes.h"
#include "Series/SeriesTesting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>

namespace
{

using namespace banyan;

constexpr std::uint64_t Budget = 1u << 20;
const glm::ivec3 Samples{ 41, 33, 37 };

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
    SeriesEncoder encoder(this->Folder / "field.banyan", banyan::testing::GridOf(41, 33, 37),
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

struct Outcome
{
  FloatImage Picture;
  FrameStatistics Statistics;
};

/// Draws the series on a number of simulated ranks; rank 0's picture and statistics.
Outcome DrawSeries(const EncodedField& field, const RayScene& scene, int ranks,
  const CompositeOptions& compositing = {})
{
  Outcome outcome;
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      const BrickLayout layout = field.Series->Layout(0);
      std::vector<Box> zones;
      for (const Box& bricks : StaticZones(layout.Bricks(), communicator.Size()))
      {
        zones.push_back(CellsOfBricks(bricks, layout.BrickCells(), scene.DomainCells.Hi));
      }
      BrickCache cache(Budget);
      SeriesBrickSource source(field.Series, {}, 0, cache);
      ThreadPool pool(1);
      FrameStatistics statistics;
      const FloatImage picture = DrawDistributed(
        communicator, scene, { &source, zones, Budget, pool }, statistics, compositing);
      if (communicator.Rank() == 0)
      {
        outcome = { picture, statistics };
      }
      else
      {
        EXPECT_TRUE(picture.Pixels.empty());
      }
    });
  return outcome;
}

RayScene SceneOf(double distance, bool parallel)
{
  RayScene scene = scenes::Scene(Samples, { 61, 47 }, glm::dmat4(1.0), distance, parallel);
  scene.Transfer = scenes::Tabulate(scenes::Sparse);
  return scene;
}

class EveryRankCount : public ::testing::TestWithParam<int>
{
};

TEST_P(EveryRankCount, DrawsThePictureOfOneRank)
{
  const EncodedField field;
  for (const bool parallel : { false, true })
  {
    // The camera outside and inside of the volume.
    for (const double distance : { 1.4, 0.1 })
    {
      const RayScene scene = SceneOf(distance, parallel);
      const Outcome alone = DrawSeries(field, scene, 1);
      ASSERT_GT(alone.Picture.At(30, 23).a, 0.05f);
      const Outcome together = DrawSeries(field, scene, GetParam());
      EXPECT_LT(MaxDifference(alone.Picture, together.Picture), 1e-5);
      EXPECT_EQ(alone.Statistics.SamplesTaken, together.Statistics.SamplesTaken);
      EXPECT_EQ(alone.Statistics.BricksDrawn, together.Statistics.BricksDrawn);
    }
  }
}

/// Real pictures of zones, whose footprints are hulls, in few bits.
TEST_P(EveryRankCount, DrawsThePictureOfOneRankInFewBits)
{
  const EncodedField field;
  for (const double distance : { 1.4, 0.1 })
  {
    const RayScene scene = SceneOf(distance, false);
    const Outcome alone = DrawSeries(field, scene, 1);
    CompositeOptions options;
    options.Transport = PixelTransport::WithinOne;
    const Outcome together = DrawSeries(field, scene, GetParam(), options);
    // Rounded numbers of 8 bits differ by at most 1 where these differ by less than that.
    EXPECT_LT(MaxDifference(alone.Picture, together.Picture), 1.5 / 255.0);
    // With the eye in the root's zone, two ranks may have nothing to send.
    EXPECT_TRUE(together.Statistics.MessagesComposited > 0 || distance < 1.0);
  }
}

/// Draws the series for places on ranks, and puts these together.
/// @param byPicture whether each rank draws a column of the picture, all cells
Outcome DrawPlaces(const EncodedField& field, const RayScene& scene, int ranks, bool byPicture,
  const std::vector<PicturePlace>& places, const CompositeOptions& options = {})
{
  Outcome whole;
  whole.Picture.Rect = scene.Viewport;
  whole.Picture.Pixels.assign(static_cast<std::size_t>(scene.Viewport.Count()), glm::vec4(-1.0f));
  std::mutex mutex;
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      const BrickLayout layout = field.Series->Layout(0);
      BrickCache cache(Budget);
      SeriesBrickSource source(field.Series, {}, 0, cache);
      ThreadPool pool(1);
      RankShare share{ &source, {}, Budget, pool };
      const glm::ivec2 size = scene.Camera.ImageSize();
      for (int rank = 0; rank < ranks; ++rank)
      {
        const Box bricks = StaticZones(layout.Bricks(), ranks)[static_cast<std::size_t>(rank)];
        share.Zones.push_back(CellsOfBricks(bricks, layout.BrickCells(), scene.DomainCells.Hi));
        if (byPicture)
        {
          share.Regions.push_back(
            { { size.x * rank / ranks, 0 }, { size.x * (rank + 1) / ranks, size.y } });
        }
      }
      FrameStatistics statistics;
      const FloatImage mine =
        DrawDistributed(communicator, scene, share, statistics, options, places);
      const std::lock_guard<std::mutex> lock(mutex);
      whole.Statistics = statistics;
      for (int y = mine.Rect.Lo.y; y < mine.Rect.Hi.y && !mine.Pixels.empty(); ++y)
      {
        for (int x = mine.Rect.Lo.x; x < mine.Rect.Hi.x; ++x)
        {
          EXPECT_EQ(whole.Picture.At(x, y).a, -1.0f) << "two ranks have this pixel";
          whole.Picture.At(x, y) = mine.At(x, y);
        }
      }
    });
  return whole;
}

/// Up to five parts of the picture, of unequal sizes, which meet where no tile ends: the last rank
/// has the first one. One more is empty, if there is a rank for it.
std::vector<PicturePlace> PlacesOn(const RayScene& scene, int ranks)
{
  const glm::ivec2 size = scene.Camera.ImageSize();
  const std::vector<int> ends{ 9, 29, 31, 42, size.x };
  const int parts = std::min(ranks, static_cast<int>(ends.size()));
  std::vector<PicturePlace> places;
  int begin = 0;
  for (int part = 0; part < parts; ++part)
  {
    const int end = part + 1 < parts ? ends[static_cast<std::size_t>(part)] : size.x;
    places.push_back({ { { begin, 0 }, { end, size.y } }, part == 0 ? ranks - 1 : part - 1, {} });
    begin = end;
  }
  if (parts < ranks)
  {
    places.push_back({ { size, size + 10 }, parts - 1, {} });
  }
  return places;
}

TEST_P(EveryRankCount, PixelsEndOnTheRankThatShowsThem)
{
  const EncodedField field;
  for (const double distance : { 1.4, 0.1 })
  {
    RayScene scene = SceneOf(distance, false);
    for (const int stride : { 1, 8 })
    {
      scene.Samplings = std::make_shared<TileSamplings>(
        scene.Camera.ImageSize(), std::vector<RaySampling>{ { 0, scene.SampleDistance, stride } });
      const Outcome alone = DrawSeries(field, scene, 1);
      const std::vector<PicturePlace> places = PlacesOn(scene, GetParam());
      const Outcome zones = DrawPlaces(field, scene, GetParam(), false, places);
      EXPECT_LT(MaxDifference(alone.Picture, zones.Picture), 1e-5);
      const Outcome regions = DrawPlaces(field, scene, GetParam(), true, places);
      EXPECT_EQ(MaxDifference(alone.Picture, regions.Picture), 0.0);
    }
  }
}

/// Where pixels of all places take too much memory, some places are composited before others are
/// cast.
TEST_P(EveryRankCount, PlacesMayBeCompositedOneAfterTheOther)
{
  const EncodedField field;
  const RayScene scene = SceneOf(1.4, false);
  const std::vector<PicturePlace> places = PlacesOn(scene, GetParam());
  CompositeOptions options;
  const Outcome together = DrawPlaces(field, scene, GetParam(), false, places, options);
  options.MostBytes = 1;
  const Outcome inTurn = DrawPlaces(field, scene, GetParam(), false, places, options);
  EXPECT_EQ(MaxDifference(together.Picture, inTurn.Picture), 0.0);
  EXPECT_EQ(together.Statistics.SamplesTaken, inTurn.Statistics.SamplesTaken);
}

class Counting : public ArrayBrickSource
{
public:
  using ArrayBrickSource::ArrayBrickSource;
  BrickView Load(std::int64_t brick) override
  {
    ++this->Loads;
    return ArrayBrickSource::Load(brick);
  }
  int Loads = 0;
};

/// Places are parts of one picture: bricks that one of them needs stay while others are drawn.
TEST(DistributedFrame, BricksArePackedOnceForAllPlaces)
{
  constexpr int ranks = 5;
  const std::vector<float> values = scenes::Sampled<float>(scenes::Standard, Samples);
  const RayScene scene = SceneOf(1.4, false);
  const glm::ivec2 size = scene.Camera.ImageSize();
  std::vector<PicturePlace> places;
  for (int rank = 0; rank < ranks; ++rank)
  {
    places.push_back(
      { { { size.x * rank / ranks, 0 }, { size.x * (rank + 1) / ranks, size.y } }, rank, {} });
  }
  std::mutex mutex;
  int atFirst = 0;
  int again = 0;
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      ThreadPool pool(1);
      Counting source(scenes::ArrayOf(values, Samples), 8, { 0, 1 }, pool);
      RankShare share{ &source, {}, 1u << 30, pool };
      // Rows, so that each rank draws for all places; the last one has none of its own.
      for (int rank = 0; rank < ranks; ++rank)
      {
        share.Regions.push_back({ { 0, std::min(size.y, size.y * rank / (ranks - 1)) },
          { size.x, std::min(size.y, size.y * (rank + 1) / (ranks - 1)) } });
      }
      FrameStatistics statistics;
      DrawDistributed(communicator, scene, share, statistics, {}, places);
      const int first = source.Loads;
      for (int frame = 0; frame < 3; ++frame)
      {
        DrawDistributed(communicator, scene, share, statistics, {}, places);
      }
      const std::lock_guard<std::mutex> lock(mutex);
      atFirst += first;
      again += source.Loads - first;
    });
  EXPECT_GT(atFirst, 100);
  EXPECT_EQ(again, 0);
}

TEST_P(EveryRankCount, RegionsTakeTheSamplesOfOneRankAndHaveItsBits)
{
  const EncodedField field;
  RayScene scene = SceneOf(1.4, false);
  scene.Transfer.UnitDistance = 0.05; // rays end early
  scene.Depth.assign(static_cast<std::size_t>(scene.Viewport.Count()), 1.0f);
  std::fill_n(scene.Depth.begin() + 61 * 20, 61 * 4, 0.5f);
  const Outcome alone = DrawSeries(field, scene, 1);
  const Outcome regions = DrawPlaces(field, scene, GetParam(), true, {});
  EXPECT_EQ(MaxDifference(alone.Picture, regions.Picture), 0.0);
  EXPECT_EQ(regions.Statistics.SamplesTaken, alone.Statistics.SamplesTaken);
}

TEST_P(EveryRankCount, RaysThatEndEarlyChangeLessThanAHalfOf255)
{
  const EncodedField field;
  RayScene scene = SceneOf(1.4, false);
  scene.OpacityLimit = 0.999f;
  scene.Transfer.UnitDistance = 0.05; // nearly opaque
  const Outcome alone = DrawSeries(field, scene, 1);
  const Outcome together = DrawSeries(field, scene, GetParam());
  EXPECT_LT(MaxDifference(alone.Picture, together.Picture), 0.5 / 255.0);
}

TEST_P(EveryRankCount, DrawsExtremesToTheBitAndAveragesAndLabelsAndCutsAsOneRank)
{
  const EncodedField field;
  RayScene scene = SceneOf(1.4, false);
  const auto expectSame = [&](double tolerance, bool sameWork)
  {
    const Outcome alone = DrawSeries(field, scene, 1);
    const auto drawn = std::count_if(alone.Picture.Pixels.begin(), alone.Picture.Pixels.end(),
      [](const glm::vec4& pixel) { return pixel.a > 0.05f; });
    ASSERT_GT(drawn, 100);
    const Outcome together = DrawSeries(field, scene, GetParam());
    EXPECT_LE(MaxDifference(alone.Picture, together.Picture), tolerance);
    if (sameWork)
    {
      EXPECT_EQ(alone.Statistics.SamplesTaken, together.Statistics.SamplesTaken);
      EXPECT_EQ(alone.Statistics.BricksDrawn, together.Statistics.BricksDrawn);
    }
  };
  for (glm::vec4& entry : scene.Transfer.Entries)
  {
    entry.a = 0.1f + 0.5f * entry.a;
  }
  const glm::dvec3 normal(0.6, -0.2, 0.8);
  scene.ClipPlanes = { { normal, -glm::dot(normal, glm::dvec3(Samples) * 0.5) } };
  expectSame(1e-5, true);
  scene.Interpolation = SampleInterpolation::Nearest;
  expectSame(1e-5, true);
  scene.Interpolation = SampleInterpolation::Linear;
  scene.Blend.Mode = BlendMode::Average;
  expectSame(1e-5, true);
  scene.Blend.Mode = BlendMode::Maximum;
  expectSame(0.0, false);
  scene.Blend.Mode = BlendMode::Minimum;
  expectSame(0.0, false);
}

// 125 bricks: the last count leaves ranks without any.
INSTANTIATE_TEST_SUITE_P(Ranks, EveryRankCount, ::testing::Values(2, 3, 4, 5, 7, 16, 131));

TEST(DistributedFrame, EncodedAndPlainFieldGiveTheSamePicture)
{
  const EncodedField field;
  const RayScene scene = SceneOf(1.4, false);
  const FloatImage plain =
    scenes::Draw(scene, scenes::ArrayOf(field.Values, Samples), { 16, 1, Budget }).Image;
  const Outcome encoded = DrawSeries(field, scene, 3);
  for (int y = plain.Rect.Lo.y; y < plain.Rect.Hi.y; ++y)
  {
    for (int x = plain.Rect.Lo.x; x < plain.Rect.Hi.x; ++x)
    {
      for (int c = 0; c < 4; ++c)
      {
        ASSERT_NEAR(plain.At(x, y)[c], encoded.Picture.At(x, y)[c], 1e-5);
      }
    }
  }
}

/// @param places of the picture; none: all of it on rank 0
void ExpectFailureOfAll(const std::vector<PicturePlace>& places)
{
  const EncodedField field;
  const RayScene scene = SceneOf(1.4, false);
  std::mutex mutex;
  std::vector<std::string> sentences;
  RunOnSimulatedRanks(4,
    [&](Communicator& communicator)
    {
      BrickCache cache(Budget);
      SeriesBrickSource source(field.Series, {}, 0, cache);
      ThreadPool pool(1);
      FrameStatistics statistics;
      const std::vector<Box> zones(4, Box{});
      try
      {
        DrawDistributed(communicator, scene,
          { &source, zones, Budget, pool, nullptr,
            communicator.Rank() == 2 ? "The disk of this rank is gone." : "" },
          statistics, {}, places);
      }
      catch (const Error& error)
      {
        std::lock_guard<std::mutex> lock(mutex);
        sentences.emplace_back(error.what());
      }
    });
  ASSERT_EQ(sentences.size(), 4u);
  for (const std::string& sentence : sentences)
  {
    EXPECT_NE(sentence.find("The disk of this rank is gone."), std::string::npos);
    EXPECT_NE(sentence.find("2"), std::string::npos) << sentence;
  }
}

TEST(DistributedFrame, AFailureOnOneRankIsThrownOnAll)
{
  ExpectFailureOfAll({});
  ExpectFailureOfAll(PlacesOn(SceneOf(1.4, false), 4));
}

TEST(DistributedFrame, OnlyBricksThatCanBeSeenAreDecoded)
{
  const EncodedField field;
  RayScene scene = SceneOf(1.4, false);
  for (std::size_t i = 0; i < scene.Transfer.Entries.size(); ++i)
  {
    scene.Transfer.Entries[i].a = i + 400 < scene.Transfer.Entries.size() ? 0.0f : 0.3f;
  }
  const std::uint64_t before = field.Series->BricksDecoded();
  const Outcome outcome = DrawSeries(field, scene, 3);
  EXPECT_GT(outcome.Statistics.BricksDrawn, 0);
  EXPECT_GT(outcome.Statistics.BricksSkipped, outcome.Statistics.BricksDrawn);
  EXPECT_EQ(field.Series->BricksDecoded() - before,
    static_cast<std::uint64_t>(outcome.Statistics.BricksDrawn));
}

TEST(DistributedFrame, NothingVisibleGivesATransparentPicture)
{
  const EncodedField field;
  RayScene scene = SceneOf(1.4, false);
  for (glm::vec4& entry : scene.Transfer.Entries)
  {
    entry.a = 0.0f;
  }
  const Outcome outcome = DrawSeries(field, scene, 2);
  ASSERT_EQ(outcome.Picture.Pixels.size(), 61u * 47u);
  for (const glm::vec4& pixel : outcome.Picture.Pixels)
  {
    EXPECT_EQ(pixel, glm::vec4(0.0f));
  }
  EXPECT_EQ(outcome.Statistics.BricksDrawn, 0);
}

} // namespace
