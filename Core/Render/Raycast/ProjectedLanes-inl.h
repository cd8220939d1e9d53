// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see PacketMarcher.cxx.
#if defined(banyan_Render_Raycast_ProjectedLanes_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Raycast_ProjectedLanes_inl_h
#undef banyan_Render_Raycast_ProjectedLanes_inl_h
#else
#define banyan_Render_Raycast_ProjectedLanes_inl_h
#endif

#include "Render/Bricks/PacketVectors-inl.h"
#include "Render/Raycast/RayTile.h"
#include "Render/Scene/ProjectionTable.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// What a vector of rays has met of ranks: a maximum.
class Ranks
{
public:
  using Lanes = hn::Mask<D>;

  Ranks(const ProjectionTable& table, const RayTile& tile, int slot)
    : Transparent(hn::Set(DI(), table.Transparent()))
    , Flip(hn::Set(DI(), table.Blend() == BlendMode::Minimum ? -1 : 0))
    , Shift(hn::Set(DI(), table.Blend() == BlendMode::Minimum ? table.Transparent() + 1 : 1))
    , Best(hn::ConvertTo(DI(), hn::Load(D(), tile.Color[0] + slot)))
  {
  }

  /// As ProjectionTable::RankOf.
  HWY_INLINE void Add(VF, VI entry, Lanes lanes)
  {
    const DI d;
    const VI rank = hn::Add(hn::Xor(entry, this->Flip), this->Shift);
    const auto counts = hn::And(hn::Lt(entry, this->Transparent), hn::RebindMask(d, lanes));
    this->Best = hn::Max(this->Best, hn::IfThenElseZero(counts, rank));
  }

  HWY_INLINE void AddPartial(VF value, VI entry, Lanes lanes, VF)
  {
    this->Add(value, entry, lanes);
  }

  HWY_INLINE void Keep(RayTile& tile, int slot) const
  {
    hn::Store(hn::ConvertTo(D(), this->Best), D(), tile.Color[0] + slot);
  }

private:
  VI Transparent;
  VI Flip; ///< all bits: -1 - entry
  VI Shift;
  VI Best;
};

/// What a vector of rays has met of values for an average.
class Sums
{
public:
  using Lanes = hn::Mask<D>;

  Sums(const ProjectionTable& table, const RayTile& tile, int slot, bool relative)
    : Scale(table.ScaleOf(relative))
    , Opacities(table.OpacityOfEntries())
    , Transparent(hn::Set(DI(), table.Transparent()))
    , Sum(hn::Load(D(), tile.Color[0] + slot))
    , Count(hn::Load(D(), tile.Color[1] + slot))
    , Partial(hn::Load(D(), tile.Color[2] + slot))
  {
  }

  HWY_INLINE void Add(VF value, VI entry, Lanes lanes)
  {
    const Lanes counts = this->Counts(value, entry, lanes);
    this->Sum = hn::Add(this->Sum, hn::IfThenElseZero(counts, this->Level(value, entry)));
    this->Count = hn::Add(this->Count, hn::IfThenElseZero(counts, hn::Set(D(), 1.0f)));
  }

  HWY_INLINE void AddPartial(VF value, VI entry, Lanes lanes, VF fraction)
  {
    const Lanes counts = this->Counts(value, entry, lanes);
    const VF part = hn::Mul(this->Level(value, entry), fraction);
    this->Sum = hn::Add(this->Sum, hn::IfThenElseZero(counts, part));
    this->Partial = hn::Add(this->Partial, hn::IfThenElseZero(counts, fraction));
  }

  /// Samples that all count and are all transparent.
  HWY_INLINE void AddTransparent(VF count) { this->Count = hn::Add(this->Count, count); }
  HWY_INLINE void AddTransparentPart(VF part) { this->Partial = hn::Add(this->Partial, part); }

  HWY_INLINE void Keep(RayTile& tile, int slot) const
  {
    hn::Store(this->Sum, D(), tile.Color[0] + slot);
    hn::Store(this->Count, D(), tile.Color[1] + slot);
    hn::Store(this->Partial, D(), tile.Color[2] + slot);
  }

private:
  HWY_INLINE Lanes Counts(VF value, VI entry, Lanes lanes) const
  {
    const D d;
    const Lanes exists = hn::RebindMask(d, hn::Lt(entry, this->Transparent));
    const Lanes inside = hn::And(hn::Ge(value, hn::Set(d, this->Scale.LowestCounted)),
      hn::Le(value, hn::Set(d, this->Scale.HighestCounted)));
    return hn::And(hn::And(exists, inside), lanes);
  }

  HWY_INLINE VF Level(VF value, VI entry) const
  {
    const D d;
    const VF level =
      hn::Mul(hn::Sub(value, hn::Set(d, this->Scale.Black)), hn::Set(d, this->Scale.PerValue));
    const VF notBelow = hn::IfThenElseZero(hn::Gt(level, hn::Zero(d)), level);
    const VF one = hn::Set(d, 1.0f);
    const VF inside = hn::IfThenElse(hn::Lt(notBelow, one), notBelow, one);
    return hn::Mul(inside, hn::GatherIndex(d, this->Opacities, entry));
  }

  const ProjectionTable::Scale& Scale;
  const float* Opacities;
  VI Transparent;
  VF Sum;
  VF Count;
  VF Partial;
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
