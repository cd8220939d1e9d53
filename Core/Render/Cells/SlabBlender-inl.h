// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see CellKernels.cxx.
#if defined(banyan_Render_Cells_SlabBlender_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Cells_SlabBlender_inl_h
#undef banyan_Render_Cells_SlabBlender_inl_h
#else
#define banyan_Render_Cells_SlabBlender_inl_h
#endif

#include "Render/Cells/CellTile.h"
#include "Render/Raycast/LightLanes-inl.h"
#include "Render/Raycast/NoteSteps-inl.h"
#include "Render/Raycast/ProjectedLanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// The samples of a row of a slab.
struct RowLanes
{
  VF Value;
  VF Cosine; ///< set if shaded
  VF Length; ///< of the interval that each stands for; 1 for whole ones
  hn::Mask<D> Drawn;
  bool Partial; ///< whether some length of those that are drawn is below 1
};

/// What a vector of rays has met of composited samples.
class Composited
{
public:
  Composited(const SlabBlend& blend, const RayTile& tile, int slot)
    : Blend(blend)
    , Lookup(blend.Relative ? blend.Table.RelativeLookup() : blend.Table.Lookup())
    , Limit(hn::Set(D(), tile.TransmittanceLimit))
    , R(hn::Load(D(), tile.Color[0] + slot))
    , G(hn::Load(D(), tile.Color[1] + slot))
    , B(hn::Load(D(), tile.Color[2] + slot))
    , T(hn::Load(D(), tile.Transmittance + slot))
  {
  }

  /// @param through what lies before lets through so much
  HWY_INLINE void ComesBehind(VF through) { this->Limit = hn::Div(this->Limit, through); }

  /// Rays that have not ended.
  HWY_INLINE hn::Mask<D> Open() const { return hn::Gt(this->T, this->Limit); }

  HWY_INLINE Steps StepsOf(const RowLanes& row) const
  {
    const D d;
    const VI entries = IndicesIn<true>(this->Lookup, row.Value);
    const Blocks whole = EntriesAt(this->Blend.Table.Steps(), entries);
    Steps steps{ whole.Of[0], whole.Of[1], whole.Of[2], whole.Of[3] };
    if (row.Partial)
    {
      const auto partial = hn::Lt(row.Length, hn::Set(d, 1.0f));
      const Steps part = OverFraction(EntriesAt(this->Blend.Table.Depths(), entries), row.Length);
      steps = { hn::IfThenElse(partial, part.R, steps.R), hn::IfThenElse(partial, part.G, steps.G),
        hn::IfThenElse(partial, part.B, steps.B),
        hn::IfThenElse(partial, part.Transmittance, steps.Transmittance) };
    }
    if (this->Blend.Shading)
    {
      steps = Lit(steps, LightOf(*this->Blend.Shading, row.Cosine), *this->Blend.Shading);
    }
    return steps;
  }

  HWY_INLINE void Add(const RowLanes& row) { this->Add(row, this->StepsOf(row)); }

  /// @param noted called with what is added
  template <class Function>
  HWY_INLINE void AddNoted(const RowLanes& row, const Function& noted)
  {
    const Steps steps = this->StepsOf(row);
    noted(steps);
    this->Add(row, steps);
  }

  HWY_INLINE void Add(const RowLanes& row, const Steps& steps)
  {
    const VF weight = hn::IfThenElseZero(row.Drawn, this->T);
    this->R = hn::Add(this->R, hn::Mul(weight, steps.R));
    this->G = hn::Add(this->G, hn::Mul(weight, steps.G));
    this->B = hn::Add(this->B, hn::Mul(weight, steps.B));
    this->T = hn::IfThenElse(row.Drawn, hn::Mul(this->T, steps.Transmittance), this->T);
  }

  HWY_INLINE void Keep(RayTile& tile, int slot) const
  {
    const D d;
    hn::Store(this->R, d, tile.Color[0] + slot);
    hn::Store(this->G, d, tile.Color[1] + slot);
    hn::Store(this->B, d, tile.Color[2] + slot);
    hn::Store(this->T, d, tile.Transmittance + slot);
  }

private:
  const SlabBlend& Blend;
  const TableLookup& Lookup;
  VF Limit;
  VF R;
  VF G;
  VF B;
  VF T;
};

/// What a vector of rays has met of a projection.
/// @tparam Met Ranks or Sums
template <class Met>
class Projected
{
public:
  Projected(const SlabBlend& blend, const RayTile& tile, int slot)
    : Lookup(blend.Projection->ScaleOf(blend.Relative).Lookup)
    , So(MetAt(blend, tile, slot, static_cast<const Met*>(nullptr)))
  {
  }

