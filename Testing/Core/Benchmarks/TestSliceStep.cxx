// SPDX-License-Identifier: BSD-3-Clause
#include "SliceStep.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

namespace banyan::bench
{
namespace
{

TEST(SliceStep, MovesEachPlaneOneSliceTowardsTheCostlierChild)
{
  // The paper's tree of eight; ranks 0 to 7 from the lowest corner on.
  const ZoneTree tree = EqualZoneTree(glm::ivec3(16), 8);
  const std::vector<double> seconds{ 4, 1, 2, 2, 3, 3, 9, 0 };
  const ZoneTree next = RebalanceSliceStep(tree, seconds);
  for (std::size_t number = 0; number < tree.Nodes.size(); ++number)
  {
    const ZoneTree::Node& node = tree.Nodes[number];
    EXPECT_EQ(next.Nodes[number].Axis, node.Axis);
    double below = 0.0;
    double above = 0.0;
    for (int rank = node.FirstRank; rank < node.FirstRank + node.Ranks && !node.IsLeaf(); ++rank)
    {
      (rank < tree.Nodes[node.Above].FirstRank ? below : above) += seconds[rank];
    }
    const int step = below > above ? -1 : below < above ? 1 : 0;
    EXPECT_EQ(next.Nodes[number].Plane, node.Plane + step) << number;
  }
}

TEST(SliceStep, ComparesSecondsPerRank)
{
  const ZoneTree tree = EqualZoneTree({ 12, 1, 1 }, 3); // two ranks on one side of the root
  const ZoneTree::Node& root = tree.Nodes.front();
  const ZoneTree same = RebalanceSliceStep(tree, { 2, 2, 2 });
  EXPECT_EQ(same, tree);
  const int first = tree.Nodes[root.Below].Ranks == 1 ? 0 : 2;
  std::vector<double> seconds(3, 2.0);
  seconds[first] = 3.0;
  EXPECT_EQ(
    RebalanceSliceStep(tree, seconds).Nodes.front().Plane, root.Plane + (first == 0 ? -1 : 1));
  EXPECT_THROW(RebalanceSliceStep(tree, { 1, 2 }), Error);
  EXPECT_THROW(RebalanceSliceStep(tree, seconds, 0), Error);
}

TEST(SliceStep, NeverLosesAZone)
{
  for (const int ranks : { 2, 3, 5, 8, 13 })
  {
    ZoneTree tree = EqualZoneTree(glm::ivec3(16, 12, 9), ranks);
    for (int frame = 0; frame < 60; ++frame)
    {
      std::vector<double> seconds(static_cast<std::size_t>(ranks), 0.0);
      seconds[static_cast<std::size_t>(frame / 30 % ranks)] = 1.0;
      tree = RebalanceSliceStep(tree, seconds);
      for (const Box& zone : ZonesOf(tree))
      {
        EXPECT_FALSE(zone.Empty());
      }
    }
  }
  // Where there is no room, zones stay nested.
  ZoneTree tree = EqualZoneTree({ 2, 1, 1 }, 5);
  for (int frame = 0; frame < 20; ++frame)
  {
    tree = RebalanceSliceStep(tree, { 0, 0, 1, 5, 0 });
    std::int64_t count = 0;
    for (const Box& zone : ZonesOf(tree))
    {
      count += zone.Count();
    }
    EXPECT_EQ(count, 2);
  }
}

} // namespace
} // namespace banyan::bench
