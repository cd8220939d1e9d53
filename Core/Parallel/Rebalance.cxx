// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Rebalance.h"

#include "Base/Error.h"
#include "Parallel/ZoneDivision.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace banyan
{
namespace
{

using Node = ZoneTree::Node;

void CheckRanks(const ZoneTree& tree, std::size_t ranks)
{
  if (tree.Ranks() != static_cast<int>(ranks))
  {
    throw Error("The zones are those of another number of ranks.",
      { {}, {}, static_cast<std::uint64_t>(tree.Ranks()), ranks });
  }
}

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

/// Every plane where it balances, without limits.
ZoneTree BalancedTree(
  const ZoneTree& tree, const CostSums& costs, const std::vector<double>& speeds, int step)
{
  const std::vector<double> speedOf = SumsOfNodes(tree, speeds);
  ZoneTree balanced = tree;
  std::vector<Box> zones(tree.Nodes.size());
  zones.front() = tree.Whole();
  for (std::size_t number = 0; number < zones.size(); ++number)
  {
    Node& node = balanced.Nodes[number];
    if (!node.IsLeaf())
    {
      const Division division(costs, zones[number], node.Axis, step,
        speedOf[static_cast<std::size_t>(node.Below)],
        speedOf[static_cast<std::size_t>(node.Above)]);
      node.Plane = division.Best(node.Plane);
      Cut(zones[number], node, zones);
    }
  }
  return balanced;
}

/// As far as `most` bytes go.
ZoneTree WithinBytes(const ZoneTree& from, const ZoneTree& to, const CostSums& bytes, double most,
  int step, double& moved)
{
  moved = MovedBetween(from, to, bytes);
  if (moved <= most)
  {
    return to;
  }
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 12; ++i)
  {
    const double middle = 0.5 * (low + high);
    (MovedBetween(from, PartOfTheWay(from, to, middle, step), bytes) <= most ? low : high) = middle;
  }
  // Where even the first step of all planes is too much, `from`.
  ZoneTree tree = low > 0.0 ? PartOfTheWay(from, to, low, step) : from;
  moved = MovedBetween(from, tree, bytes);
  return tree;
}

/// One plane by one step towards `to`: the first from the root on for which `most` bytes are
/// enough.
ZoneTree OnePlaneAStep(
  const ZoneTree& from, const ZoneTree& to, const CostSums& bytes, double most, int step)
{
  for (std::size_t number = 0; number < from.Nodes.size(); ++number)
  {
    const int way = to.Nodes[number].Plane - from.Nodes[number].Plane;
    const int length = std::min(std::abs(way), step);
    ZoneTree tree = from;
    tree.Nodes[number].Plane += way > 0 ? length : -length;
    KeepApart(tree, 0);
    if (way != 0 && MovedBetween(from, tree, bytes) <= most)
    {
      return tree;
    }
  }
  return from;
}

} // namespace

ZoneTree PartOfTheWay(const ZoneTree& from, const ZoneTree& to, double part, int step)
{
  ZoneTree tree = from;
  for (std::size_t number = 0; number < tree.Nodes.size(); ++number)
  {
    const int way = to.Nodes[number].Plane - from.Nodes[number].Plane;
    // Rounded down on both sides alike: planes that do not cross before do not cross afterwards.
    const double steps = std::floor((tree.Nodes[number].Plane + part * way) / step);
    tree.Nodes[number].Plane = static_cast<int>(steps) * step;
  }
  return tree;
}

double ImbalanceOf(const std::vector<double>& seconds)
{
  double sum = 0.0;
  double largest = 0.0;
  for (const double value : seconds)
  {
    sum += value;
    largest = std::max(largest, value);
  }
  return sum > 0.0 ? largest * static_cast<double>(seconds.size()) / sum : 1.0;
}

