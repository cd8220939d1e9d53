// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Balance_ZoneDivision_h
#define banyan_Parallel_Balance_ZoneDivision_h

#include "Parallel/Balance/BrickCosts.h"
#include "Parallel/Balance/ZoneTree.h"

#include <algorithm>
#include <vector>

namespace banyan
{

/// Sums a number per rank up the tree.
inline std::vector<double> SumsOfNodes(const ZoneTree& tree, const std::vector<double>& ofRanks)
{
  std::vector<double> sums(tree.Nodes.size(), 0.0);
  for (std::size_t number = sums.size(); number-- > 0;)
  {
    const ZoneTree::Node& node = tree.Nodes[number];
    sums[number] = node.IsLeaf() ? ofRanks[static_cast<std::size_t>(node.FirstRank)]
                                 : sums[static_cast<std::size_t>(node.Below)] +
                                     sums[static_cast<std::size_t>(node.Above)];
  }
  return sums;
}

/// Gives the children of a node their parts of its zone.
inline void Cut(const Box& zone, const ZoneTree::Node& node, std::vector<Box>& zones)
{
  Box low = zone;
  Box high = zone;
  low.Hi[node.Axis] = high.Lo[node.Axis] = node.Plane;
  zones[static_cast<std::size_t>(node.Below)] = low;
  zones[static_cast<std::size_t>(node.Above)] = high;
}

/// Seconds of the slower side when a zone is cut at `plane`.
class Division
{
public:
  Division(const CostSums& costs, const Box& zone, int axis, int step, double speedBelow,
    double speedAbove)
    : Costs(costs)
    , Zone(zone)
    , Axis(axis)
    , Step(step)
    , SpeedBelow(speedBelow)
    , SpeedAbove(speedAbove)
    , Total(costs.In(zone))
  {
  }

  /// Whether it costs nothing where planes stand.
  bool IsFree() const { return !(this->Total > 1e-9 * this->Costs.Total()); }

  /// The plane with the least seconds of the slower side; of several the one nearest to `now`.
  int Best(int now) const
  {
    const int from = this->Zone.Lo[this->Axis];
    const int to = this->Zone.Hi[this->Axis];
    now = std::clamp(now, from, to);
    if (this->IsFree())
    {
      return now;
    }
    // The first plane below which is as much as the speeds are for, or more; in steps.
    const double wanted = this->Total * this->SpeedBelow / (this->SpeedBelow + this->SpeedAbove);
    int low = (from + this->Step - 1) / this->Step;
    int high = (to + this->Step - 1) / this->Step;
    while (low < high)
    {
      const int middle = low + (high - low) / 2;
      if (this->Below(std::min(middle * this->Step, to)) >= wanted)
      {
        high = middle;
      }
      else
      {
        low = middle + 1;
      }
    }
    int best = std::min(low * this->Step, to);
    const int before = (low - 1) * this->Step;
    if (before >= from && this->Slower(before) < this->Slower(best))
    {
      best = before;
    }
    return this->Slower(now) <= this->Slower(best) * (1.0 + 1e-9) ? now : best;
  }

  double Slower(int plane) const
  {
    const double below = this->Below(plane);
    return std::max(below / this->SpeedBelow, (this->Total - below) / this->SpeedAbove);
  }

private:
  double Below(int plane) const
  {
    Box below = this->Zone;
    below.Hi[this->Axis] = plane;
    return this->Costs.In(below);
  }

  const CostSums& Costs;
  Box Zone;
  int Axis;
  int Step;
  double SpeedBelow;
  double SpeedAbove;
  double Total;
};

} // namespace banyan

#endif
