// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/Rebalance.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace banyan
{
namespace
{

/// Costs that are high around a point.
BrickCosts Hill(const glm::ivec3& positions, int edge, const glm::dvec3& center, double width)
{
  BrickCosts costs(positions, edge);
  for (std::size_t i = 0; i < costs.Values.size(); ++i)
  {
    const Box box = costs.PositionsOf(i);
    const glm::dvec3 away = 0.5 * glm::dvec3(box.Lo + box.Hi) - center;
    costs.Values[i] =
      std::exp(-(away.x * away.x + away.y * away.y + away.z * away.z) / (width * width)) *
      static_cast<double>(box.Count());
  }
  return costs;
}

double SlowSum(const BrickCosts& costs, const Box& box)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < costs.Values.size(); ++i)
  {
    const Box brick = costs.PositionsOf(i);
    const Box common = Intersection(brick, box);
    sum += common.Empty() ? 0.0
                          : costs.Values[i] * static_cast<double>(common.Count()) /
                              static_cast<double>(brick.Count());
  }
  return sum;
}

double ImbalanceWith(
  const ZoneTree& tree, const BrickCosts& costs, const std::vector<double>& speeds)
{
  return ExpectedImbalance(tree, CostSums(costs), speeds);
}

TEST(CostSums, AreTheSumsOfParts)
{
  std::mt19937 random(1);
  for (int trial = 0; trial < 60; ++trial)
  {
    const glm::ivec3 size(random() % 19 + 1, random() % 17 + 1, random() % 13 + 1);
    BrickCosts costs(size, static_cast<int>(random() % 5 + 1));
    for (double& cost : costs.Values)
    {
      cost = random() % 3 == 0 ? 0.0 : static_cast<double>(random() % 1000);
    }
    const CostSums sums(costs);
    EXPECT_NEAR(sums.Total(), SlowSum(costs, { glm::ivec3(0), size }), 1e-6);
    for (int i = 0; i < 20; ++i)
    {
      Box box;
      for (int axis = 0; axis < 3; ++axis)
      {
        box.Lo[axis] = static_cast<int>(random() % (size[axis] + 1u));
        box.Hi[axis] = static_cast<int>(random() % (size[axis] + 1u));
      }
      EXPECT_NEAR(sums.In(box), box.Empty() ? 0.0 : SlowSum(costs, box), 1e-6);
    }
  }
}

TEST(CostSums, RefuseWhatIsNoCost)
{
  BrickCosts costs(glm::ivec3(4), 2);
  costs.Values[3] = -1.0;
  EXPECT_THROW(CostSums{ costs }, Error);
  costs.Values[3] = std::nan("");
  EXPECT_THROW(CostSums{ costs }, Error);
  costs.Values.pop_back();
  EXPECT_THROW(CostSums{ costs }, Error);
  EXPECT_THROW(BrickCosts(glm::ivec3(4), 0), Error);
  EXPECT_EQ(CostSums(BrickCosts(glm::ivec3(0, 3, 3), 2)).Total(), 0.0);
}

TEST(BrickCosts, SpreadWhatIsAddedOverBricks)
{
  BrickCosts costs({ 10, 9, 8 }, 4);
  costs.Add({ { 2, 0, 0 }, { 6, 4, 4 } }, 8.0);
  EXPECT_DOUBLE_EQ(costs.Values[0], 4.0);
  EXPECT_DOUBLE_EQ(costs.Values[1], 4.0);
  costs.Add({ { -5, -5, -5 }, { 99, 99, 99 } }, 720.0);
  EXPECT_DOUBLE_EQ(costs.Values[0], 4.0 + 64.0);
  EXPECT_DOUBLE_EQ(costs.Values[2], 32.0);
  costs.Add({ { 20, 20, 20 }, { 30, 30, 30 } }, 1.0);
  EXPECT_NEAR(CostSums(costs).Total(), 728.0, 1e-9);
}

