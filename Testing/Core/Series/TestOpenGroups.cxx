// SPDX-License-Identifier: BSD-3-Clause
// Groups of steps that refer to the key frame of the group before.
#include "Series/SeriesTesting.h"

#include "Base/Error.h"
#include "Series/Decode/CacheContext.h"
#include "Series/Decode/GroupReader.h"
#include "Series/Format/GroupFormat.h"

#include <fstream>

namespace banyan::testing
{
namespace
{

constexpr int Interval = 4;
const Grid Domain = GridOf(37, 33, 35);

/// Which groups of a series with one component refer to the one before.
std::vector<bool> OpenGroups(const std::string& path, const SeriesIndex& index)
{
  std::vector<bool> open;
  for (const SegmentIndex& segment : index.Segments)
  {
    GroupReader reader(path + ".d", segment, 1);
    const Bytes head = reader.Section(reader.HeadSection(0));
    open.push_back(group::UnpackHead(head.data(), head.size()).Open);
  }
  return open;
}

EncodeOptions Options()
{
  EncodeOptions options;
  options.KeyframeInterval = Interval;
  options.BrickCells = 16;
  return options;
}

/// Encodes; the steps must come back within the bound, in any order.
std::vector<bool> OpenGroupsOf(const Steps<float>& steps, const EncodeOptions& options)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const SeriesIndex index = Encode(path, Domain, steps, options);
  for (std::size_t s = steps.size(); s-- > 0;)
  {
    EXPECT_TRUE(WithinBound(steps[s],
      ReadAll<float>(*SeriesFile::Open(path), { static_cast<int>(s), 0, 0, 0 }),
      index.Arrays[0].Components[0].ErrorBoundAbsolute));
  }
  return OpenGroups(path, index);
}

TEST(OpenGroups, AreAllButTheFirstWhereTheLatticeIsTheSame)
{
  const auto steps = Sample<float>(Domain, 13, Wavy<float>);
  // The last group is its key frame alone.
  EXPECT_EQ(OpenGroupsOf(steps, Options()), (std::vector<bool>{ false, true, true, false }));
  EncodeOptions options = Options();
  options.KeyframeInterval = 1;
  EXPECT_EQ(OpenGroupsOf(steps, options), std::vector<bool>(13, false));
  options = Options();
  options.ErrorBound = 0; // no lattice holds that
  EXPECT_EQ(OpenGroupsOf(steps, options), std::vector<bool>(4, false));
}

TEST(OpenGroups, AreNoneWithoutRangesOfTheSeries)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const auto steps = Sample<float>(Domain, 9, Wavy<float>);
  EncodeOptions options = Options();
  options.Mode = ErrorBoundMode::Absolute;
  options.ErrorBound = 0.1;
  ArrayDescription description = Describe(steps);
  description.SeriesRanges.clear();
  ThreadPool pool(2);
  SeriesEncoder encoder(path, Domain, { description }, options, pool);
  for (std::size_t s = 0; s < steps.size(); ++s)
  {
    encoder.AddStep(static_cast<double>(s), { { steps[s].data() } });
  }
  EXPECT_EQ(OpenGroups(path, encoder.Finish()), std::vector<bool>(3, false));
}

TEST(OpenGroups, AreClosedWhenAsked)
{
  const auto steps = Sample<float>(Domain, 13, Wavy<float>);
  EncodeOptions options = Options();
  options.ClosedGroups = true;
  EXPECT_EQ(OpenGroupsOf(steps, options), std::vector<bool>(4, false));
}

/// Also where every step is the same: an array that rests is then stored in each group.
TEST(OpenGroups, ClosedGroupsAreReadByThemselves)
{
  for (const bool rests : { false, true })
  {
    const TemporaryFolder folder;
    const std::string path = folder / "s.banyan";
    const auto steps = Sample<float>(Domain, 12,
      [rests](int x, int y, int z, int s) { return Wavy<float>(x, y, z, rests ? 0 : s); });
    const auto moving = Sample<float>(Domain, 12, Wavy<float>);
    EncodeOptions options = Options();
    options.ClosedGroups = true;
    ThreadPool pool(2);
    SeriesEncoder encoder(
      path, Domain, { Describe(steps, "a"), Describe(moving, "b") }, options, pool);
    for (std::size_t s = 0; s < steps.size(); ++s)
    {
      encoder.AddStep(static_cast<double>(s), { { steps[s].data() }, { moving[s].data() } });
    }
    const SeriesIndex index = encoder.Finish();
    const auto whole = SeriesFile::Open(path);
    std::vector<std::vector<float>> expected;
    for (int s = 4; s < 8; ++s)
    {
      expected.push_back(ReadAll<float>(*whole, { s, 0, 0, 0 }));
    }
    whole->Caches()->Blocks().Forget(whole->Id());
    // The groups around the second one cannot be read.
    for (const int other : { 0, 2 })
    {
      const std::string name = path + ".d/" + index.Segments[static_cast<std::size_t>(other)].File;
      const auto bytes = std::filesystem::file_size(name);
      std::ofstream(name, std::ios::binary | std::ios::trunc) << std::string(bytes, 'x');
    }
    const auto file = SeriesFile::Open(path);
    for (int s = 4; s < 8; ++s)
    {
      EXPECT_EQ(ReadAll<float>(*file, { s, 0, 0, 0 }), expected[static_cast<std::size_t>(s - 4)]);
    }
    EXPECT_THROW((void)ReadAll<float>(*file, { 1, 0, 0, 0 }), Error);
  }
}

