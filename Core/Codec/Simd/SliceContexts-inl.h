// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_SliceContexts_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_SliceContexts_inl_h
#undef banyan_Codec_SliceContexts_inl_h
#else
#define banyan_Codec_SliceContexts_inl_h
#endif

#include "Codec/Simd/Contexts-inl.h"
#include "Codec/Tans.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Magnitudes of the units of blocks of 16 or 32 at one stride, without gaps, so that one vector
/// holds several rows: N = 8 or 16 of each axis at stride 2, 16 or 32 at stride 1. With stride 2
/// what lies between is left out, so that passes of both strides are the same. Rows of three faces
/// lie side by side in a slice, which has room for a fourth.
template <int D, int N>
struct SliceShape
{
  static constexpr int Rows = D == 3 ? N : 4; ///< of a slice
  static constexpr int Slice = Rows * N;
  static constexpr int Count = N * Slice;
  /// Vectors read so much beyond both ends, and ignore it.
  static constexpr int Margin = 128;
};

/// Memory for the slices of a pass of blocks.
/// @param B their edge
template <int B>
struct SliceMemory
{
  static constexpr int Most = B * B + 64;

  alignas(64) std::uint8_t Tables[Most];   ///< of each lane
  alignas(64) std::int8_t SignMask[Most];  ///< -1 where residuals have the other sign
  alignas(64) std::int8_t Symbols[Most];   ///< of each lane; 0 where it has no symbol
  alignas(64) std::int8_t Kept[2][Most];   ///< residuals of the slices before, from -15 to 15
  alignas(64) std::int8_t Residuals[Most]; ///< of each lane; of escapes anything
  alignas(64) std::uint16_t Places[Most];  ///< of symbols, as ReadRun takes them
  alignas(64) std::int8_t Read[Most];      ///< of symbols
  std::uint16_t FlagPlaces[B + 16];
  std::int8_t Flags[B + 16];
  std::uint8_t RowClass[B + 16]; ///< by position of the row
  std::uint8_t FlagRows[B + 16];
};

/// A row of N bytes, or 16 of a longer one; those behind it hold anything. It is loaded as it was
/// stored, or as a part of that: what was stored in two pieces is waited for.
template <int N>
HWY_INLINE Bytes LoadRowOf(const std::uint8_t* from)
{
  if constexpr (N < Width)
  {
    const hn::CappedTag<std::uint8_t, Width> d;
    return { hn::ZeroExtendVector(d, hn::LoadU(hn::Half<decltype(d)>(), from)) };
  }
  else
  {
    return Bytes::Load(from);
  }
}

/// Places of symbols, as ReadRun takes them, by the numbers of their tables.
HWY_INLINE void StorePlaces(const Bytes& tables, std::uint16_t* to)
{
  ShiftLeft<tans::TableBits>(Widen<std::uint16_t>(tables)).Store(to);
}

/// Bit i is that of lane i of a mask.
HWY_INLINE unsigned BitsOf(const Bytes& mask)
{
  const hn::CappedTag<std::uint8_t, Width> d;
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, hn::MaskFromVec(mask.V), bits);
  return bits[0] | unsigned{ bits[1] } << 8;
}

/// Numbers of one byte, as many as a slice or a vector has.
template <int D, int N>
using SliceTag = hn::CappedTag<std::uint8_t, SliceShape<D, N>::Slice>;

/// LocalActivity for all lanes of a vector; those that the pass does not have hold anything.
/// @param P a pass; N is the edge of blocks divided by its stride
template <class P, int N>
struct SliceActivity
{
  static constexpr int D = P::D;
  static constexpr int Row = N;
  static constexpr int Slice = SliceShape<D, N>::Slice;
  using Tag = SliceTag<D, N>;
  using V = hn::VFromD<Tag>;
  using M = decltype(hn::MaskFromVec(V()));
  static constexpr int Lanes = static_cast<int>(hn::MaxLanes(Tag()));
  static constexpr int RowsAtOnce = std::max(Lanes / N, 1); ///< of a slice

  const std::uint8_t* From; ///< lane 0
  int FirstRow;             ///< of the vector's rows, in the slice
  int FirstLane;            ///< of its lanes, in their row: not 0 where a row has several vectors
  int Number;               ///< of the slice