TEST(MeasuredCost, BalancesAtOnceWherePositionsAreFine)
{
  for (int ranks = 2; ranks <= 64; ranks += ranks < 17 ? 1 : 9)
  {
    for (const glm::dvec3& center : { glm::dvec3(20, 80, 64), glm::dvec3(64, 64, 64) })
    {
      const BrickCosts costs = Hill(glm::ivec3(128), 8, center, 30.0);
      std::vector<double> speeds;
      for (int rank = 0; rank < ranks; ++rank)
      {
        speeds.push_back(rank % 3 == 0 ? 0.2 : 1.0);
      }
      const ZoneTree tree = CostZoneTree(costs, speeds);
      // A position is a smaller part of a zone the fewer zones there are.
      EXPECT_LT(ImbalanceWith(tree, costs, speeds), ranks <= 16 ? 1.10 : 1.25) << ranks;
      EXPECT_EQ(CostZoneTree(costs, speeds), tree);
    }
  }
}

TEST(MeasuredCost, IsAsGoodAsAnyTwoZones)
{
  std::mt19937 random(5);
  for (int trial = 0; trial < 100; ++trial)
  {
    BrickCosts costs({ static_cast<int>(random() % 30 + 2), 3, 2 }, 1);
    for (double& cost : costs.Values)
    {
      cost = random() % 2 == 0 ? 0.0 : static_cast<double>(random() % 100);
    }
    const std::vector<double> speeds{ 1.0 + random() % 4, 1.0 + random() % 4 };
    const ZoneTree found = CostZoneTree(costs, speeds);
    const auto slower = [&](const ZoneTree& tree)
    {
      const std::vector<double> seconds = ExpectedSeconds(tree, CostSums(costs), speeds);
      return std::max(seconds[0], seconds[1]);
    };
    double best = 1e300;
    for (int plane = 0; plane <= costs.Positions.x; ++plane)
    {
      ZoneTree tree = found;
      tree.Nodes.front().Axis = 0;
      tree.Nodes.front().Plane = plane;
      best = std::min(best, slower(tree));
    }
    if (found.Nodes.front().Axis == 0)
    {
      EXPECT_LE(slower(found), best * (1.0 + 1e-6));
    }
  }
}

TEST(MeasuredCost, StaysWhereItIsBalancedEnoughOrNothingIsGained)
{
  const ZoneTree tree = EqualZoneTree(glm::ivec3(64), 8);
  const std::vector<double> speeds(8, 1.0);
  BrickCosts even(glm::ivec3(64), 8);
  std::fill(even.Values.begin(), even.Values.end(), 1.0);
  EXPECT_EQ(RebalanceMeasuredCost(tree, even, speeds), tree);
  even.Values[0] = 3.0; // a little more: a slab is more
  EXPECT_EQ(RebalanceMeasuredCost(tree, even, speeds), tree);
  even.Values[0] = 30.0;
  EXPECT_NE(RebalanceMeasuredCost(tree, even, speeds), tree);
  EXPECT_EQ(RebalanceMeasuredCost(tree, even, speeds, 0.5), tree);
  // Nothing is drawn at all: nothing moves.
  EXPECT_EQ(RebalanceMeasuredCost(tree, BrickCosts(glm::ivec3(64), 8), speeds), tree);
}

