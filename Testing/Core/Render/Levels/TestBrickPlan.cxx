// SPDX-License-Identifier: BSD-3-Clause
// What is found by going down summaries is what loops over all bricks find.
#include "Render/Levels/BrickPlan.h"

#include "Parallel/Balance/FrameCost.h"
#include "Render/Bricks/VisibleBricks.h"
#include "Render/Levels/LevelCaster.h"
#include "Render/Levels/SharedPlans.h"
#include "Render/MadeUpBricks.h"
#include "Render/Sampling/SamplingPlan.h"
#include "Render/Scene/BoxOnScreen.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace
{

using namespace banyan;

constexpr std::uint64_t NoLimit = std::uint64_t{ 1 } << 40;

/// A scene of bricks without values, from anywhere and with anything that leaves bricks out.
struct Case
{
  std::unique_ptr<scenes::MadeUpBricks> Source;
  RayScene Scene;
  Box Cells;

  static Case Random(Dice& dice)
  {
    const glm::ivec3 cells(dice.Whole(1, 200), dice.Whole(1, 200), dice.Whole(1, 90));
    const double distance = dice.Whole(0, 2) == 0 ? 1.4 : dice.In(0.05, 1.2);
    // Single bricks that are smaller than a pixel may be missed by all rays.
    RayScene scene =
      scenes::Scene(cells + 1, { 4000, 3000 }, glm::dmat4(1.0), distance, dice.Whole(0, 3) == 0);
    const double low = dice.In(-0.2, 1.0);
    const double width = dice.In(0.0, 0.6);
    scene.Transfer = scenes::Tabulate(
      [&](double v) { return glm::dvec4(1, 1, 1, v >= low && v <= low + width ? 0.1 : 0.0); });
    if (dice.Whole(0, 2) == 0)
    {
      scene.ClipPlanes.push_back({ dice.Direction(), dice.In(-100.0, 100.0) });
    }
    scene.Shading.On = dice.Whole(0, 2) == 0;
    scene.Blend.Mode = dice.Whole(0, 3) == 0 ? BlendMode::Maximum : BlendMode::Composite;
    if (dice.Whole(0, 2) == 0)
    {
      scene.Viewport = { { 310, 500 }, { 2000, 2900 } };
    }
    Box zone = scene.DomainCells;
    if (dice.Whole(0, 1) == 0)
    {
      zone.Lo.x = dice.Whole(0, cells.x);
      zone.Hi.y = dice.Whole(0, cells.y);
    }
    auto source = std::make_unique<scenes::MadeUpBricks>(
      dice, cells, dice.Whole(0, 1) == 0 ? 16 : dice.Whole(3, 70));
    if (dice.Whole(0, 3) == 0)
    {
      const std::int64_t count = scene.DomainCells.Count();
      std::vector<std::uint8_t> flags(static_cast<std::size_t>(count), 1);
      std::fill(flags.begin() + count / 2, flags.end(), std::uint8_t{ 0 });
      const auto hidden = std::make_shared<HiddenCells>(cells);
      hidden->Hide(scene.DomainCells, flags.data(), 1);
      source->Hide(hidden);
    }
    return { std::move(source), scene, zone };
  }
};

/// What PlanBricks plans, as the slow, obvious loop finds it.
std::set<std::int64_t> PlannedSlowly(const LevelScene& level, const Box& zone)
{
  std::set<std::int64_t> bricks;
  const BrickSource& source = level.Source;
  const ValueMask bins = level.Scene.Transfer.VisibleBins(source.MasksAreOver());
  for (std::int64_t i = 0; i < Box{ glm::ivec3(0), source.Bricks() }.Count(); ++i)
  {
    const Box part = Intersection(source.CellsOf(i), zone);
    const ValueRange range = source.RangeOf(i);
    const bool seen = level.Projection() ? level.Projection()->HighestRank(range) > 0.0f
                                         : (source.MaskOf(i) & bins) != 0 &&
                                             level.Visible->Any(range.Low, range.High);
    if (!part.Empty() && seen && !source.AllHidden(i) && !IsCutAway(level.ClipPlanes, part) &&
        !Intersection(level.FootprintOf(part), level.Scene.Viewport).Empty())
    {
      bricks.insert(i);
    }
  }
  return bricks;
}

std::int64_t CountIn(const BrickSource& source, const Box& cells)
{
  std::int64_t count = 0;
  for (std::int64_t i = 0; i < Box{ glm::ivec3(0), source.Bricks() }.Count(); ++i)
  {
    count += Intersection(source.CellsOf(i), cells).Empty() ? 0 : 1;
  }
  return count;
}

TEST(BrickPlan, HasTheBricksThatALoopOverAllFinds)
{
  Dice dice(3);
  ThreadPool pool(2);
  std::size_t together = 0;
  std::size_t all = 0;
  std::size_t extras = 0;
  for (int i = 0; i < 150; ++i)
  {
    const Case some = Case::Random(dice);
    const LevelScene level(some.Scene, *some.Source);
    const BrickPlan plan = PlanBricks(level, some.Cells, NoLimit, pool);
    const std::set<std::int64_t> slowly = PlannedSlowly(level, some.Cells);
    std::set<std::int64_t> planned;
    std::size_t extra = 0; // drawn as one with others, of which the near plane leaves something
    PixelRect touched;
    for (const PlannedBrick& brick : plan.Bricks)
    {
      const bool several = !brick.Together.Empty();
      together += several ? 1 : 0;
      brick.ForEach(*some.Source,
        [&](std::int64_t number)
        {
          EXPECT_TRUE(planned.insert(number).second);
          extra += several && slowly.count(number) == 0 ? 1 : 0;
        });
      touched = Union(touched, brick.Footprint);
      EXPECT_EQ(
        brick.Footprint, Intersection(level.FootprintOf(brick.Drawn), level.Scene.Viewport));
      const bool oneValue = some.Source->IsMacroVoxel(brick.Number) && !level.IsShaded();
      EXPECT_EQ(brick.Entry.has_value(), oneValue && !level.Projection());
    }
    EXPECT_TRUE(std::includes(planned.begin(), planned.end(), slowly.begin(), slowly.end())) << i;
    EXPECT_EQ(planned.size(), slowly.size() + extra) << i;
    extras += extra;
    EXPECT_EQ(plan.Touched, touched);
    EXPECT_EQ(
      plan.Skipped + static_cast<std::int64_t>(planned.size()), CountIn(*some.Source, some.Cells));
    all += planned.size();
  }
  EXPECT_GT(together, 100u);
  EXPECT_GT(all, 10000u);
  EXPECT_LT(extras, all / 1000);
}

void ExpectSame(const BrickPlan& a, const BrickPlan& b)
{
  EXPECT_EQ(a.Touched, b.Touched);
  EXPECT_EQ(a.Skipped, b.Skipped);
  ASSERT_EQ(a.Bricks.size(), b.Bricks.size());
  for (std::size_t i = 0; i < a.Bricks.size(); ++i)
  {
    const PlannedBrick& first = a.Bricks[i];
    const PlannedBrick& second = b.Bricks[i];
    ASSERT_EQ(first.Number, second.Number);
    ASSERT_EQ(first.Together, second.Together);
    ASSERT_EQ(first.Cells, second.Cells);
    ASSERT_EQ(first.Drawn, second.Drawn);
    ASSERT_EQ(first.Footprint, second.Footprint);
    ASSERT_EQ(first.HighestRank, second.HighestRank);
    ASSERT_EQ(first.Entry, second.Entry);
  }
}

TEST(BrickPlan, IsSharedWhereItIsTheSame)
{
  Dice dice(6);
  ThreadPool pool(1);
  for (int i = 0; i < 40; ++i)
  {
    const Case some = Case::Random(dice);
    SharedPlans shared;
    std::set<std::shared_ptr<const BrickPlan>> plans;
    double distance = 1.0;
    const auto expectSame = [&](RayScene scene, const Box& cells, std::uint64_t budget)
    {
      scene.Samplings = std::make_shared<const TileSamplings>(
        scene.Camera.ImageSize(), std::vector{ RaySampling{ 0, distance } });
      const LevelScene level(scene, *some.Source);
      const std::shared_ptr<const BrickPlan> plan = shared.PlanOf(level, cells, budget, pool);
      ExpectSame(*plan, PlanBricks(level, cells, budget, pool));
      plans.insert(plan);
    };
    RayScene scene = some.Scene;
    const Box half{ some.Cells.Lo, glm::max(some.Cells.Hi / 2, some.Cells.Lo) };
    for (; distance < 9.0; distance *= 2.0)
    {
      expectSame(scene, some.Cells, NoLimit);
    }
    EXPECT_EQ(plans.size(), 1u);
    expectSame(scene, half, NoLimit);
    expectSame(scene, some.Cells, 100000);
    scene.Viewport = { { 1000, 700 }, { 1900, 2000 } };
    expectSame(scene, some.Cells, NoLimit);
    scene.Camera = scene.Camera.WithSize({ 3000, 2500 });
    expectSame(scene, some.Cells, NoLimit);
    scene.Camera = scene.Camera.InSpace(glm::translate(glm::dmat4(1.0), glm::dvec3(3, 2, 1)));
    expectSame(scene, some.Cells, NoLimit);
    scene.Transfer = scenes::Tabulate([](double v) { return glm::dvec4(1, 1, 1, 0.1 * v); });
    expectSame(scene, some.Cells, NoLimit);
    EXPECT_EQ(plans.size(), 7u);
  }
}

TEST(BrickPlan, IsOneForAllProbesOfAFrame)
{
  Dice dice(7);
  ThreadPool pool(1);
  const Case some = Case::Random(dice);
  std::set<std::shared_ptr<SharedPlans>> shared;
  const auto draw = [&](const RayScene& probe)
  {
    shared.insert(probe.Plans);
    RayStatistics statistics;
    const LevelCaster caster(probe, *some.Source, some.Cells, NoLimit, pool, statistics);
    const LevelScene level(probe, *some.Source);
    const auto plan = probe.Plans->PlanOf(level, some.Cells, NoLimit, pool);
    EXPECT_EQ(plan.use_count(), 3) << "here, in the caster, and where it is shared";
    FloatImage nothing;
    nothing.Rect = probe.Viewport;
    nothing.Pixels.assign(static_cast<std::size_t>(probe.Viewport.Count()), glm::vec4(0.0f));
    return nothing;
  };
  EXPECT_GT(PlanSamplings(some.Scene, { 1.0, 1.0 }, draw).Probes, 1);
  EXPECT_EQ(shared.size(), 1u);
}

TEST(BrickPlan, FitsIntoTheBytesThatItTakes)
{
  Dice dice(4);
  ThreadPool pool(1);
  int fits = 0;
  int tries = 0;
  for (int i = 0; i < 60; ++i)
  {
    const Case some = Case::Random(dice);
    const LevelScene level(some.Scene, *some.Source);
    const auto bytesWithin = [&](const Box& cells, std::uint64_t budget)
    {
      std::uint64_t bytes = 0;
      for (const PlannedBrick& brick : PlanBricks(level, cells, budget, pool).Bricks)
      {
        bytes += brick.BytesToDraw(*some.Source, level.IsShaded());
      }
      return bytes;
    };
    const std::uint64_t whole = bytesWithin(some.Cells, NoLimit);
    for (const std::uint64_t bytes : { whole, whole - std::min<std::uint64_t>(whole, 1), whole / 3,
           whole + whole / 20, 2 * whole })
    {
      // What is known of one zone must not be taken for another one's.
      for (const Box& cells : { some.Scene.DomainCells, some.Cells, some.Scene.DomainCells })
      {
        const bool expected = bytesWithin(cells, bytes) <= bytes;
        EXPECT_EQ(AllFits(level, cells, bytes), expected) << i;
        EXPECT_EQ(AllFits(level, cells, bytes), expected) << "as it is known: " << i;
        fits += expected ? 1 : 0;
        ++tries;
      }
    }
  }
  EXPECT_GT(fits, tries / 5);
  EXPECT_LT(fits, tries - tries / 5);
}

TEST(BrickPlan, VisibleBricksAreThoseThatALoopFinds)
{
  Dice dice(5);
  for (int i = 0; i < 150; ++i)
  {
    const Case some = Case::Random(dice);
    const BrickSource& source = *some.Source;
    const VisibleBricks visible(some.Scene, source);
    const BoxOnScreen screen(some.Scene, 64.0);
    const std::vector<glm::dvec4> planes =
      PlanesInIndexSpace(some.Scene.ClipPlanes, some.Scene.IndexToWorld);
    const bool sampled = some.Scene.Shading.On || some.Scene.Blend.Mode != BlendMode::Composite;
    std::vector<std::int64_t> loaded;
    VisibleSigns signs;
    BrickCosts blocks(some.Scene.DomainCells.Size(), 16);
    for (std::int64_t brick = 0; brick < Box{ glm::ivec3(0), source.Bricks() }.Count(); ++brick)
    {
      const Box own = source.CellsOf(brick);
      const Box part = Intersection(own, some.Cells);
      if (!visible.Contains(brick))
      {
        continue;
      }
      ++signs.Bricks;
      signs.Bins |= source.MaskOf(brick) & visible.Bins();
      blocks.Add(own, static_cast<double>(own.Count()));
      if (!part.Empty() && !IsCutAway(planes, part) && screen.MayShow(part) &&
          (sampled || !source.IsMacroVoxel(brick)))
      {
        loaded.push_back(brick);
      }
    }
    EXPECT_EQ(BricksToLoad(some.Scene, source, some.Cells), loaded) << i;
    EXPECT_EQ(SignsOf(some.Scene, source).Bricks, signs.Bricks) << i;
    EXPECT_EQ(SignsOf(some.Scene, source).Bins, signs.Bins) << i;
    const std::vector<float> parts =
      VisibleParts(some.Scene, source, some.Scene.DomainCells.Size(), 16);
    ASSERT_EQ(parts.size(), blocks.Values.size());
    for (std::size_t block = 0; block < parts.size(); ++block)
    {
      EXPECT_EQ(parts[block],
        static_cast<float>(
          blocks.Values[block] / static_cast<double>(blocks.PositionsOf(block).Count())));
    }
  }
}

} // namespace
