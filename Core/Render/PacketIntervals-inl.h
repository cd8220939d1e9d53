// Included once per SIMD target: see PacketMarcher.cxx.
#if defined(banyan_Render_PacketIntervals_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_PacketIntervals_inl_h
#undef banyan_Render_PacketIntervals_inl_h
#else
#define banyan_Render_PacketIntervals_inl_h
#endif

#include "Render/PacketSamples-inl.h"

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
  VI Count;
};

/// Finds which whole samples of rays lie in a box of cells: what RaySamples::SamplesIn finds.
class PacketIntervals
{
public:
  PacketIntervals(const RayTile& tile, const Box& cells)
    : Tile(tile)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->LowFace[axis] = cells.Lo[axis];
      this->HighFace[axis] = cells.Hi[axis];
      this->Low[axis] = static_cast<std::uint32_t>(ToFixed(cells.Lo[axis]));
      this->Size[axis] = static_cast<std::uint32_t>(ToFixed(cells.Size()[axis]));
    }
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
    for (int axis = 0; axis < 3; ++axis)
    {
      step[axis] = hn::Load(DU(), this->Tile.Step[axis] + slot);
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
    const VU base = hn::Load(du, this->Tile.Base[axis] + slot);
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
  std::uint32_t Low[3];  ///< fixed-point position of the cells' low corner, modulo 256 cells
  std::uint32_t Size[3]; ///< fixed-point
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
