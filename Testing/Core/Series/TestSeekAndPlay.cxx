// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesTesting.h"

#include "Series/Decode/CacheContext.h"

#include <algorithm>
#include <fstream>
#include <map>

namespace banyan::testing
{
namespace
{

/// Some change of everything: smooth waves, a part that rests, a part that is empty, exceptions.
Steps<float> MovingSteps(const Grid& grid, int count)
{
  auto steps = Sample<float>(grid, count,
    [](int x, int y, int z, int s) {
      return x < 8 ? 2.0 : z < 9 ? Wavy<float>(x, y, z, s / 5) : Wavy<float>(x + s, y, z, 2 * s);
    });
  for (std::size_t s = 0; s < steps.size(); s += 3)
  {
    steps[s][(97 * s + 13) % steps[s].size()] = s % 2 == 0 ? NAN : 1e20f;
  }
  return steps;
}

ValueRange RangeWithoutFill(const Steps<float>& steps)
{
  ValueRange range;
  for (const auto& step : steps)
  {
    for (const float value : step)
    {
      if (std::isfinite(value) && value < 1e10f)
      {
        range.Include(value);
      }
    }
  }
  return range;
}

SeriesIndex EncodeMoving(const std::string& path, const Grid& grid, const Steps<float>& steps,
  const EncodeOptions& options, int threads)
{
  ThreadPool pool(threads);
  ArrayDescription description = Describe(steps);
  description.SeriesRanges = { RangeWithoutFill(steps) };
  SeriesEncoder encoder(path, grid, { description }, options, pool);
  for (std::size_t s = 0; s < steps.size(); ++s)
  {
    encoder.AddStep(static_cast<double>(s), { { steps[s].data() } });
  }
  return encoder.Finish();
}

struct Place
{
  FieldKey Field;
  std::int64_t Brick;
};

std::vector<Place> AllPlaces(const SeriesFile& file)
{
  std::vector<Place> places;
  for (int step = 0; step < file.Index().Steps(); ++step)
  {
    for (int level = 0; level < file.Index().Levels; ++level)
    {
      for (std::int64_t brick = 0; brick < file.Layout(level).BrickCount(); ++brick)
      {
        places.push_back({ { step, 0, 0, level }, brick });
      }
    }
  }
  return places;
}

std::vector<float> Decode(const SeriesFile& file, const Place& place)
{
  std::vector<float> values(
    static_cast<std::size_t>(file.Layout(place.Field.Level).SamplesOf(place.Brick).Count()));
  file.DecodeBrick(place.Field, place.Brick, values.data());
  return values;
}

bool SameValues(const std::vector<float>& a, const std::vector<float>& b)
{
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

class SeekAndPlay : public ::testing::TestWithParam<int>
{
};

TEST_P(SeekAndPlay, GiveTheSameBits)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const Grid grid = GridOf(37, 33, 35);
  const auto steps = MovingSteps(grid, 11);
  EncodeOptions options;
  options.KeyframeInterval = GetParam();
  options.BrickCells = 16;
  const SeriesIndex index = EncodeMoving(path, grid, steps, options, 2);
  std::vector<std::vector<float>> played;
  {
    const auto file =
      SeriesFile::Open(path, std::make_shared<CacheContext>(std::uint64_t{ 1 } << 30));
    for (const Place& place : AllPlaces(*file))
    {
      played.push_back(Decode(*file, place));
    }
    for (int s = 0; s < index.Steps(); ++s)
    {
      EXPECT_TRUE(WithinBound(steps[static_cast<std::size_t>(s)],
        ReadAll<float>(*file, { s, 0, 0, 0 }), index.Arrays[0].Components[0].ErrorBoundAbsolute));
    }
  }
  for (const std::uint64_t budget : { std::uint64_t{ 0 }, std::uint64_t{ 400000 } })
  {
    const auto file = SeriesFile::Open(path, std::make_shared<CacheContext>(budget));
    const std::vector<Place> places = AllPlaces(*file);
    std::vector<std::size_t> order(places.size());
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      order[i] = i;
    }
    std::shuffle(order.begin(), order.end(), std::mt19937(3));
    order.resize(budget == 0 ? order.size() / 4 : order.size()); // without a cache it takes long
    for (const std::size_t i : order)
    {
      ASSERT_TRUE(SameValues(Decode(*file, places[i]), played[i]))
        << "step " << places[i].Field.Step << ", level " << places[i].Field.Level << ", brick "
        << places[i].Brick << ", budget " << budget;
    }
  }
}

/// What a cache of bricks hands out is what the file decodes to, however small it is.
TEST_P(SeekAndPlay, BrickCachesChangeNothing)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const Grid grid = GridOf(34, 33, 17);
  EncodeOptions options;
  options.KeyframeInterval = GetParam();
  options.BrickCells = 16;
  EncodeMoving(path, grid, MovingSteps(grid, 9), options, 2);
  const auto file = SeriesFile::Open(path);
  std::vector<Place> places = AllPlaces(*file);
  std::shuffle(places.begin(), places.end(), std::mt19937(4));
  BrickCache small(20000);
  for (const Place& place : places)
  {
    const auto brick = small.Get(*file, place.Field, place.Brick);
    const std::vector<float> direct = Decode(*file, place);
    ASSERT_EQ(brick->Bytes.size(), direct.size() * sizeof(float));
    ASSERT_EQ(std::memcmp(brick->Bytes.data(), direct.data(), brick->Bytes.size()), 0);
  }
}

