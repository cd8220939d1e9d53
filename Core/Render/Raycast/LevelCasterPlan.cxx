// SPDX-License-Identifier: BSD-3-Clause
#include "Base/ThreadPool.h"
#include "Render/Bricks/Interpolators.h"
#include "Render/Bricks/VisibilityOrder.h"
#include "Render/Raycast/LevelCaster.h"

#include <algorithm>
#include <tuple>

namespace banyan
{
namespace
{

/// Bricks are put together where so many of what comes of it fit into the budget.
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

} // namespace

void LevelCaster::AddSamplings()
{
  std::vector<RaySampling> samplings{ { 0, this->Scene.SampleDistance } };
  std::vector<bool> used{ true };
  if (this->Scene.Samplings)
  {
    samplings = this->Scene.Samplings->Samplings();
    used = this->Scene.Samplings->Used();
  }
  for (std::size_t i = 0; i < samplings.size(); ++i)
  {
    this->Samplings.emplace_back();
    if (used[i] && samplings[i].Level == this->Source.Level())
    {
      this->Samplings.back() =
        std::make_unique<const Sampled>(this->Scene, samplings[i].Distance, this->Source);
      this->AnySampling = this->Samplings.back().get();
    }
  }
}

/// Finds the bricks that can be seen, front to back, and the rectangle that they cover.
void LevelCaster::Plan()
{
  const Viewpoint view = InIndexSpace(this->Scene.Camera, this->IndexToWorld);
  this->Ranks = this->Source.RanksFrontToBack(view);
  const int together = this->IsLarge() ? BrickGroups::CellsOfLarge : BrickGroups::Cells;
  const BrickGroups groups(this->Source, this->Ranks.empty() ? together : 0);
  const GroupList members = this->MembersOf(groups);
  const std::int64_t count = groups.Count();
  std::vector<PartOfPlan> parts(
    static_cast<std::size_t>((count + GroupsTogether - 1) / GroupsTogether));
  this->Pool.ParallelFor(static_cast<std::int64_t>(parts.size()),
    [&](std::int64_t part)
    {
      const std::int64_t end = std::min(count, (part + 1) * GroupsTogether);
      for (std::int64_t group = part * GroupsTogether; group < end; ++group)
      {
        this->PlanSome(groups, groups.BricksOf(group), (*members)[static_cast<std::size_t>(group)],
          view, 0, parts[static_cast<std::size_t>(part)]);
      }
    });
  for (const PartOfPlan& part : parts)
  {
    this->Bricks.insert(this->Bricks.end(), part.Bricks.begin(), part.Bricks.end());
    this->Touched = Union(this->Touched, part.Touched);
    this->Statistics.BricksSkipped += part.Skipped;
  }
  const auto order = [](const PlannedBrick& brick)
  { return std::make_tuple(brick.Keys[0], brick.Keys[1], brick.Keys[2], brick.Number); };
  std::sort(this->Bricks.begin(), this->Bricks.end(),
    [&order](const PlannedBrick& a, const PlannedBrick& b) { return order(a) < order(b); });
}

/// Plans bricks of a group: as one, or eighths of them, or each by itself.
/// @param members of these bricks
/// @param depth 0 for all of a group
void LevelCaster::PlanSome(const BrickGroups& groups, const Box& bricks,
  const GroupMembers& members, const Viewpoint& view, int depth, PartOfPlan& plan) const
{
  const std::size_t first = plan.Bricks.size();
  const int edge = groups.BricksPerAxis() >> depth;
  if (edge == 1)
  {
    this->PlanBrick(groups.BrickAt(bricks.Lo), members.Visible != 0, plan);
  }
  else if (members.Visible == 0)
  {
    this->SkipAll(groups, bricks, plan);
  }
  else if (!this->PlanTogether(groups, bricks, members, plan))
  {
    ForEighths(bricks, edge / 2,
      [&](const Box& some)
      {
        std::uint64_t places = 0;
        ForMembers(
          groups, some, [&](std::int64_t, int place) { places |= std::uint64_t{ 1 } << place; });
        this->PlanSome(groups, some, members.Of(places), view, depth + 1, plan);
      });
  }
  if (first < plan.Bricks.size())
  {
    this->SetKeys(first, groups.CellsOf(bricks), view, depth, plan);
  }
}

/// What can be seen of all groups, wherever the camera is.
GroupList LevelCaster::MembersOf(const BrickGroups& groups) const
{
  // What a projection shows is not what the function's opacities say.
  const bool known = !this->AnySampling->Projection;
  KeptBricks& kept = this->Source.Kept();
  const int level = this->Source.Level();
  GroupList list = known ? kept.FindGroups(level, this->Visible.Number()) : nullptr;
  // Zones that grow or shrink may have had other groups.
  if (!list || list->size() != static_cast<std::size_t>(groups.Count()))
  {
    const ValueMask bins = this->Scene.Transfer.VisibleBins(this->Source.MasksAreOver());
    std::vector<GroupMembers> members;
    members.reserve(static_cast<std::size_t>(groups.Count()));
    for (std::int64_t group = 0; group < groups.Count(); ++group)
    {
      members.push_back(this->Look(groups, groups.BricksOf(group), bins));
    }
    list = std::make_shared<const std::vector<GroupMembers>>(std::move(members));
    if (known)
    {
      kept.KeepGroups(level, this->Visible.Number(), list);
    }
  }
  return list;
}

/// @param bins that can be seen
GroupMembers LevelCaster::Look(const BrickGroups& groups, const Box& bricks, ValueMask bins) const
{
  const ProjectionTable* const projection = this->AnySampling->Projection.get();
  GroupMembers members;
  ForMembers(groups, bricks,
    [&](std::int64_t number, int place)
    {
      const std::uint64_t bit = std::uint64_t{ 1 } << place;
      const ValueRange range = this->Source.RangeOf(number);
      const bool seen = projection ? projection->HighestRank(range) > 0.0f
                                   : (this->Source.MaskOf(number) & bins) != 0 &&
                                       this->Visible.Any(range.Low, range.High);
      const bool visible = seen && !this->Source.AllHidden(number);
      members.There |= bit;
      members.Visible |= visible ? bit : 0;
      members.Uniform |= visible && this->Source.IsMacroVoxel(number) ? bit : 0;
    });
  return members;
}

/// Plans the bricks of a group as one, if all of them are to be drawn. @return whether it did, or
/// none of them is on the screen
bool LevelCaster::PlanTogether(
  const BrickGroups& groups, const Box& bricks, const GroupMembers& members, PartOfPlan& plan) const
{
  const bool macroVoxels = !this->Shading && !this->AnySampling->Projection && members.Uniform != 0;
  if (bricks.Count() == 1 || members.Visible != members.There || !this->ClipPlanes.empty() ||
      (macroVoxels && members.Uniform != members.There))
  {
    return false;
  }
  PlannedBrick brick;
  if (macroVoxels)
  {
    brick.Entry = this->EntryOfAll(groups, bricks);
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
  if (!all || this->BytesOf(brick) > this->BudgetBytes / BricksOfBudget)
  {
    return false;
  }
  if (!this->SeeBrick(brick))
  {
    plan.Skipped += bricks.Count();
    return true;
  }
  if (!this->AllOnScreen(groups, brick))
  {
    return false;
  }
  this->TakeIn(brick, plan);
  return true;
}

/// Counts bricks of which nothing can be seen, as far as they are to be drawn at all.
void LevelCaster::SkipAll(const BrickGroups& groups, const Box& bricks, PartOfPlan& plan) const
{
  if (this->Cells.Contains(groups.CellsOf(bricks)))
  {
    plan.Skipped += bricks.Count();
    return;
  }
  ForMembers(
    groups, bricks, [&](std::int64_t number, int) { this->PlanBrick(number, false, plan); });
}

/// The entry that all samples of several bricks have, if they have one.
std::optional<int> LevelCaster::EntryOfAll(const BrickGroups& groups, const Box& bricks) const
{
  const std::optional<int> first = this->EntryOf(groups.BrickAt(bricks.Lo));
  bool same = first.has_value();
  ForMembers(groups, bricks,
    [&](std::int64_t number, int) { same = same && this->EntryOf(number) == first; });
  return same ? first : std::nullopt;
}

/// Whether each of several bricks is on the screen.
bool LevelCaster::AllOnScreen(const BrickGroups& groups, const PlannedBrick& brick) const
{
  const PixelRect& view = this->Scene.Viewport;
  const PixelRect& seen = brick.Footprint;
  if (seen.Lo.x > view.Lo.x && seen.Lo.y > view.Lo.y && seen.Hi.x < view.Hi.x &&
      seen.Hi.y < view.Hi.y)
  {
    return true;
  }
  bool all = true;
  ForMembers(groups, brick.Together,
    [&](std::int64_t number, int)
    {
      const Box drawn = Intersection(this->Source.CellsOf(number), brick.Drawn);
      all = all && !Intersection(this->FootprintOf(drawn), view).Empty();
    });
  return all;
}

/// @param visible whether some value of it can be seen
void LevelCaster::PlanBrick(std::int64_t number, bool visible, PartOfPlan& plan) const
{
  PlannedBrick brick;
  brick.Number = number;
  brick.Level = this->Source.BrickLevel(number);
  this->PlaceCells(brick, this->Source.CellsOf(number));
  if (brick.Drawn.Empty())
  {
    return;
  }
  if (visible && !IsCutAway(this->ClipPlanes, brick.Drawn) && this->SeeBrick(brick))
  {
    brick.Entry = this->EntryOf(number);
    this->TakeIn(brick, plan);
    return;
  }
  ++plan.Skipped;
}

/// @return whether it is on the screen
bool LevelCaster::SeeBrick(PlannedBrick& brick) const
{
  brick.Footprint = Intersection(this->FootprintOf(brick.Drawn), this->Scene.Viewport);
  return !brick.Footprint.Empty();
}

void LevelCaster::TakeIn(PlannedBrick brick, PartOfPlan& plan) const
{
  const ProjectionTable* const projection = this->AnySampling->Projection.get();
  brick.HighestRank = projection ? projection->HighestRank(this->RangeOf(brick)) : 0.0f;
  plan.Touched = Union(plan.Touched, brick.Footprint);
  plan.Bricks.push_back(brick);
}

/// The part of a brick that is to be drawn, and the cells of it that this takes.
/// @param own all of its cells
void LevelCaster::PlaceCells(PlannedBrick& brick, const Box& own) const
{
  const int size = 1 << brick.Level;
  brick.Drawn = Intersection({ own.Lo * size, own.Hi * size }, this->Cells);
  // Whole: what is packed stays good when the planes of zones move.
  brick.Cells = PackedBrick::CanPack(own)
                  ? own
                  : Box{ brick.Drawn.Lo / size, (brick.Drawn.Hi + size - 1) / size };
}

/// Of bricks that were planned last. Groups are cut by whole planes, and so are the bricks of one.
/// @param first of them
/// @param cells that they are in
/// @param depth as PlanSome has it
void LevelCaster::SetKeys(
  std::size_t first, const Box& cells, const Viewpoint& view, int depth, PartOfPlan& plan) const
{
  const ProjectionTable* const projection = this->AnySampling->Projection.get();
  for (std::size_t i = first; i < plan.Bricks.size(); ++i)
  {
    PlannedBrick& brick = plan.Bricks[i];
    // The best values first: bricks that cannot beat them are then never loaded. Averages are
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
      brick.Keys[depth] = VisibilityKey(view, cells);
    }
  }
}

/// Of the finite values anywhere in it.
ValueRange LevelCaster::RangeOf(const PlannedBrick& brick) const
{
  ValueRange range;
  this->ForBricksOf(
    brick, [&](std::int64_t number) { range.Include(this->Source.RangeOf(number)); });
  return range;
}

std::uint64_t LevelCaster::LoadBytesOf(const PlannedBrick& brick) const
{
  std::uint64_t bytes = 0;
  this->ForBricksOf(brick, [&](std::int64_t number) { bytes += this->Source.LoadBytes(number); });
  return bytes;
}

/// Bricks that are packed together have a number of their own, and so have those of large blocks.
std::int64_t LevelCaster::KeptNumberOf(const PlannedBrick& brick) const
{
  constexpr std::int64_t together = std::int64_t{ 1 } << 40;
  const std::int64_t bricks = brick.Together.Count();
  return this->Source.KeptNumber(brick.Number) + (bricks == 0    ? 0
                                                   : bricks <= 8 ? together
                                                                 : 2 * together);
}

/// The entry of the table that all samples of a brick have, if nothing else has to be known of
/// them.
std::optional<int> LevelCaster::EntryOf(std::int64_t brick) const
{
  if (this->Shading || this->AnySampling->Projection || !this->Source.IsMacroVoxel(brick))
  {
    return std::nullopt;
  }
  const std::optional<UniformValue> uniform = this->Source.UniformValueOf(brick);
  // As a sample between eight such corners finds it.
  const StepTable& table = this->AnySampling->Table;
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

PixelRect LevelCaster::FootprintOf(const Box& cells) const
{
  return this->IndexCamera.Footprint(glm::dvec3(cells.Lo), glm::dvec3(cells.Hi));
}

} // namespace banyan
