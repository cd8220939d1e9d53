// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesTesting.h"

#include "Series/Decode/CacheContext.h"

#include <atomic>
#include <thread>

namespace banyan::testing
{
namespace
{

/// 16 threads that share one open file, its caches and its tables; run it under the thread
/// sanitizer (preset tsan).
TEST(ConcurrentReading, SixteenThreadsReadWhatOneReads)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const Grid grid = GridOf(33, 33, 20);
  auto steps = Sample<float>(grid, 6, Wavy<float>);
  steps[2][100] = NAN;
  EncodeOptions options;
  options.KeyframeInterval = 3;
  options.BrickCells = 16;
  Encode(path, grid, steps, options);
  std::vector<std::vector<float>> expected;
  std::vector<std::pair<FieldKey, std::int64_t>> places;
  {
    const auto file = SeriesFile::Open(path);
    for (int step = 0; step < 6; ++step)
    {
      for (int level = 0; level < file->Index().Levels; ++level)
      {
        for (std::int64_t brick = 0; brick < file->Layout(level).BrickCount(); ++brick)
        {
          const FieldKey field{ step, 0, 0, level };
          places.push_back({ field, brick });
          expected.emplace_back(
            static_cast<std::size_t>(file->Layout(level).SamplesOf(brick).Count()));
          file->DecodeBrick(field, brick, expected.back().data());
        }
      }
    }
  }
  const auto caches = std::make_shared<CacheContext>(800000); // boxes come and go
  const auto file = SeriesFile::Open(path, caches);
  std::atomic<int> wrong{ 0 };
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < 16; ++t)
  {
    threads.emplace_back(
      [&, t]
      {
        std::vector<float> values;
        for (std::size_t i = 0; i < places.size(); ++i)
        {
          // Half of them in step with each other, the others everywhere.
          const std::size_t at = t % 2 == 0 ? i : (i * (2 * t + 1) + 31 * t) % places.size();
          values.assign(expected[at].size(), 0.0f);
          file->DecodeBrick(places[at].first, places[at].second, values.data());
          wrong +=
            std::memcmp(values.data(), expected[at].data(), values.size() * sizeof(float)) != 0;
          if (i % 7 == t % 7)
          {
            (void)file->Nodes(places[at].first);
            file->VerifyBricks(places[at].first, { places[at].second });
          }
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
}

/// The same of whole fields at once, which take other ways past the cache of boxes, while others
/// read the same through one cache of bricks.
TEST(ConcurrentReading, WholeFieldsAndBricksAtTheSameTime)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const Grid grid = GridOf(34, 33, 19);
  const auto steps = Sample<float>(grid, 6, Wavy<float>);
  EncodeOptions options;
  options.KeyframeInterval = 3;
  options.BrickCells = 16;
  Encode(path, grid, steps, options);
  std::vector<FieldKey> fields;
  std::vector<std::vector<float>> expected;
  {
    const auto file = SeriesFile::Open(path);
    for (int step = 0; step < 6; ++step)
    {
      for (int level = 0; level < file->Index().Levels; ++level)
      {
        fields.push_back({ step, 0, 0, level });
        expected.push_back(ReadAll<float>(*file, fields.back()));
      }
    }
  }
  const auto file = SeriesFile::Open(path);
  BrickCache cache(20000); // bricks come and go
  std::atomic<int> wrong{ 0 };
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < 16; ++t)
  {
    threads.emplace_back(
      [&, t]
      {
        for (std::size_t i = 0; i < fields.size(); ++i)
        {
          const std::size_t at = (i * (2 * t / 4 + 1) + 5 * t) % fields.size();
          const Box whole = { glm::ivec3(0), file->Layout(fields[at].Level).Samples() };
          std::vector<float> values(expected[at].size());
          BrickCache own(std::uint64_t{ 1 } << 20);
          ReadRegion(t % 2 == 0 ? own : cache, *file, fields[at], whole, values.data(), 1, 0);
          wrong +=
            std::memcmp(values.data(), expected[at].data(), values.size() * sizeof(float)) != 0;
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
}

} // namespace
} // namespace banyan::testing
