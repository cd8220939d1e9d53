// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/BrickGroups.h"

#include "Render/Bricks/SummaryTree.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <cstring>
#include <mutex>
#include <set>

namespace
{

using namespace banyan;

constexpr std::uint64_t NoLimit = std::uint64_t{ 1 } << 40;

std::int64_t NumberOf(const BrickSource& source, const glm::ivec3& p)
{
  return BrickGroups(source, BrickGroups::Cells).BrickAt(p);
}

/// Notes which bricks are loaded alone, and which together.
class Noting : public ArrayBrickSource
{
public:
  using ArrayBrickSource::ArrayBrickSource;

  BrickView Load(std::int64_t brick) override
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    EXPECT_TRUE(this->Alone.insert(brick).second);
    return ArrayBrickSource::Load(brick);
  }

  BrickView LoadTogether(const Box& bricks, bool around, Box& samples) override
  {
    const BrickGroups groups(*this, BrickGroups::Cells);
    const std::lock_guard<std::mutex> lock(this->Mutex);
    ForMembers(groups, bricks,
      [&](std::int64_t brick, int) { EXPECT_TRUE(this->Together.insert(brick).second); });
    return ArrayBrickSource::LoadTogether(bricks, around, samples);
  }

  std::mutex Mutex;
  std::set<std::int64_t> Alone;
  std::set<std::int64_t> Together;
};

TEST(BrickGroups, HaveEachBrickOnce)
{
  const glm::ivec3 n(70, 50, 33);
  const std::vector<float> values = scenes::Sampled(scenes::Linear, n);
  ThreadPool pool(1);
  for (const int cells : { 8, 9, 16, 17 })
  {
    const ArrayBrickSource source(scenes::ArrayOf(values, n), cells, { 0, 1 }, pool);
    for (const int most : { 0, BrickGroups::Cells, BrickGroups::CellsOfLarge })
    {
      const BrickGroups groups(source, most);
      const int edge = most == 0 || cells == 8 ? 1
                       : most == 64            ? (cells <= 16 ? 4 : 2)
                                               : (cells <= 16 ? 2 : 1);
      EXPECT_EQ(groups.BricksPerAxis(), edge) << cells << " of " << most;
      std::set<std::int64_t> seen;
      for (std::int64_t group = 0; group < groups.Count(); ++group)
      {
        const Box bricks = groups.BricksOf(group);
        Box together;
        std::set<int> places;
        ForMembers(groups, bricks,
          [&](std::int64_t brick, int place)
          {
            EXPECT_TRUE(seen.insert(brick).second);
            EXPECT_LT(place, edge * edge * edge);
            EXPECT_TRUE(places.insert(place).second);
            together = Union(together, source.CellsOf(brick));
          });
        EXPECT_EQ(source.Summaries()->CellsOf(bricks), together);
        ForPositions(bricks,
          [&](const glm::ivec3& low)
          {
            std::uint64_t expected = 0;
            const Box some{ low, bricks.Hi };
            ForMembers(groups, some,
              [&](std::int64_t, int place) { expected |= std::uint64_t{ 1 } << place; });
            EXPECT_EQ(groups.PlacesOf(some), expected);
          });
      }
      const glm::ivec3 counts = source.Bricks();
      EXPECT_EQ(seen.size(), static_cast<std::size_t>(counts.x * counts.y * counts.z));
    }
  }
}

TEST(BrickGroups, AreLoadedAsTheArrayIs)
{
  const glm::ivec3 n(45, 38, 41);
  std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  values[0] = std::numeric_limits<float>::quiet_NaN();
  ThreadPool pool(1);
  ArrayBrickSource source(scenes::ArrayOf(values, n), 11, { 0, 1 }, pool);
  const BrickGroups groups(source, BrickGroups::Cells);
  for (std::int64_t group = 0; group < groups.Count(); ++group)
  {
    for (const bool around : { false, true })
    {
      // Put together from bricks, as all other sources do it.
      Box samples;
      const BrickView view =
        source.BrickSource::LoadTogether(groups.BricksOf(group), around, samples);
      Box same;
      source.LoadTogether(groups.BricksOf(group), around, same);
      ASSERT_EQ(samples, same);
      ASSERT_EQ(view.Type, ScalarType::Float32);
      const Box cells = source.Summaries()->CellsOf(groups.BricksOf(group));
      const int layer = around ? 1 : 0;
      EXPECT_EQ(samples,
        Intersection(Box{ cells.Lo - layer, cells.Hi + 1 + layer }, Box{ glm::ivec3(0), n }));
      for (int z = samples.Lo.z; z < samples.Hi.z; ++z)
      {
        for (int y = samples.Lo.y; y < samples.Hi.y; ++y)
        {
          for (int x = samples.Lo.x; x < samples.Hi.x; ++x)
          {
            const glm::ivec3 p = glm::ivec3(x, y, z) - samples.Lo;
            const float* const here = static_cast<const float*>(view.Values) +
                                      p.x * view.Stride[0] + p.y * view.Stride[1] +
                                      p.z * view.Stride[2];
            const std::size_t number = x + n.x * (y + static_cast<std::size_t>(n.y) * z);
            ASSERT_EQ(std::memcmp(here, &values[number], sizeof(float)), 0);
          }
        }
      }
    }
  }
}

