// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see PacketMarcher.cxx.
#if defined(banyan_Render_Raycast_PacketSamples_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Raycast_PacketSamples_inl_h
#undef banyan_Render_Raycast_PacketSamples_inl_h
#else
#define banyan_Render_Raycast_PacketSamples_inl_h
#endif

#include "Render/Bricks/Interpolators.h"
#include "Render/Bricks/PackedBrick.h"
#include "Render/Bricks/PacketVectors-inl.h"
#include "Render/Raycast/ColourLanes-inl.h"
#include "Render/Raycast/HiddenLanes-inl.h"
#include "Render/Raycast/LightLanes-inl.h"

#include <hwy/cache_control.h>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// A position in a brick per lane: 8 bits of cells above 24 bits of fraction.
struct Position
{
  VU X;
  VU Y;
  VU Z;
};

/// Samples of a packed brick: value by value what PlainInterpolator and TableLookup give.
/// @tparam Special whether values may not be finite, or the table may have edges
/// @tparam Shaded whether the brick has gradients, and samples are shaded by them
/// @tparam Nearest whether samples are those of the grid nearest by
/// @tparam Numbers whether the brick has 16-bit numbers; it is not shaded
/// @tparam Coloured whether the brick has colours, which the table's are multiplied by
template <bool Special, bool Shaded, bool Nearest, bool Numbers = false, bool Coloured = false>
class PacketSamples
{
public:
  static constexpr bool IsShaded = Shaded;

  PacketSamples(const PackedBrick& brick, const StepTable& table, const ShadingTable* shading)
    : PacketSamples(brick, brick.Relative() ? table.RelativeLookup() : table.Lookup())
  {
    this->Table = table.Steps();
    this->Depths = table.Depths();
    this->Shading = shading;
  }

  /// For values and their entries alone.
  PacketSamples(const PackedBrick& brick, const TableLookup& lookup)
    : Values(Numbers ? reinterpret_cast<const char*>(brick.NumbersOfSamples())
                     : reinterpret_cast<const char*>(brick.Values()))
    , RowBytes(static_cast<std::int32_t>(brick.StrideY() * UnitBytes))
    , SliceBytes(static_cast<std::int32_t>(brick.StrideZ() * UnitBytes))
    , Scale(brick.Scale())
    , Lookup(lookup)
    , Colours(brick)
    , Hidden(brick.Hidden())
  {
  }

  // A sample takes three steps, each of which waits for memory. They are separate, so that those of
  // successive samples can be mixed.

  struct Place
  {
    Offsets Cell;
    VF X;
    VF Y;
    VF Z;
    VI Hidden; ///< set if Special: not 0 in lanes whose cell is hidden
  };

  /// @param mask lanes whose position is inside the brick
  template <class Mask>
  HWY_INLINE void Locate(const Position& position, Mask mask, Place& place) const
  {
    const DI d;
    const VI bytes = hn::Add(hn::ShiftLeft < Shaded ? 4
                             : Numbers              ? 1
                                                    : 2 > (CellOf(position.X)),
      hn::Add(hn::Mul(CellOf(position.Y), hn::Set(d, this->RowBytes)),
        hn::Mul(CellOf(position.Z), hn::Set(d, this->SliceBytes))));
    place.Cell.Set(hn::IfThenElseZero(hn::RebindMask(d, mask), bytes));
    if constexpr (Special)
    {
      place.Hidden = this->Hidden.Any() ? this->Hidden.At(position.X, position.Y, position.Z,
                                            hn::RebindMask(d, mask))
                                        : hn::Zero(d);
    }
    if constexpr (Shaded)
    {
      this->AskAhead(place);
    }
    if constexpr (!Nearest)
    {
      place.X = FractionOf(position.X);
      place.Y = FractionOf(position.Y);
      place.Z = FractionOf(position.Z);
    }
  }

  /// A sample of which the entry in the table is known.
  struct Found
  {
    Offsets Entries;
    Light Shade;            ///< set if Shaded
    ColourLanes::Tint Tint; ///< set if Coloured
  };

  /// Interpolates, and finds the entries of the table.
  HWY_INLINE void Interpolate(const Place& place, const Direction& direction, Found& found) const
  {
    VF value;
    if constexpr (Shaded)
    {
      const Blocks mixed = this->ValuesAndGradients(place);
      value = mixed.Of[0];
      this->ShadeOf(mixed.Of[1], mixed.Of[2], mixed.Of[3], direction, found);
      value = ShownOf(place, value);
    }
    else
    {
      value = this->ValueOf(place);
    }
    if constexpr (Coloured)
    {
      this->TintOf(place, found);
    }
    found.Entries.Set(hn::ShiftLeft<4>(this->IndicesOf(value)));
  }

