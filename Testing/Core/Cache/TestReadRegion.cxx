// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesTesting.h"

#include "Base/Error.h"
#include "Series/Decode/CacheContext.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

namespace banyan::testing
{
namespace
{

template <class T>
void CheckRegions(const glm::ivec3& size, int cells)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(size.x, size.y, size.z);
  auto steps = Sample<T>(grid, 1, Wavy<T>);
  EncodeOptions options;
  options.BrickCells = cells;
  Encode(folder / "s.banyan", grid, steps, options);
  const auto file = SeriesFile::Open(folder / "s.banyan");
  std::mt19937 random(size.x);
  for (int level = 0; level < file->Index().Levels; ++level)
  {
    const std::vector<T> whole = ReadAll<T>(*file, { 0, 0, 0, level });
    const glm::ivec3 n = file->Layout(level).Samples();
    BrickCache cache(200000);
    for (int round = 0; round < 40; ++round)
    {
      Box box;
      for (int axis = 0; axis < 3; ++axis)
      {
        const auto length = static_cast<unsigned>(n[axis]);
        const int a = static_cast<int>(random() % length);
        const int b = static_cast<int>(random() % length);
        box.Lo[axis] = std::min(a, b);
        box.Hi[axis] = std::max(a, b) + 1;
      }
      const int stride = 1 + static_cast<int>(random() % 3);
      const int component = static_cast<int>(random() % static_cast<unsigned>(stride));
      const T untouched = static_cast<T>(123);
      std::vector<T> values(
        static_cast<std::size_t>(box.Count()) * static_cast<std::size_t>(stride), untouched);
      ReadRegion(cache, *file, { 0, 0, 0, level }, box, values.data(), stride, component);
      std::size_t i = 0;
      for (int z = box.Lo.z; z < box.Hi.z; ++z)
      {
        for (int y = box.Lo.y; y < box.Hi.y; ++y)
        {
          for (int x = box.Lo.x; x < box.Hi.x; ++x)
          {
            for (int c = 0; c < stride; ++c, ++i)
            {
              const T expected = c == component
                                   ? whole[static_cast<std::size_t>((z * n.y + y) * n.x + x)]
                                   : untouched;
              ASSERT_TRUE(SameBits(values[i], expected)) << x << " " << y << " " << z << " " << c;
            }
          }
        }
      }
    }
  }
}

/// What would push out everything else does not enter, but what is held is used.
TEST(ReadRegion, LargePartsGoPastTheCache)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(33, 33, 33);
  const auto steps = Sample<float>(grid, 1, Wavy<float>);
  EncodeOptions options;
  options.BrickCells = 16;
  Encode(folder / "s.banyan", grid, steps, options);
  const auto file = SeriesFile::Open(folder / "s.banyan");
  const Box whole{ glm::ivec3(0), file->Layout(0).Samples() };
  const std::uint64_t bytes = static_cast<std::uint64_t>(whole.Count()) * sizeof(float);
  std::vector<float> values(static_cast<std::size_t>(whole.Count()));
  BrickCache large(6 * bytes + 6);
  ReadRegion(large, *file, {}, whole, values.data(), 1, 0);
  EXPECT_EQ(large.GetStatistics().Misses, 8u);
  std::vector<float> past(values.size());
  BrickCache small(6 * bytes);
  ReadRegion(small, *file, {}, whole, past.data(), 1, 0);
  EXPECT_EQ(past, values);
  EXPECT_EQ(small.GetStatistics().Misses, 0u);
  EXPECT_EQ(small.GetStatistics().Bytes, 0u);
  (void)small.Get(*file, {}, 3);
  ReadRegion(small, *file, {}, whole, past.data(), 1, 0);
  EXPECT_EQ(past, values);
  EXPECT_EQ(small.GetStatistics().Hits, 1u);
}