TEST(BrickGroups, BricksThatCannotBeSeenAreNotLoadedWithOthers)
{
  // 3 bricks along each axis; all have values that can be seen, one but for its inner ones.
  const glm::ivec3 n(49);
  std::vector<float> values = scenes::Sampled(scenes::Linear, n);
  RayScene scene = scenes::Scene(n, { 80, 80 });
  ThreadPool pool(2);
  const auto draw = [&](Noting& source)
  {
    RayStatistics statistics;
    CastRays(scene, source, scene.DomainCells, NoLimit, pool, statistics);
    EXPECT_EQ(statistics.BricksDrawn,
      static_cast<std::int64_t>(source.Alone.size() + source.Together.size()));
    EXPECT_EQ(statistics.BricksDrawn + statistics.BricksSkipped, 27);
  };
  Noting all(scenes::ArrayOf(values, n), 16, { 0, 1 }, pool);
  draw(all);
  // A group of one brick is that brick.
  EXPECT_EQ(all.Alone, (std::set<std::int64_t>{ NumberOf(all, { 2, 2, 2 }) }));
  EXPECT_EQ(all.Together.size(), 26u);

  scene.Transfer =
    scenes::Tabulate([](double v) { return glm::dvec4(1.0, 1.0, 1.0, v > 0.2 ? 0.01 : 0.0); });
  Noting some(scenes::ArrayOf(values, n), 16, { 0, 1 }, pool);
  const auto visible = [&](std::int64_t brick) { return some.RangeOf(brick).High > 0.201; };
  ASSERT_TRUE(visible(1));
  draw(some);
  std::set<std::int64_t> loaded = some.Alone;
  loaded.insert(some.Together.begin(), some.Together.end());
  for (std::int64_t brick = 0; brick < 27; ++brick)
  {
    EXPECT_EQ(loaded.count(brick) == 1, visible(brick)) << brick;
  }

  // A value that no opacity is given to, in all of one brick.
  for (int z = 0; z <= 16; ++z)
  {
    for (int y = 0; y <= 16; ++y)
    {
      std::fill_n(&values[n.x * (y + static_cast<std::size_t>(n.y) * z)], 17, 0.1f);
    }
  }
  Noting hole(scenes::ArrayOf(values, n), 16, { 0, 1 }, pool);
  draw(hole);
  EXPECT_EQ(hole.Alone.count(0) + hole.Together.count(0), 0u);
  EXPECT_EQ(hole.Together.count(1), 0u);
  EXPECT_EQ(hole.Alone.count(1), 1u);
  EXPECT_FALSE(hole.Together.empty());
}

TEST(BrickGroups, BricksBesideTheScreenAreNotLoaded)
{
  const glm::ivec3 n(97);
  const std::vector<float> values = scenes::Sampled(scenes::Linear, n);
  RayScene scene = scenes::Scene(n, { 90, 70 }, glm::dmat4(1.0), 0.4);
  ThreadPool pool(1);
  Noting source(scenes::ArrayOf(values, n), 16, { 0, 1 }, pool);
  RayStatistics statistics;
  CastRays(scene, source, scene.DomainCells, NoLimit, pool, statistics);
  EXPECT_FALSE(source.Together.empty());
  EXPECT_FALSE(source.Alone.empty());
  EXPECT_LT(source.Together.size() + source.Alone.size(), 216u);
  const RayCamera camera = scene.Camera.InSpace(scene.IndexToWorld);
  for (const std::set<std::int64_t>& loaded : { source.Together, source.Alone })
  {
    for (const std::int64_t brick : loaded)
    {
      const Box cells = source.CellsOf(brick);
      EXPECT_FALSE(camera.Footprint(glm::dvec3(cells.Lo), glm::dvec3(cells.Hi)).Empty());
    }
  }
}

