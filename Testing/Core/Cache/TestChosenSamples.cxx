// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesTesting.h"

#include "Base/Error.h"
#include "Cache/BrickCache.h"
#include "Cache/ChosenSamples.h"

#include <set>

namespace banyan::testing
{
namespace
{

/// The bricks that a search through all of them finds: the last one that holds a sample.
std::vector<std::int64_t> SlowBricksOf(
  const BrickLayout& layout, const std::vector<std::uint32_t>& samples)
{
  const glm::ivec3 n = layout.Samples();
  std::set<std::int64_t> found;
  for (const std::uint32_t sample : samples)
  {
    const int i = static_cast<int>(sample);
    const glm::ivec3 at(i % n.x, i / n.x % n.y, i / n.x / n.y);
    std::int64_t last = -1;
    for (std::int64_t brick = 0; brick < layout.BrickCount(); ++brick)
    {
      last = layout.SamplesOf(brick).Contains({ at, at + 1 }) ? brick : last;
    }
    found.insert(last);
  }
  return { found.begin(), found.end() };
}

template <class T>
void CheckChosen(const glm::ivec3& size, int cells)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(size.x, size.y, size.z);
  EncodeOptions options;
  options.BrickCells = cells;
  Encode(folder / "s.banyan", grid, Sample<T>(grid, 1, Wavy<T>), options);
  const auto file = SeriesFile::Open(folder / "s.banyan");
  const BrickLayout layout = file->Layout(0);
  const std::vector<T> whole = ReadAll<T>(*file, {});
  std::mt19937 random(static_cast<unsigned>(size.x));
  for (const std::size_t count : { 0, 1, 2, 500 })
  {
    std::vector<std::uint32_t> samples(count);
    for (std::uint32_t& sample : samples)
    {
      sample = static_cast<std::uint32_t>(random() % whole.size());
    }
    if (count > 1)
    {
      samples.back() = static_cast<std::uint32_t>(whole.size() - 1);
    }
    const ChosenSamples chosen(layout, samples);
    ASSERT_EQ(chosen.Count(), static_cast<std::int64_t>(count));
    EXPECT_EQ(chosen.Bricks(), SlowBricksOf(layout, samples));
    // Past the cache, through it, and from it.
    BrickCache none(0);
    BrickCache large(1 << 24);
    for (BrickCache* const cache : { &none, &large, &large })
    {
      const std::uint64_t before = file->BricksDecoded();
      std::vector<T> values(3 * count, T(9));
      chosen.Read(*cache, *file, {}, values.data(), 3, 1);
      for (std::size_t i = 0; i < count; ++i)
      {
        ASSERT_TRUE(SameBits(values[3 * i + 1], whole[samples[i]])) << samples[i];
        ASSERT_EQ(values[3 * i], T(9));
        ASSERT_EQ(values[3 * i + 2], T(9));
      }
      EXPECT_LE(file->BricksDecoded() - before, chosen.Bricks().size());
    }
  }
}

TEST(ChosenSamples, AreThoseOfTheImage)
{
  CheckChosen<float>({ 33, 34, 17 }, 16);
  CheckChosen<double>({ 40, 17, 61 }, 16);
  CheckChosen<std::int16_t>({ 36, 1, 9 }, 16);
  CheckChosen<float>({ 1, 1, 1 }, 16);
}

/// What one piece of a mesh wants is decoded, and no more.
TEST(ChosenSamples, DecodeOnlyTheBricksThatHoldThem)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(33, 33, 33);
  EncodeOptions options;
  options.BrickCells = 16;
  Encode(folder / "s.banyan", grid, Sample<float>(grid, 1, Wavy<float>), options);
  for (const std::uint64_t budget : { 0, 1 << 24 })
  {
    const auto file = SeriesFile::Open(folder / "s.banyan");
    BrickCache cache(budget);
    // The first sample, and one that all eight bricks have: the last one has it.
    const ChosenSamples chosen(file->Layout(0), { 0, 16 + 33 * (16 + 33 * 16) });
    EXPECT_EQ(chosen.Bricks(), (std::vector<std::int64_t>{ 0, 7 }));
    float values[2] = {};
    chosen.Read(cache, *file, {}, values, 1, 0);
    EXPECT_EQ(file->BricksDecoded(), 2u);
  }
}

TEST(ChosenSamples, RefuseWhatTheImageHasNot)
{
  const BrickLayout layout({ 5, 6, 7 }, 4, 0);
  EXPECT_NO_THROW(ChosenSamples(layout, { 209 }));
  EXPECT_THROW(ChosenSamples(layout, { 210 }), Error);
}

} // namespace
} // namespace banyan::testing