/// Numbers of bricks that were decoded are kept, so that values need not be; where that is not so,
/// they are.
TEST(ReadRegion, LargePartsOfKeptNumbersGoPastTheCache)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(70, 65, 65);
  const auto steps = Sample<float>(grid, 1, Wavy<float>);
  for (const bool multiples : { true, false })
  {
    EncodeOptions options;
    options.BrickCells = 16;
    options.ErrorBound = multiples ? 0.001 : 0.0;
    Encode(folder / "s.banyan", grid, steps, options);
    const auto file = SeriesFile::Open(folder / "s.banyan");
    EXPECT_EQ(file->StepOfValues({}) > 0, multiples);
    const Box whole{ glm::ivec3(0), file->Layout(0).Samples() };
    const std::vector<float> expected = ReadAll<float>(*file, {});
    BrickCache cache(std::uint64_t{ 1 } << 30);
    std::vector<float> values(expected.size());
    ReadRegion(cache, *file, {}, whole, values.data(), 1, 0);
    EXPECT_EQ(values, expected);
    EXPECT_EQ(cache.GetStatistics().Misses, multiples ? 0u : 80u);
    const std::uint64_t decoded = file->BricksDecoded();
    std::fill(values.begin(), values.end(), 0.0f);
    ReadRegion(cache, *file, {}, whole, values.data(), 1, 0);
    EXPECT_EQ(values, expected);
    EXPECT_EQ(file->BricksDecoded() == decoded, !multiples); // values are made once more
    // A smaller part goes through it.
    ReadRegion(cache, *file, {}, { { 1, 1, 1 }, { 9, 9, 9 } }, values.data(), 1, 0);
    EXPECT_EQ(cache.GetStatistics().Misses, multiples ? 1u : 80u);
  }
}

TEST(DecodePart, IsThePartOfTheBrickAndNoMore)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(36, 36, 36);
  auto steps = Sample<float>(grid, 1, Wavy<float>);
  steps[0][5] = std::numeric_limits<float>::quiet_NaN(); // the first brick goes another way
  EncodeOptions options;
  options.BrickCells = 16;
  Encode(folder / "s.banyan", grid, steps, options);
  const auto file = SeriesFile::Open(folder / "s.banyan");
  const BrickLayout layout = file->Layout(0);
  for (std::int64_t brick = 0; brick < layout.BrickCount(); ++brick)
  {
    const Box samples = layout.SamplesOf(brick);
    const glm::ivec3 n = samples.Size();
    std::vector<float> whole(static_cast<std::size_t>(samples.Count()));
    file->DecodeBrick({}, brick, whole.data());
    const Box part{ samples.Lo + glm::min(glm::ivec3(1, 2, 0), n - 1), samples.Hi };
    const glm::ivec3 size = part.Size();
    const glm::i64vec3 stride{ 2, 2 * size.x + 1, (2 * size.x + 1) * size.y };
    std::vector<float> values(static_cast<std::size_t>(stride.z * size.z), -7.0f);
    std::vector<float> expected = values;
    file->DecodePart({}, brick, part, stride, values.data());
    for (int z = 0; z < size.z; ++z)
    {
      for (int y = 0; y < size.y; ++y)
      {
        for (int x = 0; x < size.x; ++x)
        {
          const glm::ivec3 p = part.Lo - samples.Lo + glm::ivec3(x, y, z);
          expected[static_cast<std::size_t>(x * stride.x + y * stride.y + z * stride.z)] =
            whole[static_cast<std::size_t>((p.z * n.y + p.y) * n.x + p.x)];
        }
      }
    }
    EXPECT_EQ(std::memcmp(values.data(), expected.data(), values.size() * sizeof(float)), 0)
      << brick;
    EXPECT_THROW(
      file->DecodePart({}, brick, { samples.Lo, samples.Hi + 1 }, stride, values.data()), Error);
  }
}

TEST(ReadRegion, AnyBoxGivesWhatTheWholeGives)
{
  CheckRegions<float>({ 50, 33, 17 }, 32);
  CheckRegions<float>({ 50, 33, 17 }, 16);
  CheckRegions<std::int8_t>({ 1, 80, 45 }, 16);
  CheckRegions<std::uint16_t>({ 57, 1, 1 }, 16);
  CheckRegions<double>({ 16, 17, 18 }, 16);
}

TEST(ReadRegion, DecodesOnlyWhatItTouches)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(65, 65, 33);
  EncodeOptions options;
  options.BrickCells = 16;
  Encode(folder / "s.banyan", grid, Sample<float>(grid, 1, Wavy<float>), options);
  const auto file = SeriesFile::Open(folder / "s.banyan");
  BrickCache cache(std::uint64_t{ 1 } << 28);
  std::vector<float> values(static_cast<std::size_t>(grid.Extent.Count()));
  EXPECT_EQ(file->BytesRead(), 0u);
  ReadRegion(cache, *file, {}, { { 3, 3, 3 }, { 17, 17, 17 } }, values.data(), 1, 0);
  EXPECT_EQ(file->BricksDecoded(), 1u);
  EXPECT_GT(file->BytesRead(), 0u);
  ReadRegion(cache, *file, {}, { { 15, 3, 3 }, { 18, 4, 4 } }, values.data(), 1, 0);
  EXPECT_EQ(file->BricksDecoded(), 2u);
  ReadRegion(cache, *file, {}, { { 0, 0, 0 }, { 65, 65, 33 } }, values.data(), 1, 0);
  EXPECT_EQ(file->BricksDecoded(), 32u);
  ReadRegion(cache, *file, {}, { { 5, 5, 5 }, { 5, 9, 9 } }, values.data(), 1, 0);
  EXPECT_EQ(cache.GetStatistics().Misses, 32u);
}

