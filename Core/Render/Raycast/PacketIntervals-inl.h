// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see PacketMarcher.cxx.
#if defined(banyan_Render_Raycast_PacketIntervals_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Raycast_PacketIntervals_inl_h
#undef banyan_Render_Raycast_PacketIntervals_inl_h
#else
#define banyan_Render_Raycast_PacketIntervals_inl_h
#endif

#include "Render/Raycast/PacketSamples-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

using DD = hn::Repartition<double, D>;
using DHalf = hn::Rebind<std::int32_t, DD>;
using VD = hn::Vec<DD>;
using VHalf = hn::Vec<DHalf>;

/// Where rays may be inside some cells, in whole samples: ends are at most two samples early and
/// never late. Rays that miss the cells begin where they have no more samples.
struct Estimate
{
  VI Begin;
  VI End;
  VI Counts;
  bool MayHaveHead;
  bool MayHaveTail;
};

/// Whole samples that are inside, exactly.
struct Whole
{
  VU First[3]; ///< position of the first one from the cells' low corner, modulo 256 cells
  VI Begin;    ///< its number
  VI Count;
};

/// Calls function(number) for the packets of a tile under some pixels of it.
template <class Function>
HWY_INLINE void ForPacketsUnder(const PixelRect& pixels, const RayTile& tile, Function&& function)
{
  const PixelRect packets = tile.PacketsUnder(pixels);
  for (int y = packets.Lo.y; y < packets.Hi.y; ++y)
  {
    for (int x = packets.Lo.x; x < packets.Hi.x; ++x)
    {
      function(y * RayTile::PacketsPerRow + x);
    }
  }
}

/// Finds which whole samples of rays lie in a box of cells: what RaySamples::SamplesIn finds.
class PacketIntervals
{
public:
  /// @param cells 2^CellShift times as short as those of the rays
  PacketIntervals(const RayTile& tile, const Box& cells)
    : Tile(tile)
  {
    const int larger = tile.CellShift - tile.BrickShift;
    for (int axis = 0; axis < 3; ++axis)
    {
      this->LowFace[axis] = std::ldexp(cells.Lo[axis], -tile.CellShift);
      this->HighFace[axis] = std::ldexp(cells.Hi[axis], -tile.CellShift);
      this->Low[axis] = static_cast<std::uint32_t>(ToFixed(cells.Lo[axis]) >> larger);
      this->Size[axis] = static_cast<std::uint32_t>(ToFixed(cells.Size()[axis]) >> larger);
      this->LowCell[axis] = cells.Lo[axis];
      this->CellCount[axis] = static_cast<std::uint32_t>(cells.Size()[axis]);
    }
  }

  /// A step or position of a vector's rays in cells of the brick, modulo 256 of them.
  HWY_INLINE VU InBrickCells(const std::uint32_t* positions) const
  {
    return hn::ShiftLeftSame(hn::Load(DU(), positions), this->Tile.BrickShift);
  }

  /// The lanes whose head or tail lies in the cells.
  HWY_INLINE hn::Mask<D> EndsInside(int slot, const RayTile::Ends& ends) const
  {
    const D d;
    const DU du;
    auto inside = hn::Gt(hn::Load(d, ends.Fraction + slot), hn::Zero(d));
    for (int axis = 0; axis < 3; ++axis)
    {
      const VI large = hn::Load(DI(), ends.Cell[axis] + slot);
      const VU fraction =
        hn::And(hn::Load(du, ends.Position[axis] + slot), hn::Set(du, (1u << FractionBits) - 1));
      const VU part = hn::ShiftRightSame(fraction, FractionBits - this->Tile.CellShift);
      const VU cell = hn::Or(hn::BitCast(du, hn::ShiftLeftSame(large, this->Tile.CellShift)), part);
      const VU from = hn::Sub(cell, hn::Set(du, static_cast<std::uint32_t>(this->LowCell[axis])));
      inside = hn::And(inside, hn::RebindMask(d, hn::Lt(from, hn::Set(du, this->CellCount[axis]))));
    }
    return inside;
  }

  HWY_INLINE Estimate EstimateAt(int slot) const
  {
    Estimate result;
    result.Counts = hn::Load(DI(), this->Tile.Count + slot);
    Half lower;
    Half upper;
    this->EstimateHalf(slot, hn::PromoteTo(DD(), hn::LowerHalf(result.Counts)), lower);
    this->EstimateHalf(slot + static_cast<int>(hn::Lanes(DD())),
      hn::PromoteTo(DD(), hn::UpperHalf(DHalf(), result.Counts)), upper);
    result.Begin = hn::Combine(DI(), upper.Begin, lower.Begin);
    result.End = hn::Combine(DI(), upper.End, lower.End);
    result.MayHaveHead = lower.MayHaveHead | upper.MayHaveHead;
    result.MayHaveTail = lower.MayHaveTail | upper.MayHaveTail;
    return result;
  }

