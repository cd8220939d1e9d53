// SPDX-License-Identifier: BSD-3-Clause
// Who sends what when pieces are gathered.
#include "Parallel/Composite/GatherPlan.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

namespace banyan
{
namespace
{

using Position = std::tuple<int, int, int>;

/// How often each sample occurs.
std::map<Position, int> Count(const std::vector<Box>& boxes)
{
  std::map<Position, int> counts;
  for (const Box& box : boxes)
  {
    for (int z = box.Lo.z; z < box.Hi.z; ++z)
    {
      for (int y = box.Lo.y; y < box.Hi.y; ++y)
      {
        for (int x = box.Lo.x; x < box.Hi.x; ++x)
        {
          ++counts[{ x, y, z }];
        }
      }
    }
  }
  return counts;
}

Box RandomBox(std::mt19937& random, int size)
{
  Box box;
  for (int axis = 0; axis < 3; ++axis)
  {
    box.Lo[axis] = static_cast<int>(random() % static_cast<unsigned>(size));
    box.Hi[axis] = box.Lo[axis] + static_cast<int>(random() % static_cast<unsigned>(size));
  }
  return box;
}

TEST(GatherPlan, SubtractLeavesExactlyTheRest)
{
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i)
  {
    const Box box = RandomBox(random, 6);
    const Box hole = RandomBox(random, 6);
    const std::vector<Box> left = Subtract(box, hole);
    EXPECT_LE(left.size(), 6u);
    const auto counts = Count(left);
    for (const auto& [position, count] : Count({ box }))
    {
      const glm::ivec3 p(std::get<0>(position), std::get<1>(position), std::get<2>(position));
      EXPECT_EQ(counts.count(position), hole.Contains(p) ? 0u : 1u);
    }
    for (const auto& [position, count] : counts)
    {
      EXPECT_EQ(count, 1);
    }
  }
}

TEST(GatherPlan, TakesEachSampleOnceFromARankThatHasIt)
{
  std::mt19937 random(6);
  for (int i = 0; i < 100; ++i)
  {
    const Box whole{ glm::ivec3(-1), glm::ivec3(6, 7, 8) };
    std::vector<Box> pieces;
    for (int rank = 0; rank < 5; ++rank)
    {
      pieces.push_back(RandomBox(random, 9)); // some empty, some beyond the whole
    }
    const GatherPlan plan = PlanGathering(whole, pieces);
    std::vector<Box> all = plan.Missing;
    for (const GatherPlan::Part& part : plan.Parts)
    {
      EXPECT_FALSE(part.Samples.Empty());
      EXPECT_TRUE(pieces[static_cast<std::size_t>(part.Rank)].Contains(part.Samples));
      all.push_back(part.Samples);
    }
    const auto counts = Count(all);
    EXPECT_EQ(static_cast<std::int64_t>(counts.size()), whole.Count());
    for (const auto& [position, count] : counts)
    {
      EXPECT_EQ(count, 1);
    }
    const auto covered = Count(pieces);
    for (const auto& [position, count] : Count(plan.Missing))
    {
      EXPECT_EQ(covered.count(position), 0u) << "missing although somebody has it";
    }
  }
}

TEST(GatherPlan, NeighboursThatShareALayer)
{
  const Box whole{ glm::ivec3(0), glm::ivec3(9, 4, 4) };
  const GatherPlan plan =
    PlanGathering(whole, { { { 0, 0, 0 }, { 5, 4, 4 } }, {}, { { 4, 0, 0 }, { 9, 4, 4 } } });
  ASSERT_EQ(plan.Parts.size(), 2u);
  EXPECT_EQ(plan.Parts[0].Rank, 0);
  EXPECT_EQ(plan.Parts[1].Rank, 2);
  EXPECT_EQ(plan.Parts[1].Samples.Lo.x, 5);
  EXPECT_TRUE(plan.Missing.empty());
}

TEST(GatherPlan, EverybodyHasEverything)
{
  const Box whole{ glm::ivec3(0), glm::ivec3(3) };
  const GatherPlan plan = PlanGathering(whole, { whole, whole, whole });
  ASSERT_EQ(plan.Parts.size(), 1u);
  EXPECT_EQ(plan.Parts[0].Rank, 0);
}

} // namespace
} // namespace banyan