std::map<std::string, std::string> FilesOf(const std::string& path)
{
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(path + ".d"))
  {
    std::ifstream stream(entry.path(), std::ios::binary);
    files[entry.path().filename().string().substr(16)] =
      std::string(std::istreambuf_iterator<char>(stream), {});
  }
  return files;
}

TEST_P(SeekAndPlay, AnyNumberOfThreadsWritesTheSameBytes)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(35, 17, 9);
  const auto steps = MovingSteps(grid, 9);
  EncodeOptions options;
  options.KeyframeInterval = GetParam();
  EncodeMoving(folder / "one.banyan", grid, steps, options, 1);
  EncodeMoving(folder / "many.banyan", grid, steps, options, 7);
  const auto bytes = [](const SeriesIndex& index)
  {
    std::vector<std::uint64_t> hashes;
    for (const SegmentIndex& segment : index.Segments)
    {
      hashes.insert(hashes.end(), { segment.HashLow, segment.HashHigh, segment.Bytes });
    }
    return hashes;
  };
  EXPECT_EQ(bytes(SeriesFile::Open(folder / "one.banyan")->Index()),
    bytes(SeriesFile::Open(folder / "many.banyan")->Index()));
  std::vector<std::string> one, many;
  for (const auto& [name, content] : FilesOf(folder / "one.banyan"))
  {
    one.push_back(content);
  }
  for (const auto& [name, content] : FilesOf(folder / "many.banyan"))
  {
    many.push_back(content);
  }
  std::sort(one.begin(), one.end());
  std::sort(many.begin(), many.end());
  EXPECT_EQ(one, many);
}

/// Any brick of any step is read from its own segment and the one before: the others may be ruined.
TEST_P(SeekAndPlay, TwoSegmentsAreEnough)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const Grid grid = GridOf(34, 17, 33);
  EncodeOptions options;
  options.KeyframeInterval = GetParam();
  options.BrickCells = 16;
  const SeriesIndex index = EncodeMoving(path, grid, MovingSteps(grid, 17), options, 2);
  std::vector<std::vector<float>> expected;
  {
    const auto file = SeriesFile::Open(path);
    for (const Place& place : AllPlaces(*file))
    {
      expected.push_back(Decode(*file, place));
    }
  }
  const std::size_t kept = index.Segments.size() / 2;
  for (std::size_t i = 0; i < index.Segments.size(); ++i)
  {
    const std::string name = path + ".d/" + index.Segments[i].File;
    if (i != kept && i + 1 != kept)
    {
      std::ofstream(name, std::ios::binary) << std::string(index.Segments[i].Bytes, '\xa5');
    }
  }
  const auto file = SeriesFile::Open(path);
  const std::vector<Place> places = AllPlaces(*file);
  const SegmentIndex& segment = index.Segments[kept];
  int decoded = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const int step = places[i].Field.Step;
    const bool before = kept > 0 && step == segment.FirstStep - 1; // its key frame
    if (before || (step >= segment.FirstStep && step < segment.FirstStep + segment.Steps))
    {
      ASSERT_TRUE(SameValues(Decode(*file, places[i]), expected[i]));
      (void)file->Nodes(places[i].Field);
      ++decoded;
    }
    else if (i % 10 == 0 && &index.SegmentOf(step) != &index.Segments[kept - 1])
    {
      EXPECT_ANY_THROW(Decode(*file, places[i]));
    }
  }
  EXPECT_GT(decoded, 0);
}

