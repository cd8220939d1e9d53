// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/BrickProjector.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Render/Raycast/PacketProjector.cxx"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "Render/Raycast/PacketIntervals-inl.h"
#include "Render/Raycast/PacketSamples-inl.h"
#include "Render/Raycast/ProjectedLanes-inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

#if HWY_TARGET == HWY_SCALAR

// Processors without SSE4, and others without vectors: one ray after the other.
void ProjectPackedHere(const PackedBrick& brick, const Box& cells, const ValueRange&,
  const ProjectionTable& table, const PixelRect& pixels, RayTile& tile)
{
  ProjectUnpacked(brick, cells, table, pixels, tile);
}

#else

/// Takes the samples of one brick into as many rays at a time as a vector has lanes.
/// @tparam Average whether values are averaged, not ranked
/// @tparam Numbers whether the brick has 16-bit numbers; it is not special then
template <bool Special, bool Nearest, bool Average, bool Numbers>
class PacketProjector
{
public:
  PacketProjector(const PackedBrick& brick, const Box& cells, const ValueRange& range,
    const ProjectionTable& table, RayTile& tile)
    : Table(table)
    , Intervals(tile, cells)
    , Samples(brick, table.ScaleOf(brick.Relative()).Lookup)
    , Tile(tile)
    , Relative(brick.Relative())
    , OnlyCounts(Average && !Special && table.OnlyCounts(range))
    , HighestRank(table.HighestRank(range))
  {
    const int larger = tile.CellShift - tile.BrickShift;
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::int64_t corner = ToFixed(brick.Corner()[axis]);
      this->ToBrick[axis] = static_cast<std::uint32_t>(-corner);
      this->Offset[axis] = static_cast<std::uint32_t>((ToFixed(cells.Lo[axis]) >> larger) - corner);
    }
  }

  HWY_INLINE void ProjectPacket(int packet)
  {
    for (int i = 0; i < RayTile::PacketSize; i += static_cast<int>(hn::Lanes(D())))
    {
      this->ProjectLanes(packet * RayTile::PacketSize + i);
    }
  }

private:
  using Lanes = hn::Mask<D>;
  using Place = typename PacketSamples<Special, false, Nearest, Numbers>::Place;

  HWY_INLINE void ProjectLanes(int slot)
  {
    const D d;
    Lanes open = hn::MaskFromVec(hn::BitCast(d, hn::Set(DI(), -1)));
    if (!Average)
    {
      const VF best = hn::Load(d, this->Tile.Color[0] + slot);
      open = hn::Lt(best, hn::Set(d, this->HighestRank));
      if (hn::AllFalse(d, open))
      {
        return;
      }
    }
    const Estimate estimate = this->Intervals.EstimateAt(slot);
    if (estimate.MayHaveHead)
    {
      this->ProjectEnds(slot, this->Tile.Head);
    }
    const Whole whole = this->Intervals.FindAt(slot, estimate);
    open = hn::And(open, hn::RebindMask(d, hn::Gt(whole.Count, hn::Zero(DI()))));
    if (!hn::AllFalse(d, open))
    {
      this->ProjectWhole(slot, whole, open);
    }
    if (estimate.MayHaveTail)
    {
      this->ProjectEnds(slot, this->Tile.Tail);
    }
  }

  HWY_INLINE auto MetAt(int slot) const
  {
    if constexpr (Average)
    {
      return Sums(this->Table, this->Tile, slot, this->Relative);
    }
    else
    {
      return Ranks(this->Table, this->Tile, slot);
    }
  }

  HWY_INLINE void ProjectWhole(int slot, const Whole& whole, Lanes open)
  {
    const D d;
    const DI di;
    const DU du;
    auto met = this->MetAt(slot);
    if constexpr (Average)
    {
      if (this->OnlyCounts)
      {
        met.AddTransparent(hn::ConvertTo(d, whole.Count));
        met.Keep(this->Tile, slot);
        return;
      }
    }
    Position at = { hn::Add(whole.First[0], hn::Set(du, this->Offset[0])),
      hn::Add(whole.First[1], hn::Set(du, this->Offset[1])),
      hn::Add(whole.First[2], hn::Set(du, this->Offset[2])) };
    const Position step = { this->Intervals.InBrickCells(this->Tile.Step[0] + slot),
      this->Intervals.InBrickCells(this->Tile.Step[1] + slot),
      this->Intervals.InBrickCells(this->Tile.Step[2] + slot) };
    VI left = whole.Count;
    std::size_t taken = 0;
    for (Lanes lanes = open; !hn::AllFalse(d, lanes);)
    {
      Place place;
      this->Samples.Locate(at, lanes, place);
      const VF value = this->Samples.ValueOf(place);
      met.Add(value, this->Samples.IndicesOf(value), lanes);
      taken += hn::CountTrue(d, lanes);
      at = { hn::Add(at.X, step.X), hn::Add(at.Y, step.Y), hn::Add(at.Z, step.Z) };
      left = hn::Sub(left, hn::Set(di, 1));
      lanes = hn::And(lanes, hn::RebindMask(d, hn::Gt(left, hn::Zero(di))));
    }
    met.Keep(this->Tile, slot);
    this->Tile.SamplesTaken += static_cast<std::int64_t>(taken);
  }

  /// Heads or tails of a vector's rays, where they lie in the cells. Few bricks have any.
  HWY_INLINE void ProjectEnds(int slot, const RayTile::Ends& ends)
  {
    const D d;
    const DU du;
    const VF fraction = hn::Load(d, ends.Fraction + slot);
    const Lanes here = this->Intervals.EndsInside(slot, ends);
    if (hn::AllFalse(d, here))
    {
      return;
    }
    VU position[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      position[axis] = hn::Add(
        this->Intervals.InBrickCells(ends.Position[axis] + slot), hn::Set(du, this->ToBrick[axis]));
    }
    auto met = this->MetAt(slot);
    if constexpr (Average)
    {
      if (this->OnlyCounts)
      {
        met.AddTransparentPart(hn::IfThenElseZero(here, fraction));
        met.Keep(this->Tile, slot);
        return;
      }
    }
    Place place;
    this->Samples.Locate({ position[0], position[1], position[2] }, here, place);
    const VF value = this->Samples.ValueOf(place);
    met.AddPartial(value, this->Samples.IndicesOf(value), here, fraction);
    met.Keep(this->Tile, slot);
    this->Tile.SamplesTaken += static_cast<std::int64_t>(hn::CountTrue(d, here));
  }

  const ProjectionTable& Table;
  PacketIntervals Intervals;
  PacketSamples<Special, false, Nearest, Numbers> Samples;
  RayTile& Tile;
  bool Relative;
  bool OnlyCounts;
  float HighestRank;
  std::uint32_t ToBrick[3]; ///< to positions in the brick, modulo 256 cells
  std::uint32_t Offset[3];  ///< from the cells' low corner to the brick's
};