  HWY_INLINE Whole FindAt(int slot, const Estimate& estimate) const
  {
    const DI di;
    const VI one = hn::Set(di, 1);
    VU step[3];
    Whole result;
    // Rays that miss the box begin behind their last sample. A sixth of all vectors has no others.
    if (hn::AllFalse(di, hn::Lt(estimate.Begin, estimate.Counts)))
    {
      result.First[0] = result.First[1] = result.First[2] = hn::Zero(DU());
      result.Begin = result.Count = hn::Zero(di);
      return result;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      step[axis] = this->InBrickCells(this->Tile.Step[axis] + slot);
      result.First[axis] = this->PositionAt(slot, axis, step[axis], estimate.Begin);
    }
    VI begin = estimate.Begin;
    for (int i = 0; i < 2; ++i)
    {
      const auto early = hn::Not(this->Inside(result.First));
      begin = hn::Add(begin, hn::IfThenElseZero(hn::RebindMask(di, early), one));
      for (int axis = 0; axis < 3; ++axis)
      {
        result.First[axis] = hn::Add(result.First[axis], hn::IfThenElseZero(early, step[axis]));
      }
    }
    const auto some =
      hn::And(hn::RebindMask(di, this->Inside(result.First)), hn::Lt(begin, estimate.Counts));
    VI end = hn::Max(estimate.End, hn::Add(begin, one));
    VU last[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      last[axis] = this->PositionAt(slot, axis, step[axis], end);
    }
    auto more = hn::And(some, this->MoreAt(last, end, estimate.Counts));
    while (!hn::AllFalse(di, more))
    {
      end = hn::Add(end, hn::IfThenElseZero(more, one));
      for (int axis = 0; axis < 3; ++axis)
      {
        last[axis] = hn::Add(last[axis], step[axis]);
      }
      more = hn::And(more, this->MoreAt(last, end, estimate.Counts));
    }
    result.Begin = begin;
    result.Count = hn::IfThenElseZero(some, hn::Sub(end, begin));
    return result;
  }

private:
  struct Half
  {
    VHalf Begin;
    VHalf End;
    bool MayHaveHead;
    bool MayHaveTail;
  };

  HWY_INLINE void EstimateHalf(int slot, VD counts, Half& half) const
  {
    const DD d;
    VD in = hn::Set(d, -1e9);
    VD out = hn::Set(d, 1e9);
    for (int axis = 0; axis < 3; ++axis)
    {
      const VD start = hn::Load(d, this->Tile.Start[axis] + slot);
      const VD inverse = hn::Load(d, this->Tile.Inverse[axis] + slot);
      const VD low = hn::Mul(hn::Sub(hn::Set(d, this->LowFace[axis]), start), inverse);
      const VD high = hn::Mul(hn::Sub(hn::Set(d, this->HighFace[axis]), start), inverse);
      in = hn::Max(in, hn::Min(low, high));
      out = hn::Min(out, hn::Max(low, high));
    }
    // Heads lie at most one sample before sample 0, tails one behind the last.
    const VD one = hn::Set(d, 1.0);
    const auto meets = hn::Lt(in, hn::Add(out, one));
    const auto head = hn::And(hn::Le(in, hn::Zero(d)), hn::Ge(out, hn::Set(d, -1.5)));
    const auto tail = hn::And(hn::Le(in, hn::Add(counts, one)), hn::Ge(out, hn::Sub(counts, one)));
    half.MayHaveHead = !hn::AllFalse(d, hn::And(meets, head));
    half.MayHaveTail = !hn::AllFalse(d, hn::And(meets, tail));
    const VD first = hn::Max(in, hn::Zero(d));
    const VD last = hn::Min(out, counts);
    const VD begin = hn::IfThenElse(hn::Lt(first, hn::Add(last, one)), first, counts);
    half.Begin = hn::DemoteTo(DHalf(), hn::Min(begin, counts));
    half.End = hn::DemoteTo(DHalf(), last);
  }

  HWY_INLINE VU PositionAt(int slot, int axis, VU step, VI sample) const
  {
    const DU du;
    const VU base = this->InBrickCells(this->Tile.Base[axis] + slot);
    return hn::Sub(
      hn::Add(base, hn::Mul(step, hn::BitCast(du, sample))), hn::Set(du, this->Low[axis]));
  }

  HWY_INLINE hn::Mask<DU> Inside(const VU (&position)[3]) const
  {
    const DU du;
    return hn::And(hn::Lt(position[0], hn::Set(du, this->Size[0])),
      hn::And(hn::Lt(position[1], hn::Set(du, this->Size[1])),
        hn::Lt(position[2], hn::Set(du, this->Size[2]))));
  }

  HWY_INLINE hn::Mask<DI> MoreAt(const VU (&position)[3], VI sample, VI counts) const
  {
    return hn::And(hn::RebindMask(DI(), this->Inside(position)), hn::Lt(sample, counts));
  }

  const RayTile& Tile;
  double LowFace[3];
  double HighFace[3];
  /// Fixed-point position of the cells' low corner in cells of the brick, modulo 256 of them.
  std::uint32_t Low[3];
  std::uint32_t Size[3]; ///< fixed-point
  std::int32_t LowCell[3];
  std::uint32_t CellCount[3];
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