/// Every length of a series: groups that are cut short have their key frame earlier.
TEST_P(SeekAndPlay, OfAnyLengthStayInBound)
{
  const Grid grid = GridOf(19, 17, 18);
  const auto steps = MovingSteps(grid, 17);
  EncodeOptions options;
  options.KeyframeInterval = GetParam();
  options.BrickCells = 16;
  for (std::size_t count = 1; count <= steps.size(); ++count)
  {
    const TemporaryFolder folder;
    const Steps<float> some(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(count));
    const SeriesIndex index = EncodeMoving(folder / "s.banyan", grid, some, options, 1);
    const auto file = SeriesFile::Open(folder / "s.banyan");
    ASSERT_EQ(file->Index().Steps(), static_cast<int>(count));
    for (std::size_t s = count; s-- > 0;) // backwards: nothing that was played is there
    {
      file->Caches()->Blocks().Forget(file->Id());
      ASSERT_TRUE(WithinBound(some[s], ReadAll<float>(*file, { static_cast<int>(s), 0, 0, 0 }),
        index.Arrays[0].Components[0].ErrorBoundAbsolute))
        << "step " << s << " of " << count;
    }
  }
}

TEST_P(SeekAndPlay, ChainsAreCountedAndShort)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(17, 17, 17);
  EncodeOptions options;
  options.KeyframeInterval = GetParam();
  const int count = 16;
  const SeriesIndex index =
    EncodeMoving(folder / "s.banyan", grid, MovingSteps(grid, count), options, 2);
  const EncodeStatistics& statistics = index.Statistics;
  EXPECT_EQ(statistics.ChainBricks, count); // 17 samples are one brick
  EXPECT_GE(statistics.ChainSum, statistics.ChainBricks);
  int log = 0;
  while (1 << log < GetParam())
  {
    ++log;
  }
  // Both references of a step, theirs, and so on: one new one per halving, and two key frames.
  EXPECT_LE(statistics.ChainMost, std::max(1, GetParam() == 1 << log ? log + 2 : 2 * log + 1));
  EXPECT_GE(statistics.ChainMost, 1);
  if (GetParam() == 1)
  {
    EXPECT_EQ(statistics.ChainSum, statistics.ChainBricks);
  }
  else
  {
    EXPECT_GT(statistics.ChainSum, statistics.ChainBricks) << "nothing was predicted in time";
  }
  const auto file = SeriesFile::Open(folder / "s.banyan");
  EXPECT_EQ(file->Index().Statistics.ChainSum, statistics.ChainSum);
  EXPECT_EQ(file->Index().Statistics.ChainMost, statistics.ChainMost);
}

/// Fields that are each other's mirror image look the same to the codec, which orders axes by
/// smoothness; a cache that knows bricks by their identities must not mix them up.
TEST(Identities, TurnedFieldsAreNotTheSame)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const Grid grid = GridOf(17, 17, 17);
  const auto alongX =
    Sample<float>(grid, 1, [](int x, int, int, int) { return std::sin(0.4 * x); });
  const auto alongZ =
    Sample<float>(grid, 1, [](int, int, int z, int) { return std::sin(0.4 * z); });
  ThreadPool pool(1);
  SeriesEncoder encoder(
    path, grid, { Describe(alongX, "x"), Describe(alongZ, "z") }, EncodeOptions(), pool);
  encoder.AddStep(0, { { alongX[0].data() }, { alongZ[0].data() } });
  const SeriesIndex index = encoder.Finish();
  const auto file = SeriesFile::Open(path);
  BrickCache cache(std::uint64_t{ 1 } << 20);
  const Box whole = { glm::ivec3(0), file->Layout(0).Samples() };
  std::vector<float> values(static_cast<std::size_t>(whole.Count()));
  for (int array = 0; array < 2; ++array)
  {
    ReadRegion(cache, *file, { 0, array, 0, 0 }, whole, values.data(), 1, 0);
    EXPECT_TRUE(WithinBound(array == 0 ? alongX[0] : alongZ[0], values,
      index.Arrays[static_cast<std::size_t>(array)].Components[0].ErrorBoundAbsolute));
  }
  EXPECT_FALSE(
    (*file->Nodes({ 0, 0, 0, 0 }))[0].Identity == (*file->Nodes({ 0, 1, 0, 0 }))[0].Identity);
}

INSTANTIATE_TEST_SUITE_P(Intervals, SeekAndPlay, ::testing::Values(1, 2, 3, 5, 8, 16));

} // namespace
} // namespace banyan::testing
