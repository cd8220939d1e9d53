// SPDX-License-Identifier: BSD-3-Clause
// Steps of single planes, where the search knows no better tree.
#include "Parallel/TreeSearch.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// Logarithms of ratios for which planes go one step when all do.
constexpr double StepAbove = 0.08;

bool PlanesAreInTheirZones(const ZoneTree& tree)
{
  const std::vector<Box> zones = NodeZones(tree);
  for (std::size_t number = 0; number < zones.size(); ++number)
  {
    const ZoneTree::Node& node = tree.Nodes[number];
    const Box& zone = zones[number];
    if (!node.IsLeaf() && !(zone.Lo[node.Axis] <= node.Plane && node.Plane <= zone.Hi[node.Axis]))
    {
      return false;
    }
  }
  return true;
}

} // namespace

const TreeSearch::Trial* TreeSearch::Find(const ZoneTree& tree) const
{
  const auto found = std::find_if(this->Trials.begin(), this->Trials.end(),
    [&](const Trial& trial) { return trial.Tree == tree; });
  return found == this->Trials.end() ? nullptr : &*found;
}

bool TreeSearch::IsNew(const ZoneTree& tree) const
{
  return PlanesAreInTheirZones(tree) && !this->Find(tree);
}

/// All planes that are out of balance by one step; none if that has been tried.
std::optional<ZoneTree> TreeSearch::AllPlanesAStep(
  const Trial& from, const std::vector<double>& speeds, int step) const
{
  const Ratios ratios = RatiosOf(from.Tree, from.Work, speeds);
  ZoneTree tree = from.Tree;
  for (std::size_t number = 0; number < ratios.size(); ++number)
  {
    const double ratio = ratios[number];
    tree.Nodes[number].Plane += ratio > StepAbove ? -step : ratio < -StepAbove ? step : 0;
  }
  return this->IsNew(tree) ? std::optional<ZoneTree>(tree) : std::nullopt;
}

/// Makes the slowest zone smaller by one step of one plane: of those around it the one that is most
/// out of balance, if that has not been tried.
std::optional<ZoneTree> TreeSearch::OnePlaneAway(
  const Trial& from, const std::vector<double>& speeds, int step) const
{
  const Ratios ratios = RatiosOf(from.Tree, from.Work, speeds);
  std::size_t slowest = 0;
  for (std::size_t rank = 1; rank < speeds.size(); ++rank)
  {
    slowest =
      from.Work[rank] / speeds[rank] > from.Work[slowest] / speeds[slowest] ? rank : slowest;
  }
  struct Move
  {
    double Excess;
    std::size_t Node;
    int Way;
  };
  std::vector<Move> moves;
  for (std::size_t number = 0; !from.Tree.Nodes[number].IsLeaf();)
  {
    const ZoneTree::Node& node = from.Tree.Nodes[number];
    const auto above = static_cast<std::size_t>(node.Above);
    const bool isAbove = static_cast<int>(slowest) >= from.Tree.Nodes[above].FirstRank;
    moves.push_back({ isAbove ? -ratios[number] : ratios[number], number, isAbove ? step : -step });
    number = isAbove ? above : static_cast<std::size_t>(node.Below);
  }
  std::stable_sort(
    moves.begin(), moves.end(), [](const Move& a, const Move& b) { return a.Excess > b.Excess; });
  for (const Move& move : moves)
  {
    ZoneTree tree = from.Tree;
    tree.Nodes[move.Node].Plane += move.Way;
    if (this->IsNew(tree))
    {
      return tree;
    }
  }
  return std::nullopt;
}

} // namespace banyan
