// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/BrickPlan.h"

#include "Base/Hash.h"
#include "Base/ThreadPool.h"
#include "Render/Levels/BrickPlanner.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace banyan
{
namespace
{

/// Groups that a thread plans in one go.
constexpr std::size_t GroupsTogether = 64;

/// One plan of parts one behind the other. Takes what the parts have.
BrickPlan PutTogether(std::vector<BrickPlan>& parts)
{
  if (parts.size() == 1)
  {
    return std::move(parts.front());
  }
  BrickPlan plan;
  std::size_t count = 0;
  for (const BrickPlan& part : parts)
  {
    count += part.Bricks.size();
  }
  plan.Bricks.reserve(count);
  for (const BrickPlan& part : parts)
  {
    plan.Bricks.insert(plan.Bricks.end(), part.Bricks.begin(), part.Bricks.end());
    plan.Touched = Union(plan.Touched, part.Touched);
  }
  return plan;
}

} // namespace

BrickPlan PlanBricks(
  const LevelScene& level, const Box& cells, std::uint64_t budgetBytes, ThreadPool& pool)
{
  const BrickPlanner planner(level, cells, budgetBytes, 0);
  std::vector<Box> groups;
  planner.ForGroups(
    [&](const Box& bricks, const Within&)
    {
      groups.push_back(bricks);
      return true;
    });
  // A thread alone plans all of them in one go: then nothing has to be put together.
  const std::size_t together =
    pool.Width() > 1 ? GroupsTogether : std::max<std::size_t>(groups.size(), 1);
  std::vector<BrickPlan> parts((groups.size() + together - 1) / together);
  pool.ParallelFor(static_cast<std::int64_t>(parts.size()),
    [&](std::int64_t number)
    {
      BrickPlan& part = parts[static_cast<std::size_t>(number)];
      const std::size_t begin = static_cast<std::size_t>(number) * together;
      const Box* const first = groups.data() + begin;
      const Box* const last = first + std::min(together, groups.size() - begin);
      part.Bricks.reserve(std::accumulate(first, last, std::size_t{ 0 },
        [&](std::size_t sum, const Box& group) { return sum + planner.AboutHowMany(group); }));
      std::for_each(first, last, [&](const Box& group) { planner.PlanGroup(group, part); });
    });
  BrickPlan plan = PutTogether(parts);
  plan.Skipped = planner.CountAll();
  for (const PlannedBrick& brick : plan.Bricks)
  {
    plan.Skipped -= brick.Count();
  }
  // The best values come first: bricks that cannot beat them are then never loaded. Averages are
  // added up front to back, so that they round alike in bricks of all sizes.
  if (level.Projection() && !level.Projection()->Averages())
  {
    std::stable_sort(plan.Bricks.begin(), plan.Bricks.end(),
      [](const PlannedBrick& a, const PlannedBrick& b) { return a.HighestRank > b.HighestRank; });
  }
  return plan;
}

bool AllFits(const LevelScene& level, const Box& cells, std::uint64_t bytes)
{
  const std::uint64_t dependsOn[] = { bytes, level.IsShaded() ? 1u : 0u };
  const BrickPlanner planner(
    level, cells, bytes, std::max<std::uint64_t>(HashOf(dependsOn, sizeof(dependsOn)).Low, 1));
  const BrickPlanner withoutScreen = planner.WithoutScreen();
  std::uint64_t all = 0;
  planner.ForGroups(
    [&](const Box& bricks, const Within& within)
    {
      all +=
        planner.KnowsBytesOf(within) ? withoutScreen.KnownBytesOf(bricks) : planner.BytesOf(bricks);
      return all <= bytes;
    });
  return all <= bytes;
}

} // namespace banyan
