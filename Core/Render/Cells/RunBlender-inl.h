// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see CellKernels.cxx.
#if defined(banyan_Render_Cells_RunBlender_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Cells_RunBlender_inl_h
#undef banyan_Render_Cells_RunBlender_inl_h
#else
#define banyan_Render_Cells_RunBlender_inl_h
#endif

#include "Render/Cells/RunCollector.h"
#include "Render/Cells/SlabBlender-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Blends the rows of a slab front to back into runs, which end where other ranks may have a say.
template <class Met>
class RunBlender : private SlabBlender<Met>
{
  using Blender = SlabBlender<Met>;

public:
  RunBlender(SampleSlab& slab, const TileRows& rows, int firstRow, const SlabBlend& blend,
    RayTile& tile, const SlabOwners& owners, RunCollector& collector)
    : Blender(slab, rows, firstRow, blend, tile)
    , Owners(owners)
    , Collector(collector)
  {
  }

  void Blend()
  {
    this->ForLanes(
      [this](int packet, int lane)
      {
        std::uint64_t rows = this->Slab.Marks[packet] | this->Slab.Borders[packet];
        while (rows != 0)
        {
          rows = this->BlendUntilOneEnds(packet, lane, rows);
        }
      });
  }

private:
  using Blender::Lanes;

  /// Goes on until the runs of some rays end, and ends them.
  /// @param bits rows that are left
  /// @return those that are left then: the next one ends no run
  std::uint64_t BlendUntilOneEnds(int packet, int lane, std::uint64_t bits)
  {
    const D d;
    const DI di;
    const int slot = packet * RayTile::PacketSize + lane;
    const VF through = hn::Load(d, this->Collector.Through + slot);
    Met met(this->How, this->Tile, slot);
    met.ComesBehind(through);
    VI last = hn::Load(di, this->Collector.Last + slot);
    auto open = met.Open();
    const std::size_t before = hn::CountTrue(d, open);
    const std::uint64_t borders = this->Slab.Borders[packet];
    std::uint64_t ended = 0;
    for (; bits != 0; bits &= bits - 1)
    {
      const int row = __builtin_ctzll(bits);
      const int index = SampleSlab::IndexOf(slot, row);
      const bool border = (borders >> row & 1) != 0;
      RowLanes lanes = this->RowAt(slot, row, index, border, open);
      const auto raw = this->RawAt(lanes, slot, row, border, open);
      lanes.Drawn = hn::AndNot(raw, lanes.Drawn);
      const VI here = hn::Set(di, this->FirstRow + row);
      const auto runs = hn::RebindMask(d, hn::Gt(last, hn::Set(di, RunCollector::None)));
      // With the row before, or with none: where there is no run, nothing goes on.
      const VI nextTo = this->Collector.IsSingle() ? hn::Set(di, RunCollector::None)
                                                   : hn::Sub(here, hn::Set(di, 1));
      const auto goesOn = hn::RebindMask(d, hn::Eq(last, nextTo));
      const auto ends = hn::And(runs, hn::Or(raw, hn::AndNot(goesOn, lanes.Drawn)));
      if (!hn::AllFalse(d, ends))
      {
        hn::StoreMaskBits(d, ends, reinterpret_cast<std::uint8_t*>(&ended));
        break;
      }
      this->TakeRaw(raw, slot, row);
      hn::Store(hn::Set(d, SampleSlab::Nothing), d, this->Slab.Value + index);
      if (!hn::AllFalse(d, lanes.Drawn))
      {
        hn::BlendedStore(here, hn::RebindMask(di, hn::AndNot(runs, lanes.Drawn)), di,
          this->Collector.First + slot);
        last = hn::IfThenElse(hn::RebindMask(di, lanes.Drawn), here, last);
        met.Add(lanes);
        open = met.Open();
        this->Tile.SamplesTaken += static_cast<std::int64_t>(hn::CountTrue(d, lanes.Drawn));
      }
    }
    met.Keep(this->Tile, slot);
    hn::Store(last, di, this->Collector.Last + slot);
    hn::Store(hn::IfThenElseZero(open, through), d, this->Collector.Through + slot);
    this->Tile.ActiveRays -= static_cast<std::int64_t>(before - hn::CountTrue(d, open));
    this->Collector.Close(ended, slot, this->Tile);
    return bits;
  }

  /// Lanes whose intervals are given raw: samples next to faces that no other cell of the piece
  /// has, crossings of the border that cover nothing, and what is asked for.
  HWY_INLINE hn::Mask<D> RawAt(
    const RowLanes& lanes, int slot, int row, bool border, hn::Mask<D> open) const
  {
    const D d;
    const DI di;
    const int index = SampleSlab::IndexOf(slot, row);
    const VI owners = hn::Load(di, reinterpret_cast<const std::int32_t*>(this->Owners.Of) + index);
    const VF value = hn::Load(d, this->Slab.Value + index);
    // SlabOwners::Contested, where the sample is a cell's.
    const auto contested =
      hn::And(hn::Eq(value, value), hn::RebindMask(d, hn::Lt(owners, hn::Zero(di))));
    auto some = lanes.Drawn;
    if (border)
    {
      const VF crossings = hn::Load(d, this->Slab.Crossings + index);
      some = hn::Or(some, hn::And(open, hn::Gt(crossings, hn::Zero(d))));
    }
    auto raw = hn::Or(hn::And(some, contested), hn::AndNot(lanes.Drawn, some));
    if (this->Collector.IsAsked())
    {
      alignas(64) std::int32_t asked[RayTile::PacketSize];
      for (int i = 0; i < Lanes; ++i)
      {
        asked[i] = this->Collector.AsksFor(this->Tile, slot + i, this->FirstRow + row) ? 1 : 0;
      }
      const auto wanted = hn::RebindMask(d, hn::Gt(hn::Load(di, asked), hn::Zero(di)));
      raw = hn::Or(raw, hn::And(some, wanted));
    }
    return raw;
  }

  HWY_INLINE void TakeRaw(hn::Mask<D> raw, int slot, int row)
  {
    std::uint64_t bits = 0;
    hn::StoreMaskBits(D(), raw, reinterpret_cast<std::uint8_t*>(&bits));
    for (; bits != 0; bits &= bits - 1)
    {
      this->Collector.AddRaw(this->Slab, this->Owners, this->Rows, this->FirstRow,
        slot + __builtin_ctzll(bits), row, this->How.Shading != nullptr, this->Tile);
    }
  }

  const SlabOwners& Owners;
  RunCollector& Collector;
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