TEST(OpenGroups, AreClosedWhereTheAxesChange)
{
  const auto steps = Sample<float>(Domain, 16,
    [](int x, int y, int z, int s)
    {
      const double rough = s < 8 ? x : z;
      const double smooth = s < 8 ? z : x;
      return std::sin(0.9 * rough + 0.1 * s) + 0.3 * std::sin(0.3 * y) + 0.01 * smooth;
    });
  EXPECT_EQ(OpenGroupsOf(steps, Options()), (std::vector<bool>{ false, true, false, true }));
}

/// What a cache relies on: bricks are known to be the same exactly when they are, from step to
/// step, in one segment as across two.
TEST(OpenGroups, BricksThatRestKeepTheirIdentity)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const Grid grid = GridOf(65, 33, 33);
  auto steps = Sample<float>(grid, 14,
    [](int x, int y, int z, int s)
    {
      const bool moves = (x < 16 && y < 16) || (x >= 48 && s == 6); // there for one step only
      return Wavy<float>(x, y, z, moves ? s : 0);
    });
  steps[9][5] = NAN;
  for (std::size_t s = 0; s < steps.size(); ++s)
  {
    steps[s][64] = 1e20f; // kept exactly, in a brick that rests
  }
  EncodeOptions options = Options();
  options.BrickCells = 16;
  ArrayDescription description = Describe(steps);
  description.SeriesRanges = { ValueRange{ -40.0, 80.0 } };
  ThreadPool pool(2);
  SeriesEncoder encoder(path, grid, { description }, options, pool);
  for (std::size_t s = 0; s < steps.size(); ++s)
  {
    encoder.AddStep(static_cast<double>(s), { { steps[s].data() } });
  }
  EXPECT_EQ(OpenGroups(path, encoder.Finish()), (std::vector<bool>{ false, true, true, true }));
  const auto file = SeriesFile::Open(path);
  int acrossSegments = 0;
  for (int level = 0; level < file->Index().Levels; ++level)
  {
    const BrickLayout layout = file->Layout(level);
    for (std::int64_t b = 0; b < layout.BrickCount(); ++b)
    {
      const auto count = static_cast<std::size_t>(layout.SamplesOf(b).Count());
      std::vector<float> now(count), before(count);
      for (int s = 0; s < 14; ++s)
      {
        std::swap(now, before);
        file->DecodeBrick({ s, 0, 0, level }, b, now.data());
        if (s == 0)
        {
          continue;
        }
        const glm::ivec3 p = layout.PositionOf(b);
        const auto at = static_cast<std::size_t>(b);
        const bool known = (*file->Nodes({ s, 0, 0, level }))[at].Identity ==
                           (*file->Nodes({ s - 1, 0, 0, level }))[at].Identity;
        const bool same = std::memcmp(now.data(), before.data(), count * sizeof(float)) == 0;
        // What has just come to rest may count as changed once more where a segment begins.
        EXPECT_TRUE(same || !known) << "step " << s << ", level " << level << ", brick " << b;
        EXPECT_TRUE(known || !same || (p.x >= 2 >> level && s == 8))
          << "step " << s << ", level " << level << ", brick " << b;
        acrossSegments += known && s % Interval == 0 ? 1 : 0;
        if (level == 0 && p.x == 1)
        {
          EXPECT_TRUE(known || s % Interval == Interval - 1 || s == 13)
            << "only key frames are made anew";
        }
      }
    }
  }
  EXPECT_GT(acrossSegments, 3 * 10);
}

TEST(OpenGroups, WhatNeverChangesKeepsItsIdentityForever)
{
  const TemporaryFolder folder;
  const auto steps =
    Sample<float>(Domain, 11, [](int x, int y, int z, int) { return Wavy<float>(x, y, z, 0); });
  const SeriesIndex index = Encode(folder / "s.banyan", Domain, steps, Options());
  EXPECT_EQ(index.Segments.size(), 3u);
  const auto file = SeriesFile::Open(folder / "s.banyan");
  for (int level = 0; level < index.Levels; ++level)
  {
    const auto first = file->Nodes({ 0, 0, 0, level });
    for (int s = 1; s < 11; ++s)
    {
      const auto nodes = file->Nodes({ s, 0, 0, level });
      for (std::size_t b = 0; b < nodes->size(); ++b)
      {
        EXPECT_TRUE((*nodes)[b].Identity == (*first)[b].Identity) << s << " " << level << " " << b;
      }
    }
  }
}

} // namespace
} // namespace banyan::testing