  static HWY_INLINE void ComesBehind(VF) {}
  static HWY_INLINE hn::Mask<D> Open() { return hn::Eq(hn::Zero(D()), hn::Zero(D())); }

  HWY_INLINE void Add(const RowLanes& row)
  {
    const D d;
    const VI entries = IndicesIn<true>(this->Lookup, row.Value);
    const auto whole = hn::Ge(row.Length, hn::Set(d, 1.0f));
    this->So.Add(row.Value, entries, hn::And(row.Drawn, whole));
    if (row.Partial)
    {
      this->So.AddPartial(row.Value, entries, hn::AndNot(whole, row.Drawn), row.Length);
    }
  }

  /// Projections have no segments.
  template <class Function>
  HWY_INLINE void AddNoted(const RowLanes& row, const Function&)
  {
    this->Add(row);
  }

  HWY_INLINE void Keep(RayTile& tile, int slot) const { this->So.Keep(tile, slot); }

private:
  static HWY_INLINE Ranks MetAt(const SlabBlend& blend, const RayTile& tile, int slot, const Ranks*)
  {
    return Ranks(*blend.Projection, tile, slot);
  }
  static HWY_INLINE Sums MetAt(const SlabBlend& blend, const RayTile& tile, int slot, const Sums*)
  {
    return Sums(*blend.Projection, tile, slot, blend.Relative);
  }

  const TableLookup& Lookup;
  Met So;
};

/// Blends the rows of a slab front to back.
/// @tparam Met Composited or Projected
template <class Met>
class SlabBlender
{
public:
  SlabBlender(
    SampleSlab& slab, const TileRows& rows, int firstRow, const SlabBlend& blend, RayTile& tile)
    : Slab(slab)
    , Rows(rows)
    , FirstRow(firstRow)
    , How(blend)
    , Tile(tile)
  {
  }

  void Blend()
  {
    this->ForLanes([this](int packet, int lane) { this->BlendLanes(packet, lane); });
  }

protected:
  static constexpr int Lanes = static_cast<int>(hn::MaxLanes(D()));

  /// Calls function(packet, lane) for vectors of rays that have something in the slab, and forgets
  /// that they have.
  template <class Function>
  HWY_INLINE void ForLanes(const Function& function)
  {
    for (int packet = 0; packet < SampleSlab::Packets; ++packet)
    {
      if ((this->Slab.Marks[packet] | this->Slab.Borders[packet]) != 0)
      {
        for (int i = 0; i < RayTile::PacketSize; i += Lanes)
        {
          function(packet, i);
        }
        this->Slab.Marks[packet] = 0;
        this->Slab.Borders[packet] = 0;
      }
    }
  }

  void BlendLanes(int packet, int lane)
  {
    const D d;
    const int slot = packet * RayTile::PacketSize + lane;
    Met met(this->How, this->Tile, slot);
    auto open = met.Open();
    const std::size_t before = hn::CountTrue(d, open);
    const VF nothing = hn::Set(d, SampleSlab::Nothing);
    const std::uint64_t borders = this->Slab.Borders[packet];
    for (std::uint64_t bits = this->Slab.Marks[packet] | borders; bits != 0; bits &= bits - 1)
    {
      const int row = __builtin_ctzll(bits);
      const int index = SampleSlab::IndexOf(slot, row);
      // Rows are cleared when all rays have ended, too.
      const RowLanes lanes = this->RowAt(slot, row, index, (borders >> row & 1) != 0, open);
      hn::Store(nothing, d, this->Slab.Value + index);
      if (!hn::AllFalse(d, lanes.Drawn))
      {
        if (this->Tile.Log)
        {
          met.AddNoted(
            lanes, [&](const Steps& steps) HWY_ATTR { this->Note(slot, row, lanes.Drawn, steps); });
        }
        else
        {
          met.Add(lanes);
        }
        open = met.Open();
        this->Tile.SamplesTaken += static_cast<std::int64_t>(hn::CountTrue(d, lanes.Drawn));
      }
    }
    met.Keep(this->Tile, slot);
    // Rays without samples were never counted, and never end.
    this->Tile.ActiveRays -= static_cast<std::int64_t>(before - hn::CountTrue(d, open));
  }

  void Note(int slot, int row, hn::Mask<D> lanes, const Steps& steps) const
  {
    const int here = this->FirstRow + row;
    alignas(64) std::int32_t samples[RayTile::PacketSize];
    for (int i = 0; i < Lanes; ++i)
    {
      const int at = slot + i;
      samples[i] = here == this->Rows.Head[at]   ? SegmentLog::Head
                   : here == this->Rows.Tail[at] ? SegmentLog::Tail
                                                 : here - this->Rows.First[at];
    }
    NoteSteps(*this->Tile.Log, slot, hn::Load(DI(), samples), lanes, steps);
  }

