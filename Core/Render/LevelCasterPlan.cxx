#include "Render/Interpolators.h"
#include "Render/LevelCaster.h"
#include "Render/VisibilityOrder.h"

#include <algorithm>

namespace banyan
{

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
  const glm::ivec3 counts = this->Source.Bricks();
  const std::int64_t count = std::int64_t{ counts.x } * counts.y * counts.z;
  const ValueMask visibleBins = this->Scene.Transfer.VisibleBins(this->Source.MasksAreOver());
  const ProjectionTable* const projection = this->AnySampling->Projection.get();
  for (std::int64_t number = 0; number < count; ++number)
  {
    PlannedBrick brick;
    brick.Number = number;
    this->PlaceCells(brick);
    if (brick.Drawn.Empty())
    {
      continue;
    }
    const ValueRange range = this->Source.RangeOf(number);
    brick.HighestRank = projection ? projection->HighestRank(range) : 0.0f;
    const bool wanted = projection ? brick.HighestRank > 0.0f
                                   : (this->Source.MaskOf(number) & visibleBins) != 0 &&
                                       this->Visible.Any(range.Low, range.High);
    if (wanted && !IsCutAway(this->ClipPlanes, brick.Drawn))
    {
      brick.Footprint = Intersection(this->FootprintOf(brick.Drawn), this->Scene.Viewport);
    }
    if (brick.Footprint.Empty())
    {
      ++this->Statistics.BricksSkipped;
      continue;
    }
    brick.Entry = this->EntryOf(number);
    this->Touched = Union(this->Touched, brick.Footprint);
    this->Bricks.push_back(brick);
  }
  this->SetKeys();
  std::sort(this->Bricks.begin(), this->Bricks.end(),
    [](const PlannedBrick& a, const PlannedBrick& b)
    { return a.Key < b.Key || (a.Key == b.Key && a.Number < b.Number); });
}

/// The part of a brick that is to be drawn, and the cells of it that this takes.
void LevelCaster::PlaceCells(PlannedBrick& brick) const
{
  brick.Level = this->Source.BrickLevel(brick.Number);
  const Box own = this->Source.CellsOf(brick.Number);
  const int size = 1 << brick.Level;
  brick.Drawn = Intersection({ own.Lo * size, own.Hi * size }, this->Cells);
  // Whole: what is packed stays good when the planes of zones move.
  brick.Cells = PackedBrick::CanPack(own)
                  ? own
                  : Box{ brick.Drawn.Lo / size, (brick.Drawn.Hi + size - 1) / size };
}

void LevelCaster::SetKeys()
{
  const Viewpoint view = InIndexSpace(this->Scene.Camera, this->IndexToWorld);
  const ProjectionTable* const projection = this->AnySampling->Projection.get();
  const std::vector<std::int64_t> ranks = this->Source.RanksFrontToBack(view);
  for (PlannedBrick& brick : this->Bricks)
  {
    // The best values first: bricks that cannot beat them are then never loaded. Averages are
    // added up front to back, so that they round alike in bricks of all sizes.
    if (projection && !projection->Averages())
    {
      brick.Key = -brick.HighestRank;
    }
    else
    {
      brick.Key = ranks.empty()
                    ? VisibilityKey(view, this->Source.CellsOf(brick.Number))
                    : static_cast<double>(ranks[static_cast<std::size_t>(brick.Number)]);
    }
  }
}

/// The entry of the table that all samples of a brick have, if nothing else has to be known of
/// them.
std::optional<int> LevelCaster::EntryOf(std::int64_t brick) const
{
  const std::optional<UniformValue> uniform = this->Shading || this->AnySampling->Projection
                                                ? std::nullopt
                                                : this->Source.UniformValueOf(brick);
  if (!uniform)
  {
    return std::nullopt;
  }
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
