// SPDX-License-Identifier: BSD-3-Clause
// Planes for a view that rests: what zones do is known to the test, and the search is told what
// ranks would measure.
#include "Parallel/TreeSearch.h"

#include "Parallel/Rebalance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace banyan
{
namespace
{

constexpr int Cells = 64;
constexpr int Edge = 16;

/// Work at one side of the blocks that count it, so that a block says nothing of where.
BrickCosts Fine()
{
  BrickCosts costs(glm::ivec3(Cells), 1);
  for (std::size_t i = 0; i < costs.Values.size(); ++i)
  {
    const glm::ivec3 at = costs.PositionsOf(i).Lo;
    const glm::ivec3 inside = at % Edge;
    costs.Values[i] = std::exp(-0.15 * (inside.x + inside.y + inside.z) - 0.02 * at.x);
  }
  return costs;
}

BrickCosts Blocks(const BrickCosts& fine)
{
  BrickCosts blocks(fine.Positions, Edge);
  for (std::size_t i = 0; i < fine.Values.size(); ++i)
  {
    blocks.Add(fine.PositionsOf(i), fine.Values[i]);
  }
  return blocks;
}

/// What ranks do: a zone's own work, and as much again of what zones below it in z no longer hide.
std::vector<double> WorkOf(const ZoneTree& tree, const CostSums& sums)
{
  std::vector<double> work;
  for (const Box& zone : ZonesOf(tree))
  {
    Box slab = zone;
    slab.Hi.z = std::min(slab.Hi.z, slab.Lo.z + 6);
    work.push_back(sums.In(zone) + sums.In(slab));
  }
  return work;
}

class EverySearch : public ::testing::TestWithParam<int>
{
};

TEST_P(EverySearch, EndsWithTheBestTreeThatWasMeasuredAndStays)
{
  const int ranks = GetParam();
  const BrickCosts fine = Fine();
  const CostSums sums(fine);
  const BrickCosts blocks = Blocks(fine);
  const std::vector<double> speeds(static_cast<std::size_t>(ranks), 1.0);
  ZoneTree tree = CostZoneTree(blocks, speeds);
  const double first = ImbalanceOf(WorkOf(tree, sums));
  ASSERT_GT(first, 1.1) << "the model would do";
  TreeSearch search;
  double least = 1e300;
  ZoneTree last = tree;
  int moved = 0;
  for (int frame = 0; frame < 40; ++frame)
  {
    const std::vector<double> work = WorkOf(tree, sums);
    least = std::min(least, *std::max_element(work.begin(), work.end()));
    search.Measured(tree, work);
    last = tree;
    tree = search.Next(blocks, speeds, 1).value_or(tree);
    moved = tree != last ? frame : moved;
  }
  const std::vector<double> work = WorkOf(tree, sums);
  EXPECT_EQ(*std::max_element(work.begin(), work.end()), least);
  EXPECT_LT(ImbalanceOf(work), 1.0 + 0.5 * (first - 1.0));
  EXPECT_LE(moved, 20);
}

INSTANTIATE_TEST_SUITE_P(Ranks, EverySearch, ::testing::Values(3, 5, 8));

TEST(TreeSearch, DoesNotBeginWhereFramesAreNeverTheSame)
{
  const BrickCosts blocks = Blocks(Fine());
  const std::vector<double> speeds(4, 1.0);
  const ZoneTree tree = CostZoneTree(blocks, speeds);
  TreeSearch search;
  int asked = 0;
  for (int frame = 0; frame < 200; ++frame)
  {
    std::vector<double> work(4, 1.0);
    work[static_cast<std::size_t>(frame % 4)] = 2.0;
    search.Measured(tree, work);
    const std::optional<ZoneTree> next = search.Next(blocks, speeds, 1);
    asked += next ? 1 : 0;
    EXPECT_EQ(next.value_or(tree), tree) << frame;
  }
  EXPECT_LE(asked, 10) << "it waits ever longer";
}

TEST(TreeSearch, LeavesItToOthersWhileTheirTreesGetMuchBetterAndReturnsToTheBest)
{
  const BrickCosts blocks = Blocks(Fine());
  const std::vector<double> speeds(2, 1.0);
  const auto treeAt = [&](int plane)
  {
    ZoneTree tree = CostZoneTree(blocks, speeds);
    tree.Nodes.front().Plane = plane;
    return tree;
  };
  TreeSearch search;
  // The slower rank takes less and less, and then a little less only.
  const double slower[] = { 8.0, 6.0, 4.5, 4.4 };
  for (int frame = 0; frame < 4; ++frame)
  {
    search.Measured(treeAt(10 + frame), { slower[frame], 1.0 });
    EXPECT_EQ(search.Next(blocks, speeds, 1).has_value(), frame == 3) << frame;
  }
  search.Forget();
  search.Measured(treeAt(10), { 4.0, 1.0 });
  EXPECT_FALSE(search.Next(blocks, speeds, 1));
  search.Measured(treeAt(11), { 7.0, 1.0 });
  EXPECT_EQ(search.Next(blocks, speeds, 1), treeAt(10)) << "the last one was worse";
}

TEST(TreeSearch, LeavesItToOthersAtOnceWhenARankBecomesSlowerWhateverItIsAt)
{
  const BrickCosts fine = Fine();
  const CostSums sums(fine);
  const BrickCosts blocks = Blocks(fine);
  for (int slowFrom = 1; slowFrom < 40; ++slowFrom)
  {
    std::vector<double> speeds(4, 1.0);
    ZoneTree tree = CostZoneTree(blocks, speeds);
    TreeSearch search;
    for (int frame = 0; frame < slowFrom; ++frame)
    {
      search.Measured(tree, WorkOf(tree, sums));
      tree = search.Next(blocks, speeds, 1).value_or(tree);
    }
    speeds[1] = 0.5;
    search.Measured(tree, WorkOf(tree, sums));
    EXPECT_FALSE(search.Next(blocks, speeds, 1)) << "after " << slowFrom << " frames";
  }
}

/// Frames of other values each, then the same ones: how many of these until another tree is tried.
int FramesUntilItTries(bool told)
{
  const BrickCosts fine = Fine();
  const CostSums sums(fine);
  const BrickCosts blocks = Blocks(fine);
  const std::vector<double> speeds(5, 1.0);
  const ZoneTree tree = CostZoneTree(blocks, speeds);
  TreeSearch search;
  for (int frame = 0; frame < 200; ++frame)
  {
    const bool plays = frame < 60;
    if (plays && told)
    {
      search.Forget();
    }
    if (search.Next(blocks, speeds, 1).value_or(tree) != tree)
    {
      return frame - 60;
    }
    std::vector<double> work = WorkOf(tree, sums);
    work[static_cast<std::size_t>(std::min(frame, 59) % 5)] *= 2.0;
    search.Measured(tree, work);
  }
  return 200;
}

TEST(TreeSearch, BeginsAtOnceAfterValuesThatItWasToldOf)
{
  const int told = FramesUntilItTries(true);
  EXPECT_GE(told, 0);
  EXPECT_LE(told, 6);
  EXPECT_GT(FramesUntilItTries(false), 10) << "it waits for frames that are the same";
}

TEST(TreeSearch, KnowsNothingOfAViewThatItForgot)
{
  const BrickCosts blocks = Blocks(Fine());
  const std::vector<double> speeds(2, 1.0);
  const ZoneTree tree = EqualZoneTree(blocks.Positions, 2);
  TreeSearch search;
  search.Measured(tree, { 1.0, 2.0 });
  search.Forget();
  EXPECT_FALSE(search.Next(blocks, speeds, 1));
}

} // namespace
} // namespace banyan
