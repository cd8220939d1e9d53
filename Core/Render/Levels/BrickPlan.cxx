// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/BrickPlan.h"

#include "Base/ThreadPool.h"
#include "Render/Bricks/Interpolators.h"
#include "Render/Bricks/VisibilityOrder.h"

#include <algorithm>
#include <tuple>

namespace banyan
{
namespace
{

/// Bricks become one where so many of the result fit into the budget.
constexpr std::uint64_t BricksOfBudget = 64;
/// Groups that a thread plans in one go.
constexpr std::int64_t GroupsTogether = 64;

/// Calls function(bricks) for the parts of a box of bricks, of so many along each axis.
template <class Function>
void ForEighths(const Box& bricks, int edge, Function&& function)
{
  for (int z = bricks.Lo.z; z < bricks.Hi.z; z += edge)
  {
    for (int y = bricks.Lo.y; y < bricks.Hi.y; y += edge)
    {
      for (int x = bricks.Lo.x; x < bricks.Hi.x; x += edge)
      {
        const glm::ivec3 low(x, y, z);
        function(Box{ low, glm::min(low + edge, bricks.Hi) });
      }
    }
  }
}

/// Looks at the bricks of one group.
/// @param bins that can be seen
GroupMembers LookAt(
  const LevelScene& level, const BrickGroups& groups, const Box& bricks, ValueMask bins)
{
  const ProjectionTable* const projection = level.Projection();
  const BrickSource& source = level.Source;
  GroupMembers members;
  ForMembers(groups, bricks,
    [&](std::int64_t number, int place)
    {
      const std::uint64_t bit = std::uint64_t{ 1 } << place;
      const ValueRange range = source.RangeOf(number);
      const bool seen = projection ? projection->HighestRank(range) > 0.0f
                                   : (source.MaskOf(number) & bins) != 0 &&
                                       level.Visible->Any(range.Low, range.High);
      const bool visible = seen && !source.AllHidden(number);
      members.There |= bit;
      members.Visible |= visible ? bit : 0;
      members.Uniform |= visible && source.IsMacroVoxel(number) ? bit : 0;
    });
  return members;
}

/// What can be seen of all groups, wherever the camera is: kept from the picture before, if that
/// had the same transfer function.
GroupList MembersOf(const LevelScene& level, const BrickGroups& groups)
{
  // The function's opacities do not say what a projection shows.
  const bool known = !level.Projection();
  PackedBrickCache& kept = level.Source.Kept();
  const int number = level.Source.Level();
  GroupList list = known ? kept.FindGroups(number, level.Visible->Number()) : nullptr;
  // Zones that grow or shrink may have had other groups.
  if (!list || list->size() != static_cast<std::size_t>(groups.Count()))
  {
    const ValueMask bins = level.Scene.Transfer.VisibleBins(level.Source.MasksAreOver());
    std::vector<GroupMembers> members;
    members.reserve(static_cast<std::size_t>(groups.Count()));
    for (std::int64_t group = 0; group < groups.Count(); ++group)
    {
      members.push_back(LookAt(level, groups, groups.BricksOf(group), bins));
    }
    list = std::make_shared<const std::vector<GroupMembers>>(std::move(members));
    if (known)
    {
      kept.KeepGroups(number, level.Visible->Number(), list);
    }
  }
  return list;
}

/// Plans groups of bricks one by one: a group as one brick, or its eighths so, or each of its
/// bricks by itself. Methods only add to the plan that they are given.
class BrickPlanner
{
public:
  BrickPlanner(const LevelScene& level, const Box& cells, std::uint64_t budgetBytes);

