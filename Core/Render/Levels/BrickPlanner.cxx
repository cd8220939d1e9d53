// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/BrickPlanner.h"

#include "Render/Bricks/Interpolators.h"

#include <algorithm>
#include <bitset>

namespace banyan
{
namespace
{

/// Bricks become one where so many of the result fit into the budget.
constexpr std::uint64_t BricksOfBudget = 64;

} // namespace

BrickPlanner::BrickPlanner(
  const LevelScene& level, const Box& cells, std::uint64_t budgetBytes, std::uint64_t bytesAreOf)
  : Level(level)
  , Source(level.Source)
  , Cells(cells)
  , BudgetBytes(budgetBytes)
  , View(InIndexSpace(level.Scene.Camera, level.IndexToWorld))
  , GroupsOfBricks(level.Source, !level.Source.IsGrid() ? 0
                                 : level.IsLarge()      ? BrickGroups::CellsOfLarge
                                                        : BrickGroups::Cells)
  , Summaries(level.Source.Summaries())
  , Bins(level.Visible->Bins(level.Source.MasksAreOver()))
{
  if (!level.Projection())
  {
    this->Known = level.Source.Kept().GroupsOf(
      level.Source.Level(), level.Visible->Number(), this->GroupsOfBricks.Count(), bytesAreOf);
  }
}

BrickPlanner BrickPlanner::WithoutScreen() const
{
  BrickPlanner planner(*this);
  planner.LooksAtScreen = false;
  return planner;
}

/// Whether something in a box may have to be drawn.
bool BrickPlanner::Enter(const SummaryTree::Place& place, Within& within) const
{
  if (place.Node && !this->MayBeSeen(place.Node->Range, place.Node->Mask))
  {
    return false;
  }
  Box part = place.Cells;
  if (!within.Cells)
  {
    within.Cells = this->Cells.Contains(part);
    part = Intersection(part, this->Cells);
  }
  if (part.Empty() || IsCutAway(this->Level.ClipPlanes, part))
  {
    return false;
  }
  if (within.Screen || place.Height == 0) // single bricks are looked at anyway
  {
    return true;
  }
  const PixelRect seen = this->Level.FootprintOf(part);
  within.Screen = this->IsInsideScreen(seen);
  return within.Screen || !Intersection(seen, this->Level.Scene.Viewport).Empty();
}

bool BrickPlanner::MayBeSeen(const ValueRange& range, ValueMask mask) const
{
  const ProjectionTable* const projection = this->Level.Projection();
  return projection ? projection->HighestRank(range) > 0.0f
                    : (mask & this->Bins) != 0 && this->Level.Visible->Any(range.Low, range.High);
}

/// What can be seen of a group, wherever the camera is.
GroupMembers BrickPlanner::MembersOf(const Box& bricks) const
{
  const auto look = [&] { return this->LookAt(bricks); };
  return this->Known ? this->Known->MembersOf(this->GroupsOfBricks.NumberOf(bricks), look) : look();
}

std::size_t BrickPlanner::AboutHowMany(const Box& bricks) const
{
  if (!this->Known)
  {
    return 0;
  }
  const GroupMembers members = this->MembersOf(bricks);
  return members.Visible == members.There ? 1 : std::bitset<64>(members.Visible).count();
}

GroupMembers BrickPlanner::LookAt(const Box& bricks) const
{
  GroupMembers members;
  ForMembers(this->GroupsOfBricks, bricks,
    [&](std::int64_t number, int place)
    {
      const std::uint64_t bit = std::uint64_t{ 1 } << place;
      const bool visible =
        this->MayBeSeen(this->Source.RangeOf(number), this->Source.MaskOf(number)) &&
        !this->Source.AllHidden(number);
      members.There |= bit;
      members.Visible |= visible ? bit : 0;
      members.Uniform |= visible && this->Source.IsMacroVoxel(number) ? bit : 0;
    });
  return members;
}

std::uint64_t BrickPlanner::BytesOf(const Box& bricks) const
{
  BrickPlan plan;
  this->PlanGroup(bricks, plan);
  std::uint64_t bytes = 0;
  for (const PlannedBrick& brick : plan.Bricks)
  {
    bytes += brick.BytesToDraw(this->Source, this->Level.IsShaded());
  }
  return bytes;
}

std::uint64_t BrickPlanner::KnownBytesOf(const Box& bricks) const
{
  return this->Known->BytesOf(
    this->GroupsOfBricks.NumberOf(bricks), [&] { return this->BytesOf(bricks); });
}

std::int64_t BrickPlanner::CountAll() const
{
  if (this->Summaries)
  {
    return this->Summaries->BricksIn(this->Cells).Count();
  }
  std::int64_t all = 0;
  for (std::int64_t brick = 0; brick < this->GroupsOfBricks.Count(); ++brick)
  {
    PlannedBrick placed;
    placed.Level = this->Source.BrickLevel(brick);
    this->PlaceCells(placed, this->Source.CellsOf(brick));
    all += placed.Drawn.Empty() ? 0 : 1;
  }
  return all;
}

/// Plans bricks of a group: as one, or eighths of them, or each by itself.
/// @param members of these bricks
/// @param depth 0 for all of a group
void BrickPlanner::PlanSome(
  const Box& bricks, const GroupMembers& members, int depth, BrickPlan& plan) const
{
  const BrickGroups& groups = this->GroupsOfBricks;
  const int edge = groups.BricksPerAxis() >> depth;
  if (members.Visible == 0)
  {
    return;
  }
  if (edge == 1)
  {
    this->PlanBrick(bricks, members.Uniform != 0, plan);
  }
  else if (!this->PlanTogether(bricks, members, plan))
  {
    this->Summaries->ForOctants(this->View, bricks, edge / 2,
      [&](const Box& some)
      { this->PlanSome(some, members.Of(groups.PlacesOf(some)), depth + 1, plan); });
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
  const Box own = this->Summaries->CellsOf(bricks);
  this->PlaceCells(brick, own);
  const bool all =
    PackedBrick::CanPack(brick.Cells) &&
    (brick.Drawn == own || this->Summaries->BricksIn(brick.Drawn).Count() == bricks.Count());
  if (!all || !this->IsSmallPartOfBudget(brick))
  {
    return false;
  }
  if (!this->PlaceOnScreen(brick))
  {
    return true;
  }
  if (!this->AllOnScreen(brick))
  {
    return false;
  }
  this->Add(brick, plan);
  return true;
}

/// A budget that is all but used up by one brick wants smaller ones.
/// @param brick made of several
bool BrickPlanner::IsSmallPartOfBudget(const PlannedBrick& brick) const
{
  const std::uint64_t most = this->BudgetBytes / BricksOfBudget;
  if (this->Known)
  {
    // Mostly there is room for all of the group: then nothing need be added up again.
    const std::int64_t group = this->GroupsOfBricks.NumberOf(brick.Together);
    const std::uint64_t loaded = this->Known->LoadBytesOf(group,
      [&]
      {
        PlannedBrick whole;
        whole.Together = this->GroupsOfBricks.BricksOf(group);
        return whole.LoadBytes(this->Source);
      });
    if (loaded + brick.PackedBytes(this->Source, this->Level.IsShaded()) <= most)
    {
      return true;
    }
  }
  return brick.BytesToDraw(this->Source, this->Level.IsShaded()) <= most;
}

/// @param bricks one, of which some value can be seen
/// @param uniform whether it is a macro voxel
void BrickPlanner::PlanBrick(const Box& bricks, bool uniform, BrickPlan& plan) const
{
  PlannedBrick brick;
  brick.Number = this->GroupsOfBricks.BrickAt(bricks.Lo);
  brick.Level = this->Source.BrickLevel(brick.Number);
  this->PlaceCells(
    brick, this->Summaries ? this->Summaries->CellsOf(bricks) : this->Source.CellsOf(brick.Number));
  if (!brick.Drawn.Empty() && !IsCutAway(this->Level.ClipPlanes, brick.Drawn) &&
      this->PlaceOnScreen(brick))
  {
    brick.Entry = uniform ? this->EntryOf(brick.Number) : std::nullopt;
    this->Add(brick, plan);
  }
}

void BrickPlanner::Add(PlannedBrick& brick, BrickPlan& plan) const
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
  if (!this->LooksAtScreen)
  {
    return true;
  }
  brick.Footprint = Intersection(this->Level.FootprintOf(brick.Drawn), this->Level.Scene.Viewport);
  return !brick.Footprint.Empty();
}

/// Whether what has a footprint is all on the screen.
bool BrickPlanner::IsInsideScreen(const PixelRect& seen) const
{
  const PixelRect& view = this->Level.Scene.Viewport;
  return !seen.Empty() && seen.Lo.x > view.Lo.x && seen.Lo.y > view.Lo.y && seen.Hi.x < view.Hi.x &&
         seen.Hi.y < view.Hi.y;
}

/// Whether each of the bricks that are drawn as one is on the screen.
bool BrickPlanner::AllOnScreen(const PlannedBrick& brick) const
{
  const PixelRect& view = this->Level.Scene.Viewport;
  if (!this->LooksAtScreen || this->IsInsideScreen(brick.Footprint))
  {
    return true;
  }
  bool all = true;
  ForPositions(brick.Together,
    [&](const glm::ivec3& at)
    {
      const Box drawn = Intersection(this->Summaries->CellsOf({ at, at + 1 }), brick.Drawn);
      all = all && !Intersection(this->Level.FootprintOf(drawn), view).Empty();
    });
  return all;
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

} // namespace banyan