  HWY_INLINE V At(std::ptrdiff_t offset) const { return hn::LoadU(Tag(), this->From + offset); }
  /// Zero where the mask says no. Not MaskedLoad, which wants aligned memory for bytes before
  /// AVX-512.
  HWY_INLINE V AtOr0(M mask, std::ptrdiff_t offset) const
  {
    return hn::IfThenElseZero(mask, this->At(offset));
  }
  HWY_INLINE V Lane() const { return hn::Iota(Tag(), 0); }
  HWY_INLINE V InRow() const
  {
    if constexpr (Lanes < N)
    {
      return hn::Add(this->Lane(), hn::Set(Tag(), static_cast<std::uint8_t>(this->FirstLane)));
    }
    return hn::And(this->Lane(), hn::Set(Tag(), static_cast<std::uint8_t>(N - 1)));
  }
  static HWY_INLINE M Below(V v, int limit)
  {
    return hn::Lt(v, hn::Set(Tag(), static_cast<std::uint8_t>(limit)));
  }

  /// Both sides; beyond the ends of rows there are zeros. Lane 0 of rows is never asked for.
  HWY_INLINE V Beside(std::ptrdiff_t offset) const
  {
    return hn::Add(this->At(offset - 1), this->AtOr0(Below(this->InRow(), N - 1), offset + 1));
  }
  HWY_INLINE V TwoBeside(std::ptrdiff_t offset) const
  {
    const V lane = this->InRow();
    return hn::Add(this->AtOr0(hn::Not(Below(lane, 2)), offset - 2),
      this->AtOr0(Below(lane, N - 2), offset + 2));
  }

  /// `up`, which is Step rows on, or `down` where there is no such row.
  template <int Step>
  HWY_INLINE V AheadRow(V up, V down) const
  {
    const int rows = std::max(N - Step - this->FirstRow, 0); // that have one
    return rows >= RowsAtOnce ? up : hn::IfThenElse(Below(this->Lane(), rows * N), up, down);
  }
  /// `down`, which is Step rows before, or `up` where there is no such row.
  template <int Step>
  HWY_INLINE V BehindRow(V up, V down) const
  {
    return this->FirstRow >= Step
             ? down
             : hn::IfThenElse(Below(this->Lane(), (Step - this->FirstRow) * N), up, down);
  }
  HWY_INLINE std::ptrdiff_t AheadSlice(int step) const
  {
    return (this->Number + step < N ? step : -step) * Slice;
  }

  static HWY_INLINE V Twice(V v) { return hn::Add(v, v); }

  HWY_INLINE V Ends() const
  {
    constexpr int two = 2 * Row;
    if (P::Axis == 0)
    {
      V sum = hn::Add(Twice(this->Beside(0)),
        hn::Add(this->Beside(-2 * Slice), this->Beside(this->AheadSlice(2))));
      if (D == 3)
      {
        const V down = this->Beside(-two);
        sum = hn::Add(sum, hn::Add(down, this->template AheadRow<2>(this->Beside(two), down)));
      }
      return sum;
    }
    if (D == 3 && P::Axis == 1)
    {
      const V low = this->At(-Row);
      const V high = this->template AheadRow<1>(this->At(Row), low);
      const V besideLow = this->Beside(-Row);
      const V besideHigh = this->template AheadRow<1>(this->Beside(Row), besideLow);
      V sum = hn::Add(Twice(hn::Add(low, high)), hn::Add(besideLow, besideHigh));
      for (const std::ptrdiff_t across : { std::ptrdiff_t{ -2 * Slice }, this->AheadSlice(2) })
      {
        const V before = this->At(across - Row);
        sum =
          hn::Add(sum, hn::Add(before, this->template AheadRow<1>(this->At(across + Row), before)));
      }
      return sum;
    }
    const std::ptrdiff_t low = -Slice;
    const std::ptrdiff_t high = this->AheadSlice(1);
    V sum = hn::Add(Twice(hn::Add(this->At(low), this->At(high))),
      hn::Add(this->Beside(low), this->Beside(high)));
    if (D == 3)
    {
      const V lowDown = this->At(low - Row);
      const V highDown = this->At(high - Row);
      sum = hn::Add(sum, hn::Add(lowDown, highDown));
      sum = hn::Add(sum, hn::Add(this->template AheadRow<1>(this->At(low + Row), lowDown),
                           this->template AheadRow<1>(this->At(high + Row), highDown)));
    }
    return sum;
  }

  HWY_INLINE V Of() const
  {
    const V sum = this->Ends();
    if (this->Number < 2)
    {
      return Twice(sum); // the pass has coded none before
    }
    constexpr std::ptrdiff_t before = -2 * Slice;
    V near = P::Axis == 0 ? this->TwoBeside(before) : this->Beside(before);
    if (D == 3)
    {
      constexpr int step = P::RowStep / P::S;
      const V down = this->At(before - step * Row);
      const V up = this->template AheadRow<step>(this->At(before + step * Row), down);
      near = hn::Add(near, hn::Add(up, this->template BehindRow<step>(up, down)));
    }
    const V same = this->At(before);
    const V twice = hn::Add(same, near);
    return hn::Add(hn::Add(sum, Twice(twice)), Twice(Twice(same)));
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