  /// @param border whether rays cross the border of the mesh in this row
  HWY_INLINE RowLanes RowAt(int slot, int row, int index, bool border, hn::Mask<D> open) const
  {
    const D d;
    RowLanes lanes;
    lanes.Value = hn::Load(d, this->Slab.Value + index);
    lanes.Cosine = this->How.Shading ? hn::Load(d, this->Slab.Cosine + index) : hn::Zero(d);
    lanes.Length = this->LengthsAt(slot, this->FirstRow + row);
    const auto inside = hn::Eq(lanes.Value, lanes.Value);
    if (border)
    {
      const auto at = [&](const float* numbers) HWY_ATTR { return hn::Load(d, numbers + index); };
      const VF covered =
        hn::Add(hn::Add(hn::IfThenElseZero(inside, lanes.Length), at(this->Slab.Change)),
          this->ChangeOfNearest(index, inside, lanes.Length));
      lanes.Length = hn::Min(hn::Max(covered, hn::Zero(d)), lanes.Length);
      // No numbers where nothing was crossed.
      const VF crossings = at(this->Slab.Crossings);
      lanes.Value =
        hn::IfThenElse(inside, lanes.Value, hn::Div(at(this->Slab.AtBorder), crossings));
      lanes.Cosine =
        hn::IfThenElse(inside, lanes.Cosine, hn::Div(at(this->Slab.CosineAtBorder), crossings));
    }
    lanes.Value = hn::Add(lanes.Value, hn::Set(d, this->How.Shift));
    lanes.Drawn =
      hn::And(hn::And(hn::Eq(lanes.Value, lanes.Value), open), hn::Gt(lanes.Length, hn::Zero(d)));
    // Memory of other lanes may hold anything, and cosines become places in a table.
    lanes.Cosine = hn::IfThenElseZero(lanes.Drawn, lanes.Cosine);
    lanes.Partial = !hn::AllFalse(d, hn::And(lanes.Drawn, hn::Lt(lanes.Length, hn::Set(d, 1.0f))));
    return lanes;
  }

  /// What changes where the crossing nearest to a sample counts as before or behind it by what the
  /// sample's cell says: where the ray would be in the mesh twice, or less than not at all, at an
  /// end of the interval. Two faces in the same place, of cells that do not match, cancel.
  HWY_INLINE VF ChangeOfNearest(int index, hn::Mask<D> inside, VF length) const
  {
    const D d;
    const VF zero = hn::Zero(d);
    const VF one = hn::Set(d, 1.0f);
    const VF in = hn::IfThenElseZero(inside, one);
    const VF begins = hn::Sub(in, hn::Load(d, this->Slab.Before + index));
    const VF ends = hn::Add(in, hn::Load(d, this->Slab.Behind + index));
    const auto odd =
      hn::Or(hn::Lt(hn::Min(begins, ends), zero), hn::Gt(hn::Max(begins, ends), one));
    const VF nearest = hn::Load(d, this->Slab.Nearest + index);
    const VF enters = hn::Load(d, this->Slab.NearestEnters + index);
    const auto isNear = hn::And(odd, hn::Lt(hn::Abs(nearest), hn::Set(d, SampleSlab::NearSample)));
    const auto before = hn::Lt(nearest, zero);
    // Behind an entry the sample is inside, behind an exit it is not.
    const auto told = hn::Not(hn::Xor(inside, hn::Gt(enters, zero)));
    const VF change = hn::Mul(enters, length);
    return hn::IfThenElseZero(
      isNear, hn::Sub(hn::IfThenElseZero(before, change), hn::IfThenElseZero(told, change)));
  }

  /// Lengths of the intervals of a row: 1 but for heads and tails.
  HWY_INLINE VF LengthsAt(int slot, int row) const
  {
    const D d;
    const DI di;
    const VF one = hn::Set(d, 1.0f);
    if (!this->Rows.AnyEnds)
    {
      return one;
    }
    const VI here = hn::Set(di, row);
    const auto isHead = hn::RebindMask(d, hn::Eq(hn::Load(di, this->Rows.Head + slot), here));
    const auto isTail = hn::RebindMask(d, hn::Eq(hn::Load(di, this->Rows.Tail + slot), here));
    return hn::IfThenElse(isHead, hn::Load(d, this->Tile.Head.Fraction + slot),
      hn::IfThenElse(isTail, hn::Load(d, this->Tile.Tail.Fraction + slot), one));
  }

  SampleSlab& Slab;
  const TileRows& Rows;
  int FirstRow;
  const SlabBlend& How;
  RayTile& Tile;
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