  const BrickGroups& Groups() const { return this->GroupsOfBricks; }
  void PlanGroup(std::int64_t group, const GroupMembers& members, BrickPlan& plan) const
  {
    this->PlanSome(this->GroupsOfBricks.BricksOf(group), members, 0, plan);
  }

private:
  void PlanSome(const Box& bricks, const GroupMembers& members, int depth, BrickPlan& plan) const;
  bool PlanTogether(const Box& bricks, const GroupMembers& members, BrickPlan& plan) const;
  void PlanBrick(std::int64_t number, bool visible, BrickPlan& plan) const;
  void SkipAll(const Box& bricks, BrickPlan& plan) const;
  void Add(PlannedBrick brick, BrickPlan& plan) const;
  void PlaceCells(PlannedBrick& brick, const Box& own) const;
  bool PlaceOnScreen(PlannedBrick& brick) const;
  bool AllOnScreen(const PlannedBrick& brick) const;
  void SetKeys(std::size_t first, const Box& cells, int depth, BrickPlan& plan) const;
  std::optional<int> EntryOf(std::int64_t brick) const;
  std::optional<int> EntryOfAll(const Box& bricks) const;

  const LevelScene& Level;
  const BrickSource& Source;
  Box Cells; ///< to draw
  std::uint64_t BudgetBytes;
  Viewpoint View;                  ///< in index space
  std::vector<std::int64_t> Ranks; ///< BrickSource::RanksFrontToBack
  BrickGroups GroupsOfBricks;
};

BrickPlanner::BrickPlanner(const LevelScene& level, const Box& cells, std::uint64_t budgetBytes)
  : Level(level)
  , Source(level.Source)
  , Cells(cells)
  , BudgetBytes(budgetBytes)
  , View(InIndexSpace(level.Scene.Camera, level.IndexToWorld))
  , Ranks(level.Source.RanksFrontToBack(View))
  , GroupsOfBricks(level.Source, !Ranks.empty()    ? 0
                                 : level.IsLarge() ? BrickGroups::CellsOfLarge
                                                   : BrickGroups::Cells)
{
}

/// Plans bricks of a group: as one, or eighths of them, or each by itself.
/// @param members of these bricks
/// @param depth 0 for all of a group
void BrickPlanner::PlanSome(
  const Box& bricks, const GroupMembers& members, int depth, BrickPlan& plan) const
{
  const BrickGroups& groups = this->GroupsOfBricks;
  const std::size_t first = plan.Bricks.size();
  const int edge = groups.BricksPerAxis() >> depth;
  if (edge == 1)
  {
    this->PlanBrick(groups.BrickAt(bricks.Lo), members.Visible != 0, plan);
  }
  else if (members.Visible == 0)
  {
    this->SkipAll(bricks, plan);
  }
  else if (!this->PlanTogether(bricks, members, plan))
  {
    ForEighths(bricks, edge / 2,
      [&](const Box& some)
      {
        std::uint64_t places = 0;
        ForMembers(
          groups, some, [&](std::int64_t, int place) { places |= std::uint64_t{ 1 } << place; });
        this->PlanSome(some, members.Of(places), depth + 1, plan);
      });
  }
  if (first < plan.Bricks.size())
  {
    this->SetKeys(first, groups.CellsOf(bricks), depth, plan);
  }
}

/// Plans bricks as one, if all of them are to be drawn.
/// @return whether it did, or none of them is on the screen
bool BrickPlanner::PlanTogether(
  const Box& bricks, const GroupMembers& members, BrickPlan& plan) const
{
  const BrickGroups& groups = this->GroupsOfBricks;
  const bool macroVoxels =
    !this->Level.IsShaded() && !this->Level.Projection() && members.Uniform != 0;
  if (bricks.Count() == 1 || members.Visible != members.There || !this->Level.ClipPlanes.empty() ||
      (macroVoxels && members.Uniform != members.There))
  {
    return false;
  }
  PlannedBrick brick;
  if (macroVoxels)
  {
    brick.Entry = this->EntryOfAll(bricks);
    if (!brick.Entry)
    {
      return false;
    }
  }
  brick.Number = groups.BrickAt(bricks.Lo);
  brick.Together = bricks;
  this->PlaceCells(brick, groups.CellsOf(bricks));
  bool all = PackedBrick::CanPack(brick.Cells);
  ForMembers(groups, bricks,
    [&](std::int64_t number, int)
    { all = all && !Intersection(this->Source.CellsOf(number), brick.Drawn).Empty(); });
  // A budget that is all but used up by one of them wants small bricks.
  if (!all ||
      brick.BytesToDraw(this->Source, this->Level.IsShaded()) > this->BudgetBytes / BricksOfBudget)
  {
    return false;
  }
  if (!this->PlaceOnScreen(brick))
  {
    plan.Skipped += bricks.Count();
    return true;
  }
  if (!this->AllOnScreen(brick))
  {
    return false;
  }
  this->Add(brick, plan);
  return true;
}

/// @param visible whether some value of it can be seen
void BrickPlanner::PlanBrick(std::int64_t number, bool visible, BrickPlan& plan) const
{
  PlannedBrick brick;
  brick.Number = number;
  brick.Level = this->Source.BrickLevel(number);
  this->PlaceCells(brick, this->Source.CellsOf(number));
  if (brick.Drawn.Empty())
  {
    return;
  }
  if (visible && !IsCutAway(this->Level.ClipPlanes, brick.Drawn) && this->PlaceOnScreen(brick))
  {
    brick.Entry = this->EntryOf(number);
    this->Add(brick, plan);
    return;
  }
  ++plan.Skipped;
}

/// Counts bricks of which nothing can be seen, as far as they are to be drawn at all.
void BrickPlanner::SkipAll(const Box& bricks, BrickPlan& plan) const
{
  if (this->Cells.Contains(this->GroupsOfBricks.CellsOf(bricks)))
  {
    plan.Skipped += bricks.Count();
    return;
  }
  ForMembers(this->GroupsOfBricks, bricks,
    [&](std::int64_t number, int) { this->PlanBrick(number, false, plan); });
}

void BrickPlanner::Add(PlannedBrick brick, BrickPlan& plan) const
{
  const ProjectionTable* const projection = this->Level.Projection();
  brick.HighestRank = projection ? projection->HighestRank(brick.RangeIn(this->Source)) : 0.0f;
  plan.Touched = Union(plan.Touched, brick.Footprint);
  plan.Bricks.push_back(brick);
}

/// Sets the part of a brick that is to be drawn, and the cells to pack for it.
/// @param own all of its cells
void BrickPlanner::PlaceCells(PlannedBrick& brick, const Box& own) const
{
  const int size = 1 << brick.Level;
  brick.Drawn = Intersection({ own.Lo * size, own.Hi * size }, this->Cells);
  // The whole brick is packed where it can be: that stays good when the planes of zones move.
  brick.Cells = PackedBrick::CanPack(own)
                  ? own
                  : Box{ brick.Drawn.Lo / size, (brick.Drawn.Hi + size - 1) / size };
}

/// Sets the footprint.
/// @return whether the brick is on the screen
bool BrickPlanner::PlaceOnScreen(PlannedBrick& brick) const
{
  brick.Footprint = Intersection(this->Level.FootprintOf(brick.Drawn), this->Level.Scene.Viewport);
  return !brick.Footprint.Empty();
}

/// Whether each of the bricks that are drawn as one is on the screen.
bool BrickPlanner::AllOnScreen(const PlannedBrick& brick) const
{
  const PixelRect& view = this->Level.Scene.Viewport;
  const PixelRect& seen = brick.Footprint;
  if (seen.Lo.x > view.Lo.x && seen.Lo.y > view.Lo.y && seen.Hi.x < view.Hi.x &&
      seen.Hi.y < view.Hi.y)
  {
    return true;
  }
  bool all = true;
  ForMembers(this->GroupsOfBricks, brick.Together,
    [&](std::int64_t number, int)
    {
      const Box drawn = Intersection(this->Source.CellsOf(number), brick.Drawn);
      all = all && !Intersection(this->Level.FootprintOf(drawn), view).Empty();
    });
  return all;
}

/// Sets a key of the bricks that were planned last. Groups are cut by whole planes, and so are the
/// bricks of one.
/// @param first of these bricks, in the plan
/// @param cells that they are in
/// @param depth the same as in PlanSome
void BrickPlanner::SetKeys(std::size_t first, const Box& cells, int depth, BrickPlan& plan) const
{
  const ProjectionTable* const projection = this->Level.Projection();
  for (std::size_t i = first; i < plan.Bricks.size(); ++i)
  {
    PlannedBrick& brick = plan.Bricks[i];
    // The best values come first: bricks that cannot beat them are then never loaded. Averages are
    // added up front to back, so that they round alike in bricks of all sizes.
    if (projection && !projection->Averages())
    {
      brick.Keys[0] = -brick.HighestRank;
    }
    else if (!this->Ranks.empty())
    {
      brick.Keys[0] = static_cast<double>(this->Ranks[static_cast<std::size_t>(brick.Number)]);
    }
    else
    {
      brick.Keys[depth] = VisibilityKey(this->View, cells);
    }
  }
}

/// The entry of the table that all samples of a brick have, if nothing else has to be known of
/// them.
std::optional<int> BrickPlanner::EntryOf(std::int64_t brick) const
{
  if (this->Level.IsShaded() || this->Level.Projection() || !this->Source.IsMacroVoxel(brick))
  {
    return std::nullopt;
  }
  const std::optional<UniformValue> uniform = this->Source.UniformValueOf(brick);
  // A sample between eight such corners finds the same entry.
  const StepTable& table = this->Level.AnySampling->Table;
  std::optional<int> entry;
  Dispatch(uniform->Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const TableLookup& lookup = IsRelative<T> ? table.RelativeLookup() : table.Lookup();
      entry = lookup.IndexOf(IsRelative<T> ? CornerValue(uniform->Value, table.Low())
                                           : static_cast<float>(uniform->Value));
    });
  return entry;
}

/// The entry that all samples of several bricks have, if they have one.
std::optional<int> BrickPlanner::EntryOfAll(const Box& bricks) const
{
  const std::optional<int> first = this->EntryOf(this->GroupsOfBricks.BrickAt(bricks.Lo));
  bool same = first.has_value();
  ForMembers(this->GroupsOfBricks, bricks,
    [&](std::int64_t number, int) { same = same && this->EntryOf(number) == first; });
  return same ? first : std::nullopt;
}

} // namespace