  /// Without gradients; not a number in hidden cells.
  HWY_INLINE VF ValueOf(const Place& place) const
  {
    return ShownOf(place, this->MixedValueOf(place));
  }

  /// As TableLookup::IndexOf.
  HWY_INLINE VI IndicesOf(VF value) const { return IndicesIn<Special>(this->Lookup, value); }

  HWY_INLINE Steps LookUp(const Found& found) const
  {
    const Blocks steps = Transposed(LoadBlocks(this->Table, found.Entries));
    return this->Shown({ steps.Of[0], steps.Of[1], steps.Of[2], steps.Of[3] }, found);
  }

  /// As StepTable::Partial, with transmittance in place of opacity.
  HWY_INLINE Steps LookUp(const Found& found, VF fraction) const
  {
    const Blocks depths = Transposed(LoadBlocks(this->Depths, found.Entries));
    return this->Shown(OverFraction(depths, fraction), found);
  }

private:
  static HWY_INLINE VF ShownOf([[maybe_unused]] const Place& place, VF value)
  {
    if constexpr (Special)
    {
      const auto shown = hn::RebindMask(D(), hn::Eq(place.Hidden, hn::Zero(DI())));
      const VF none = hn::Set(D(), std::numeric_limits<float>::quiet_NaN());
      return hn::IfThenElse(shown, value, none);
    }
    return value;
  }

  HWY_INLINE VF MixedValueOf(const Place& place) const
  {
    static_assert(!Shaded, "one float per sample");
    if constexpr (Nearest)
    {
      const VI bytes = hn::Load(DI(), place.Cell.Bytes);
      if constexpr (Numbers)
      {
        // Two of them, of which the latter goes.
        const auto* numbers = reinterpret_cast<const std::int32_t*>(this->Values);
        const VI two = hn::GatherOffset(DI(), numbers, bytes);
        return this->ValuesOf(hn::ConvertTo(D(), hn::ShiftRight<16>(hn::ShiftLeft<16>(two))));
      }
      else
      {
        return hn::GatherOffset(D(), reinterpret_cast<const float*>(this->Values), bytes);
      }
    }
    else
    {
      const Blocks edges = Transposed({ { this->MixedAlongZ<0>(place), this->MixedAlongZ<1>(place),
        this->MixedAlongZ<2>(place), this->MixedAlongZ<3>(place) } });
      return Mix(
        Mix(edges.Of[0], edges.Of[2], place.Y), Mix(edges.Of[1], edges.Of[3], place.Y), place.X);
    }
  }

  HWY_INLINE Steps Shown(const Steps& steps, const Found& found) const
  {
    Steps lit = steps;
    if constexpr (Coloured)
    {
      lit.R = hn::Mul(lit.R, found.Tint.Of[0]);
      lit.G = hn::Mul(lit.G, found.Tint.Of[1]);
      lit.B = hn::Mul(lit.B, found.Tint.Of[2]);
    }
    if constexpr (Shaded)
    {
      lit = Lit(lit, found.Shade, *this->Shading);
    }
    return lit;
  }

  HWY_INLINE void TintOf(const Place& place, Found& found) const
  {
    // A sample is a float, or four of them where it is shaded.
    const VI sample = hn::ShiftRight < Shaded ? 4 : 2 > (hn::Load(DI(), place.Cell.Bytes));
    if constexpr (Nearest)
    {
      found.Tint = this->Colours.At(sample);
    }
    else
    {
      found.Tint = this->Colours.In(sample, place.X, place.Y, place.Z);
    }
  }

  /// Asks the caches for the cells of the outermost rays: those between are in the same or next to
  /// them. Bricks with gradients are too large for the nearest cache; for others this takes longer
  /// than it saves.
  HWY_INLINE void AskAhead(const Place& place) const
  {
    constexpr int lanes = static_cast<int>(hn::MaxLanes(D()));
    for (const int lane : { 0, RayTile::PacketEdge - 1, lanes - RayTile::PacketEdge, lanes - 1 })
    {
      const char* const corner = this->Values + place.Cell.Bytes[lane];
      hwy::Prefetch(corner);
      hwy::Prefetch(corner + this->RowBytes);
      hwy::Prefetch(corner + this->SliceBytes);
      hwy::Prefetch(corner + this->SliceBytes + this->RowBytes);
    }
  }

