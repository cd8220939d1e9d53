// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/Rebalance.h"

#include "Base/Error.h"
#include "Parallel/Balance/ZoneDivision.h"

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

/// Puts planes back into their zones.
void KeepNested(ZoneTree& tree)
{
  std::vector<Box> zones(tree.Nodes.size());
  zones.front() = tree.Whole();
  for (std::size_t number = 0; number < zones.size(); ++number)
  {
    Node& node = tree.Nodes[number];
    if (!node.IsLeaf())
    {
      const Box& zone = zones[number];
      node.Plane = std::clamp(node.Plane, zone.Lo[node.Axis], zone.Hi[node.Axis]);
      Cut(zone, node, zones);
    }
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

/// Whether two trees differ in nothing but where planes stand.
bool AxesAgree(const ZoneTree& a, const ZoneTree& b)
{
  ZoneTree same = a;
  for (std::size_t number = 0; number < same.Nodes.size() && number < b.Nodes.size(); ++number)
  {
    same.Nodes[number].Plane = b.Nodes[number].Plane;
  }
  return same == b;
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
    KeepNested(tree);
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

ZoneTree WithinBytes(
  const ZoneTree& from, const ZoneTree& to, const CostSums& bytes, double most, int step)
{
  if (MovedBetween(from, to, bytes) <= most || !AxesAgree(from, to))
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
  // Where even the first step of all planes is too much, that of one.
  ZoneTree tree = low > 0.0 ? PartOfTheWay(from, to, low, step) : from;
  return tree == from ? OnePlaneAStep(from, to, bytes, most, step) : tree;
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

ZoneTree RebalanceMeasuredCost(const ZoneTree& tree, const BrickCosts& costs,
  const std::vector<double>& speeds, double leastGain, int step)
{
  CheckRanks(tree, speeds.size());
  if (costs.Positions != tree.Positions)
  {
    throw Error("The costs are those of another grid than the zones.");
  }
  if (std::any_of(speeds.begin(), speeds.end(),
        [](double speed) { return !(speed > 0.0) || !std::isfinite(speed); }))
  {
    throw Error("The speed of a rank is not a positive number.");
  }
  if (step < 1)
  {
    throw Error("Planes move by at least one position.");
  }
  const CostSums sums(costs);
  ZoneTree target = BalancedTree(tree, sums, speeds, step);
  const double gain =
    ExpectedImbalance(tree, sums, speeds) - ExpectedImbalance(target, sums, speeds);
  return gain > 0.0 && gain >= leastGain ? target : tree;
}

ZoneTree CostZoneTree(const BrickCosts& costs, const std::vector<double>& speeds)
{
  const ZoneTree equal = EqualZoneTree(costs.Positions, static_cast<int>(speeds.size()));
  return RebalanceMeasuredCost(equal, costs, speeds);
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
