// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Levels_BrickPlanner_h
#define banyan_Render_Levels_BrickPlanner_h

#include "Render/Bricks/SummaryTree.h"
#include "Render/Levels/BrickPlan.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace banyan
{

/// What need not be asked of boxes on the way down, since it is so of the box around.
struct Within
{
  bool Cells = false;  ///< inside those to draw
  bool Screen = false; ///< on the screen
};

/// Plans groups of bricks one by one: a group as one brick, or its eighths so, or each of its
/// bricks by itself. Methods only add to the plan that they are given.
class BrickPlanner
{
public:
  /// @param bytesAreOf see PackedBrickCache::GroupsOf
  BrickPlanner(
    const LevelScene& level, const Box& cells, std::uint64_t budgetBytes, std::uint64_t bytesAreOf);

  /// Goes to the groups that may be seen, front to back.
  /// @param function called as bool(const Box& bricks, const Within&): whether to go on
  template <class Function>
  void ForGroups(Function&& function) const;

  /// About how many bricks PlanGroup adds; 0 where that would take time.
  std::size_t AboutHowMany(const Box& bricks) const;
  void PlanGroup(const Box& bricks, BrickPlan& plan) const
  {
    this->PlanSome(bricks, this->MembersOf(bricks), 0, plan);
  }
  /// The same planner for bricks that are known to be on the screen.
  BrickPlanner WithoutScreen() const;
  /// Bytes that PlanGroup's bricks take, as loaded and as packed for drawing.
  std::uint64_t BytesOf(const Box& bricks) const;
  /// The same of a planner without a screen, and of groups inside the cells to draw, where nothing
  /// is cut away: computed once per transfer function.
  std::uint64_t KnownBytesOf(const Box& bricks) const;
  bool KnowsBytesOf(const Within& within) const
  {
    return this->Known && within.Cells && within.Screen && this->Level.ClipPlanes.empty();
  }
  /// Bricks with a part in the cells to draw.
  std::int64_t CountAll() const;

private:
  bool MayBeSeen(const ValueRange& range, ValueMask mask) const;
  bool Enter(const SummaryTree::Place& place, Within& within) const;
  GroupMembers MembersOf(const Box& bricks) const;
  GroupMembers LookAt(const Box& bricks) const;
  void PlanSome(const Box& bricks, const GroupMembers& members, int depth, BrickPlan& plan) const;
  bool PlanTogether(const Box& bricks, const GroupMembers& members, BrickPlan& plan) const;
  void PlanBrick(const Box& bricks, bool uniform, BrickPlan& plan) const;
  bool IsSmallPartOfBudget(const PlannedBrick& brick) const;
  void Add(PlannedBrick& brick, BrickPlan& plan) const;
  void PlaceCells(PlannedBrick& brick, const Box& own) const;
  bool PlaceOnScreen(PlannedBrick& brick) const;
  bool IsInsideScreen(const PixelRect& seen) const;
  bool AllOnScreen(const PlannedBrick& brick) const;
  std::optional<int> EntryOf(std::int64_t brick) const;
  std::optional<int> EntryOfAll(const Box& bricks) const;

  const LevelScene& Level;
  const BrickSource& Source;
  Box Cells; ///< to draw
  std::uint64_t BudgetBytes;
  bool LooksAtScreen = true;
  Viewpoint View; ///< in index space
  BrickGroups GroupsOfBricks;
  const SummaryTree* Summaries;       ///< null where bricks are no grid
  ValueMask Bins;                     ///< that can be seen
  std::shared_ptr<KnownGroups> Known; ///< null for projections: opacities do not say what they show
};

template <class Function>
void BrickPlanner::ForGroups(Function&& function) const
{
  if (this->Summaries)
  {
    bool more = true;
    this->Summaries->Descend(this->View, Within(),
      [&](const SummaryTree::Place& place, Within& within)
      {
        if (!more || !this->Enter(place, within))
        {
          return false;
        }
        const bool group = 1 << place.Height <= this->GroupsOfBricks.BricksPerAxis();
        more = !group || function(place.Bricks, within);
        return !group;
      });
    return;
  }
  const std::vector<std::int64_t> ranks = this->Source.RanksFrontToBack(this->View);
  std::vector<std::int64_t> order(ranks.size());
  for (std::size_t brick = 0; brick < ranks.size(); ++brick)
  {
    order[static_cast<std::size_t>(ranks[brick])] = static_cast<std::int64_t>(brick);
  }
  for (const std::int64_t brick : order)
  {
    if (!function(this->GroupsOfBricks.BricksOf(brick), Within()))
    {
      return;
    }
  }
}

} // namespace banyan

#endif