TEST(MeasuredCost, MovesNoMoreBytesThanAllowedAndArrivesAllTheSame)
{
  const BrickCosts costs = Hill(glm::ivec3(128), 8, { 20, 100, 30 }, 25.0);
  const std::vector<double> speeds(16, 1.0);
  BrickCosts bytes(glm::ivec3(128), 8);
  for (std::size_t i = 0; i < bytes.Values.size(); ++i)
  {
    bytes.Values[i] = costs.Values[i] > 1e-3 ? 2048.0 : 0.0;
  }
  const CostSums sums(bytes);
  const double most = 0.1 * sums.Total();
  ZoneTree tree = EqualZoneTree(glm::ivec3(128), 16);
  double moved = 0.0;
  int frames = 0;
  while (ImbalanceWith(tree, costs, speeds) > 1.06 && frames < 30)
  {
    const ZoneTree next =
      WithinBytes(tree, RebalanceMeasuredCost(tree, costs, speeds), sums, most, 1);
    EXPECT_LE(MovedBetween(tree, next, sums), most);
    for (std::size_t number = 0; number < tree.Nodes.size(); ++number)
    {
      EXPECT_EQ(next.Nodes[number].Axis, tree.Nodes[number].Axis);
    }
    moved += MovedBetween(tree, next, sums);
    tree = next;
    ++frames;
  }
  EXPECT_GT(frames, 3);
  EXPECT_LE(frames, 20);
  EXPECT_GT(moved, 3.0 * most);
}

TEST(MeasuredCost, PlanesStandAtMultiplesOfTheStep)
{
  const glm::ivec3 size(125, 90, 77);
  const BrickCosts costs = Hill(size, 8, { 20, 70, 30 }, 25.0);
  BrickCosts bytes(size, 8);
  std::fill(bytes.Values.begin(), bytes.Values.end(), 1.0);
  const std::vector<double> speeds(7, 1.0);
  for (const int step : { 1, 4, 8, 16 })
  {
    const CostSums sums(bytes);
    const double most = (step == 16 ? 0.15 : 0.1) * sums.Total();
    ZoneTree tree = Refined(EqualZoneTree((size + 15) / 16, 7), 16, size);
    const double best =
      ImbalanceWith(RebalanceMeasuredCost(tree, costs, speeds, 0.0, step), costs, speeds);
    for (int frame = 0; frame < 40; ++frame)
    {
      tree =
        WithinBytes(tree, RebalanceMeasuredCost(tree, costs, speeds, 0.0, step), sums, most, step);
      const std::vector<Box> zones = NodeZones(tree);
      for (std::size_t number = 0; number < zones.size(); ++number)
      {
        const ZoneTree::Node& node = tree.Nodes[number];
        EXPECT_TRUE(node.IsLeaf() || node.Plane % step == 0 || node.Plane == size[node.Axis]);
        EXPECT_TRUE(node.IsLeaf() || (node.Plane >= zones[number].Lo[node.Axis] &&
                                       node.Plane <= zones[number].Hi[node.Axis]));
      }
    }
    EXPECT_LE(ImbalanceWith(tree, costs, speeds), (step < 16 ? 1.1 : 1.2) * best) << step;
  }
  EXPECT_THROW(
    RebalanceMeasuredCost(EqualZoneTree(size, 2), BrickCosts(size, 8), { 1, 1 }, 0.0, 0), Error);
}

TEST(MeasuredCost, RefusesWhatDoesNotFitTogether)
{
  const ZoneTree tree = EqualZoneTree(glm::ivec3(8), 3);
  const BrickCosts costs(glm::ivec3(8), 2);
  EXPECT_THROW(RebalanceMeasuredCost(tree, costs, { 1, 1 }), Error);
  EXPECT_THROW(RebalanceMeasuredCost(tree, costs, { 1, 1, 0 }), Error);
  EXPECT_THROW(RebalanceMeasuredCost(tree, costs, { 1, 1, std::nan("") }), Error);
  EXPECT_THROW(RebalanceMeasuredCost(tree, BrickCosts(glm::ivec3(9), 2), { 1, 1, 1 }), Error);
}

TEST(ImbalanceOf, IsLargestOverMean)
{
  EXPECT_DOUBLE_EQ(ImbalanceOf({ 1, 1, 4 }), 2.0);
  EXPECT_DOUBLE_EQ(ImbalanceOf({ 0, 0 }), 1.0);
  EXPECT_DOUBLE_EQ(ImbalanceOf({}), 1.0);
}

} // namespace
} // namespace banyan