  HWY_INLINE void ShadeOf(VF x, VF y, VF z, const Direction& direction, Found& found) const
  {
    found.Shade = LightOf(*this->Shading, CosineOf(*this->Shading, x, y, z, direction));
  }

  HWY_INLINE Blocks ValuesAndGradients(const Place& place) const
  {
    if constexpr (Nearest)
    {
      return Transposed(LoadBlocks(this->Values, place.Cell));
    }
    else
    {
      return Transposed({ { this->MixedInCell<0>(place), this->MixedInCell<1>(place),
        this->MixedInCell<2>(place), this->MixedInCell<3>(place) } });
    }
  }

  /// Value and gradient of lanes 4 b + k.
  template <int k>
  HWY_INLINE VF MixedInCell(const Place& place) const
  {
    const std::int32_t* bytes = place.Cell.Bytes + k;
#if BANYAN_HAS_PAIRS
    const Pairs alongZ = ForPairs<k>(place.Z);
    const auto face = [&](const char* from) HWY_ATTR
    { return Mix(LoadPairs(from, bytes), LoadPairs(from + this->SliceBytes, bytes), alongZ); };
    const Pairs both =
      Mix(face(this->Values), face(this->Values + this->RowBytes), ForPairs<k>(place.Y));
    return Mix(BlocksOf<0>(both), BlocksOf<1>(both), hn::Broadcast<k>(place.X));
#else
    const VF z = hn::Broadcast<k>(place.Z);
    const auto edge = [&](const char* from) HWY_ATTR
    { return Mix(LoadBlocks(from, bytes), LoadBlocks(from + this->SliceBytes, bytes), z); };
    const VF y = hn::Broadcast<k>(place.Y);
    const char* const next = this->Values + 4 * sizeof(float);
    const VF left = Mix(edge(this->Values), edge(this->Values + this->RowBytes), y);
    const VF right = Mix(edge(next), edge(next + this->RowBytes), y);
    return Mix(left, right, hn::Broadcast<k>(place.X));
#endif
  }

  /// The four edges along z of the cells of lanes 4 b + k.
  template <int k>
  HWY_INLINE VF MixedAlongZ(const Place& place) const
  {
    const std::int32_t* bytes = place.Cell.Bytes + k;
    return Mix(this->FacesAt(this->Values, bytes),
      this->FacesAt(this->Values + this->SliceBytes, bytes), hn::Broadcast<k>(place.Z));
  }

  /// Of the cells of every fourth lane.
  HWY_INLINE VF FacesAt(const char* values, const std::int32_t* bytes) const
  {
    if constexpr (Numbers)
    {
      return this->ValuesOf(LoadNumberFaces(values, bytes, this->RowBytes));
    }
    else
    {
      return LoadFaces(values, bytes, this->RowBytes);
    }
  }

  /// As ValueOfNumber.
  HWY_INLINE VF ValuesOf(VF numbers) const
  {
    const D d;
    return hn::MulAdd(
      numbers, hn::Set(d, this->Scale.High), hn::Mul(numbers, hn::Set(d, this->Scale.Low)));
  }

  /// The cell, or the nearest sample.
  static HWY_INLINE VI CellOf(VU position)
  {
    if constexpr (Nearest)
    {
      position = hn::Add(position, hn::Set(DU(), 1u << (FractionBits - 1)));
    }
    return hn::BitCast(DI(), hn::ShiftRight<FractionBits>(position));
  }

  static HWY_INLINE VF FractionOf(VU position)
  {
    static_assert(FractionBits == UsedBits, "fractions are used as they are");
    const VU bits = hn::And(position, hn::Set(DU(), (1u << FractionBits) - 1));
    return hn::Mul(hn::ConvertTo(D(), hn::BitCast(DI(), bits)), hn::Set(D(), UsedUnit));
  }

  static constexpr std::ptrdiff_t UnitBytes = Numbers ? sizeof(std::int16_t) : sizeof(float);

  const char* Values;
  std::int32_t RowBytes;
  std::int32_t SliceBytes;
  NumberScale Scale;
  TableLookup Lookup;
  const glm::vec4* Table = nullptr;
  const glm::vec4* Depths = nullptr;
  const ShadingTable* Shading = nullptr;
  ColourLanes Colours;
  HiddenLanes Hidden;
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