TEST(ReadRegion, MacroVoxelsAreFilledWithoutDecoding)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(40, 40, 40);
  Encode(folder / "s.banyan", grid,
    Sample<std::int64_t>(grid, 1, [](int, int, int, int) { return -7; }), {});
  const auto file = SeriesFile::Open(folder / "s.banyan");
  BrickCache cache(std::uint64_t{ 1 } << 28);
  std::vector<std::int64_t> values(40 * 40 * 40, 0);
  ReadRegion(cache, *file, {}, grid.Extent, values.data(), 1, 0);
  EXPECT_EQ(std::count(values.begin(), values.end(), -7), 64000);
  EXPECT_EQ(file->BricksDecoded(), 0u);
  EXPECT_EQ(cache.GetStatistics().Misses, 0u);
}

/// Memory of this process that mapped files of a folder take, in bytes.
std::uint64_t MappedMemoryOf(const std::string& folder)
{
  std::ifstream maps("/proc/self/smaps");
  std::uint64_t kilobytes = 0;
  bool inside = false;
  for (std::string line; std::getline(maps, line);)
  {
    std::istringstream words(line);
    std::string first;
    words >> first;
    if (first.find('-') != std::string::npos)
    {
      inside = line.find(folder) != std::string::npos;
    }
    else if (inside && first == "Rss:")
    {
      std::uint64_t size = 0;
      words >> size;
      kilobytes += size;
    }
  }
  return kilobytes * 1024;
}

TEST(ReadRegion, PlayingALongSeriesDoesNotCollectItsFilesInMemory)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(48, 48, 48);
  std::mt19937 random(6);
  EncodeOptions options;
  options.KeyframeInterval = 1;
  const SeriesIndex index = Encode(folder / "s.banyan", grid,
    Sample<std::uint8_t>(grid, 20, [&](int, int, int, int) { return random() % 256; }), options);
  const std::uint64_t one = index.Segments[0].Bytes;
  ASSERT_GT(one, 100000u);
  const auto caches = std::make_shared<CacheContext>(128 * one);
  const auto file = SeriesFile::Open(folder / "s.banyan", caches);
  const std::uint64_t most = caches->Payloads().BudgetBytes();
  ASSERT_LT(most, 5 * one);
  for (int s = 0; s < 20; ++s)
  {
    (void)ReadAll<std::uint8_t>(*file, { s, 0, 0, 0 });
    EXPECT_LE(caches->Payloads().Bytes(), most) << "step " << s;
    EXPECT_GT(caches->Payloads().Bytes(), 0u);
    EXPECT_EQ(MappedMemoryOf(folder.Path()), 0u);
  }
  (void)ReadAll<std::uint8_t>(*file, { 0, 0, 0, 0 }); // let go, and still there
}

TEST(ReadRegion, RejectsWhatLiesOutside)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(20, 20, 20);
  Encode(folder / "s.banyan", grid, Sample<float>(grid, 1, Wavy<float>), {});
  const auto file = SeriesFile::Open(folder / "s.banyan");
  BrickCache cache(std::uint64_t{ 1 } << 20);
  std::vector<float> values(8000);
  const auto read = [&](const Box& box, int stride, int component, int level = 0) {
    ReadRegion(cache, *file, { 0, 0, 0, level }, box, values.data(), stride, component);
  };
  EXPECT_THROW(read({ { 0, 0, 0 }, { 21, 1, 1 } }, 1, 0), Error);
  EXPECT_THROW(read({ { -1, 0, 0 }, { 2, 1, 1 } }, 1, 0), Error);
  EXPECT_THROW(read({ { 0, 0, 0 }, { 2, 1, 1 } }, 1, 1), Error);
  EXPECT_THROW(read({ { 0, 0, 0 }, { 2, 1, 1 } }, 1, -1), Error);
  EXPECT_THROW(read({ { 0, 0, 0 }, { 12, 1, 1 } }, 1, 0, 1), Error);
  EXPECT_THROW(read({ { 0, 0, 0 }, { 1, 1, 1 } }, 1, 0, 5), Error);
  EXPECT_NO_THROW(read({ { 0, 0, 0 }, { 20, 20, 20 } }, 1, 0));
}

} // namespace
} // namespace banyan::testing