template <bool Special, bool Nearest, bool Average, bool Numbers = false>
void ProjectPackets(const PackedBrick& brick, const Box& cells, const ValueRange& range,
  const ProjectionTable& table, const PixelRect& pixels, RayTile& tile)
{
  PacketProjector<Special, Nearest, Average, Numbers> projector(brick, cells, range, table, tile);
  ForPacketsUnder(
    pixels, tile, [&projector](int packet) HWY_ATTR { projector.ProjectPacket(packet); });
}

void ProjectPackedHere(const PackedBrick& brick, const Box& cells, const ValueRange& range,
  const ProjectionTable& table, const PixelRect& pixels, RayTile& tile)
{
  using Project = void (*)(const PackedBrick&, const Box&, const ValueRange&,
    const ProjectionTable&, const PixelRect&, RayTile&);
  static constexpr Project projects[8] = { ProjectPackets<false, false, false>,
    ProjectPackets<true, false, false>, ProjectPackets<false, true, false>,
    ProjectPackets<true, true, false>, ProjectPackets<false, false, true>,
    ProjectPackets<true, false, true>, ProjectPackets<false, true, true>,
    ProjectPackets<true, true, true> };
  const bool hasEdges = table.ScaleOf(brick.Relative()).Lookup.Edges != nullptr;
  if (brick.HasNumbers())
  {
#if BANYAN_HAS_NUMBERS
    static constexpr Project numbers[8] = { ProjectPackets<false, false, false, true>,
      ProjectPackets<false, true, false, true>, ProjectPackets<false, false, true, true>,
      ProjectPackets<false, true, true, true>, ProjectPackets<true, false, false, true>,
      ProjectPackets<true, true, false, true>, ProjectPackets<true, false, true, true>,
      ProjectPackets<true, true, true, true> };
    const int way = (table.Nearest() ? 1 : 0) + (table.Averages() ? 2 : 0) + (hasEdges ? 4 : 0);
    return numbers[way](brick, cells, range, table, pixels, tile);
#else
    return ProjectUnpacked(brick, cells, table, pixels, tile);
#endif
  }
  const int which =
    (brick.Special() || hasEdges ? 1 : 0) + (table.Nearest() ? 2 : 0) + (table.Averages() ? 4 : 0);
  projects[which](brick, cells, range, table, pixels, tile);
}

#endif

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(ProjectPackedHere);

void ProjectPacked(const PackedBrick& brick, const Box& cells, const ValueRange& range,
  const ProjectionTable& table, const PixelRect& pixels, RayTile& tile)
{
  const PixelRect rect = Intersection(pixels, tile.Rect);
  if (!rect.Empty())
  {
    HWY_DYNAMIC_DISPATCH(ProjectPackedHere)(brick, cells, range, table, rect, tile);
  }
}

} // namespace banyan
#endif