std::uint64_t BrickPlan::BytesToDraw(const LevelScene& level) const
{
  std::uint64_t bytes = 0;
  for (const PlannedBrick& brick : this->Bricks)
  {
    bytes += brick.BytesToDraw(level.Source, level.IsShaded());
  }
  return bytes;
}

BrickPlan PlanBricks(
  const LevelScene& level, const Box& cells, std::uint64_t budgetBytes, ThreadPool& pool)
{
  const BrickPlanner planner(level, cells, budgetBytes);
  const GroupList members = MembersOf(level, planner.Groups());
  const std::int64_t count = planner.Groups().Count();
  std::vector<BrickPlan> parts(
    static_cast<std::size_t>((count + GroupsTogether - 1) / GroupsTogether));
  pool.ParallelFor(static_cast<std::int64_t>(parts.size()),
    [&](std::int64_t part)
    {
      const std::int64_t end = std::min(count, (part + 1) * GroupsTogether);
      for (std::int64_t group = part * GroupsTogether; group < end; ++group)
      {
        planner.PlanGroup(group, (*members)[static_cast<std::size_t>(group)],
          parts[static_cast<std::size_t>(part)]);
      }
    });
  BrickPlan plan;
  for (const BrickPlan& part : parts)
  {
    plan.Bricks.insert(plan.Bricks.end(), part.Bricks.begin(), part.Bricks.end());
    plan.Touched = Union(plan.Touched, part.Touched);
    plan.Skipped += part.Skipped;
  }
  const auto order = [](const PlannedBrick& brick)
  { return std::make_tuple(brick.Keys[0], brick.Keys[1], brick.Keys[2], brick.Number); };
  std::sort(plan.Bricks.begin(), plan.Bricks.end(),
    [&order](const PlannedBrick& a, const PlannedBrick& b) { return order(a) < order(b); });
  return plan;
}

} // namespace banyan
