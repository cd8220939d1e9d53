// SPDX-License-Identifier: BSD-3-Clause
#include "SliceStep.h"

#include "Base/Error.h"
#include "Parallel/Balance/ZoneDivision.h"

#include <algorithm>

namespace banyan::bench
{
namespace
{

using Node = ZoneTree::Node;

/// Positions along each axis that the zones under each node need to be `slice` thick.
std::vector<glm::ivec3> NeededSizes(const ZoneTree& tree, int slice)
{
  std::vector<glm::ivec3> needed(tree.Nodes.size(), glm::ivec3(slice));
  for (std::size_t number = needed.size(); number-- > 0;)
  {
    const Node& node = tree.Nodes[number];
    if (!node.IsLeaf())
    {
      const glm::ivec3 below = needed[static_cast<std::size_t>(node.Below)];
      const glm::ivec3 above = needed[static_cast<std::size_t>(node.Above)];
      needed[number] = glm::max(below, above);
      needed[number][node.Axis] = below[node.Axis] + above[node.Axis];
    }
  }
  return needed;
}

/// Puts planes back into their zones, so far from the edges that all zones have room.
void KeepApart(ZoneTree& tree, int slice)
{
  const std::vector<glm::ivec3> needed = NeededSizes(tree, slice);
  std::vector<Box> zones(tree.Nodes.size());
  zones.front() = tree.Whole();
  for (std::size_t number = 0; number < zones.size(); ++number)
  {
    Node& node = tree.Nodes[number];
    if (node.IsLeaf())
    {
      continue;
    }
    const Box& zone = zones[number];
    const int low = zone.Lo[node.Axis] + needed[static_cast<std::size_t>(node.Below)][node.Axis];
    const int high = zone.Hi[node.Axis] - needed[static_cast<std::size_t>(node.Above)][node.Axis];
    node.Plane = low <= high ? std::clamp(node.Plane, low, high)
                             : std::clamp(node.Plane, zone.Lo[node.Axis], zone.Hi[node.Axis]);
    Cut(zone, node, zones);
  }
}

} // namespace

ZoneTree RebalanceSliceStep(const ZoneTree& tree, const std::vector<double>& rankSeconds, int slice)
{
  if (tree.Ranks() != static_cast<int>(rankSeconds.size()))
  {
    throw Error("The zones are those of another number of ranks.");
  }
  if (slice < 1)
  {
    throw Error("A plane moves by at least one position.");
  }
  const std::vector<double> cost = SumsOfNodes(tree, rankSeconds);
  ZoneTree moved = tree;
  for (Node& node : moved.Nodes)
  {
    if (node.IsLeaf())
    {
      continue;
    }
    const auto below = static_cast<std::size_t>(node.Below);
    const auto above = static_cast<std::size_t>(node.Above);
    const double perRankBelow = cost[below] / tree.Nodes[below].Ranks;
    const double perRankAbove = cost[above] / tree.Nodes[above].Ranks;
    node.Plane += perRankBelow > perRankAbove ? -slice : perRankBelow < perRankAbove ? slice : 0;
  }
  if (!moved.Nodes.empty())
  {
    KeepApart(moved, slice);
  }
  return moved;
}

} // namespace banyan::bench