ZoneTree RebalanceSliceStep(const ZoneTree& tree, const std::vector<double>& rankSeconds, int slice)
{
  CheckRanks(tree, rankSeconds.size());
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

Rebalanced RebalanceMeasuredCost(const ZoneTree& tree, const BrickCosts& costs,
  const std::vector<double>& speeds, const RebalanceLimits& limits)
{
  CheckRanks(tree, speeds.size());
  if (costs.Positions != tree.Positions ||
      (limits.Bytes && limits.Bytes->Positions != tree.Positions))
  {
    throw Error("The costs are those of another grid than the zones.");
  }
  if (std::any_of(speeds.begin(), speeds.end(),
        [](double speed) { return !(speed > 0.0) || !std::isfinite(speed); }))
  {
    throw Error("The speed of a rank is not a positive number.");
  }
  if (limits.PlaneStep < 1)
  {
    throw Error("Planes move by at least one position.");
  }
  const CostSums sums(costs);
  Rebalanced result{ tree };
  result.Before = result.After = ExpectedImbalance(tree, sums, speeds);
  if (result.Before <= limits.Tolerated)
  {
    return result;
  }
  double moved = 0.0;
  const ZoneTree target = BalancedTree(tree, sums, speeds, limits.PlaneStep);
  if (result.Before - ExpectedImbalance(target, sums, speeds) < limits.LeastGain)
  {
    return result;
  }
  ZoneTree balanced = target;
  if (limits.Bytes)
  {
    balanced =
      WithinBytes(tree, target, CostSums(*limits.Bytes), limits.MostBytes, limits.PlaneStep, moved);
  }
  if (limits.Bytes && balanced == tree)
  {
    const CostSums bytes(*limits.Bytes);
    balanced = OnePlaneAStep(tree, target, bytes, limits.MostBytes, limits.PlaneStep);
    moved = MovedBetween(tree, balanced, bytes);
  }
  result.Tree = std::move(balanced);
  result.After = ExpectedImbalance(result.Tree, sums, speeds);
  result.BytesMoved = moved;
  return result;
}

ZoneTree CostZoneTree(const BrickCosts& costs, const std::vector<double>& speeds)
{
  RebalanceLimits limits;
  limits.Tolerated = 1.0;
  limits.LeastGain = 0.0;
  const ZoneTree equal = EqualZoneTree(costs.Positions, static_cast<int>(speeds.size()));
  return RebalanceMeasuredCost(equal, costs, speeds, limits).Tree;
}

std::vector<double> ExpectedSeconds(
  const ZoneTree& tree, const CostSums& costs, const std::vector<double>& speeds)
{
  std::vector<double> seconds;
  const std::vector<Box> zones = ZonesOf(tree);
  for (std::size_t rank = 0; rank < zones.size(); ++rank)
  {
    seconds.push_back(costs.In(zones[rank]) / speeds[rank]);
  }
  return seconds;
}

double ExpectedImbalance(
  const ZoneTree& tree, const CostSums& costs, const std::vector<double>& speeds)
{
  double slowest = 0.0;
  double total = 0.0;
  double speed = 0.0;
  const std::vector<double> seconds = ExpectedSeconds(tree, costs, speeds);
  for (std::size_t rank = 0; rank < seconds.size(); ++rank)
  {
    slowest = std::max(slowest, seconds[rank]);
    total += seconds[rank] * speeds[rank];
    speed += speeds[rank];
  }
  return total > 0.0 ? slowest * speed / total : 1.0;
}

double MovedBetween(const ZoneTree& from, const ZoneTree& to, const CostSums& bytes)
{
  const std::vector<Box> before = ZonesOf(from);
  const std::vector<Box> after = ZonesOf(to);
  double moved = 0.0;
  for (std::size_t rank = 0; rank < after.size(); ++rank)
  {
    moved += bytes.In(after[rank]) - bytes.In(Intersection(after[rank], before[rank]));
  }
  return moved;
}

} // namespace banyan