TEST(BrickGroups, ChangeNoBitWhereTheyMeetSingleBricks)
{
  const glm::ivec3 n(81, 75, 90);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  for (const double distance : { 1.4, 0.3, 0.05 })
  {
    for (const bool shaded : { false, true })
    {
      RayScene scene = scenes::Scene(n, { 110, 90 }, glm::dmat4(1.0), distance);
      // Opaque where it can be seen: the order of bricks counts.
      scene.Transfer =
        scenes::Tabulate([](double v) { return glm::dvec4(v, 1.0 - v, 0.5, v > 0.3 ? 0.7 : 0.0); });
      scene.Shading.On = shaded;
      const FloatImage grouped = scenes::Draw(scene, scenes::ArrayOf(values, n), { 16 }).Image;
      const FloatImage single = scenes::Draw(scene, scenes::ArrayOf(values, n), { 8 }).Image;
      EXPECT_EQ(MaxDifference(grouped, single), 0.0) << distance << shaded;
      // No room for larger bricks.
      const FloatImage small =
        scenes::Draw(scene, scenes::ArrayOf(values, n), { 16, 1, 4096 }).Image;
      EXPECT_EQ(MaxDifference(grouped, small), 0.0) << distance << shaded;
    }
  }
}

TEST(BrickGroups, MacroCellsBelongToTheBrickThatTheirMiddleIsIn)
{
  const glm::ivec3 n(33);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  ThreadPool pool(1);
  ArrayBrickSource source(scenes::ArrayOf(values, n), 32, { 0, 1 }, pool);
  const Box cells{ glm::ivec3(0), n - 1 };
  const PackedBrick packed(source.Load(0), glm::ivec3(0), cells, 0.0);
  const VisibleValues visible(
    scenes::Tabulate([](double v) { return glm::dvec4(1.0, 1.0, 1.0, v > 0.6 ? 0.5 : 0.0); }));
  const BrickVisibility seen(packed, source.RangeOf(0), visible);
  ASSERT_TRUE(seen.Holes);
  int all = 0;
  for (const glm::ivec3& low : { glm::ivec3(0), glm::ivec3(16), glm::ivec3(5, 0, 11) })
  {
    const Box part{ low, glm::ivec3(low.x == 5 ? 23 : low.x + 16, low.y + 16, low.z + 16) };
    int expected = 0;
    for (int number = 0; number < PackedBrick::MacroCells; ++number)
    {
      const glm::ivec3 macro(number % 8, number / 8 % 8, number / 64);
      const bool shown = (seen.Mask[number / 32] >> number % 32 & 1u) != 0;
      expected += shown && part.Contains(4 * macro + 2) ? 1 : 0;
    }
    EXPECT_EQ(seen.MacrosIn(part, packed.Corner()), expected);
    all += expected;
  }
  EXPECT_GT(all, 0);
}

TEST(BrickGroups, WhatIsKnownOfThemIsKeptForOneFunction)
{
  PackedBrickCache kept;
  int looks = 0;
  const auto look = [&]
  {
    ++looks;
    return GroupMembers{ 7, 3, 1 };
  };
  const auto bytes = [&] { return std::uint64_t{ 0 } * static_cast<std::uint64_t>(++looks); };
  const auto groups = kept.GroupsOf(0, 7, 3, 5);
  for (int i = 0; i < 2; ++i)
  {
    const GroupMembers members = groups->MembersOf(2, look);
    EXPECT_EQ(members.There, 7u);
    EXPECT_EQ(members.Visible, 3u);
    EXPECT_EQ(members.Uniform, 1u);
    EXPECT_EQ(groups->BytesOf(2, bytes), 0u);
  }
  EXPECT_EQ(looks, 2);
  EXPECT_EQ(kept.GroupsOf(0, 7, 3, 5), groups);
  EXPECT_EQ(kept.GroupsOf(0, 7, 3, 0), groups);
  EXPECT_NE(kept.GroupsOf(1, 7, 3, 5), groups);
  EXPECT_NE(kept.GroupsOf(0, 7, 3, 6), groups);
  const auto others = kept.GroupsOf(0, 8, 3, 0);
  EXPECT_NE(others, groups);
  EXPECT_NE(kept.GroupsOf(0, 8, 4, 0), others);
}

} // namespace
