// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_Contexts_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_Contexts_inl_h
#undef banyan_Codec_Contexts_inl_h
#else
#define banyan_Codec_Contexts_inl_h
#endif

#include "Codec/Residual.h"
#include "Codec/Simd/Passes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Sums of the magnitudes around a row.
/// @param P a pass, @param B edge of the block
template <class P, int B>
struct ActivityAround
{
  static constexpr block::Shape<P::D> Shape{ B };
  static constexpr std::ptrdiff_t Y = Shape.Y();
  static constexpr std::ptrdiff_t Z = Shape.MagnitudeZ();

  const std::uint8_t* From; ///< lane First + at of the row
  const RowPlace& Place;

  HWY_INLINE Bytes At(std::ptrdiff_t offset) const { return Bytes::Load(this->From + offset); }
  HWY_INLINE Bytes Beside(std::ptrdiff_t offset, std::ptrdiff_t distance) const
  {
    return this->At(offset - distance) + this->At(offset + distance);
  }
  /// Beyond the last row nothing of this block is known: the other side stands for it.
  static std::ptrdiff_t Ahead(int position, int step, std::ptrdiff_t gap)
  {
    return position + step < B ? gap : -gap;
  }

  /// At and beside both ends of the interpolation.
  HWY_INLINE Bytes Ends() const
  {
    constexpr int s = P::S;
    if constexpr (P::Axis == 0)
    {
      const Bytes ends = this->Beside(0, s);
      Bytes sum = ends + ends;
      if constexpr (P::D > 1)
      {
        constexpr std::ptrdiff_t gap = 2 * s * Y;
        sum += this->Beside(-gap, s) + this->Beside(Ahead(this->Place.Y, 2 * s, gap), s);
      }
      if constexpr (P::D > 2)
      {
        constexpr std::ptrdiff_t gap = 2 * s * Z;
        sum += this->Beside(-gap, s) + this->Beside(Ahead(this->Place.Z, 2 * s, gap), s);
      }
      return sum;
    }
    else
    {
      constexpr std::ptrdiff_t gap = s * (P::Axis == 1 ? Y : Z);
      const std::ptrdiff_t next = Ahead(P::Axis == 1 ? this->Place.Y : this->Place.Z, s, gap);
      const Bytes ends = this->At(-gap) + this->At(next);
      Bytes sum = ends + ends + this->Beside(-gap, s) + this->Beside(next, s);
      if constexpr (P::D > 2)
      {
        constexpr std::ptrdiff_t across = P::Axis == 1 ? 2 * s * Z : s * Y;
        const std::ptrdiff_t beside =
          P::Axis == 1 ? Ahead(this->Place.Z, 2 * s, across) : Ahead(this->Place.Y, s, across);
        sum += this->At(-gap - across) + this->At(next - across) + this->At(-gap + beside) +
               this->At(next + beside);
      }
      return sum;
    }
  }

  /// Ends, and the slice that the same pass coded before.
  HWY_INLINE Bytes All() const
  {
    const Bytes sum = this->Ends();
    if constexpr (P::D == 1)
    {
      return sum;
    }
    constexpr int s = P::S;
    if ((P::D == 2 ? this->Place.Y : this->Place.Z) < 2 * s)
    {
      return sum + sum; // there is none
    }
    constexpr std::ptrdiff_t before = 2 * s * (P::D == 2 ? Y : Z);
    Bytes near = this->Beside(-before, P::Step);
    if constexpr (P::D > 2)
    {
      constexpr int step = P::RowStep;
      constexpr std::ptrdiff_t gap = step * Y;
      const std::ptrdiff_t up = Ahead(this->Place.Y, step, gap);
      near += this->At(-before + (this->Place.Y >= step ? -gap : up)) + this->At(-before + up);
    }
    const Bytes same = this->At(-before);
    const Bytes twice = same + near;
    return sum + twice + twice + (same + same) + (same + same);
  }
};

/// Sum of the magnitudes of residuals around that are known when a slice is coded: those at and
/// beside both ends of the interpolation, and those of the slice that the same pass coded before,
/// which count most. At most 26 times 8.
/// @param m lane First + at of a row
template <class P, int B>
HWY_INLINE Bytes LocalActivity(const std::uint8_t* m, const RowPlace& place)
{
  return ActivityAround<P, B>{ m, place }.All();
}

/// A hint from the residuals at the same place in the two slices before, of the same pass: its sign
/// is likely that of the residual. 0 where there are none, or the place is not active.
/// @param r lane First + at of a row
template <class P, int B>
HWY_INLINE SignedBytes HintOf(const std::int8_t* r, const RowPlace& place, const Bytes& activity)
{
  const int slice = P::D == 2 ? place.Y : place.Z;
  if (P::D == 1 || slice < 2 * P::S)
  {
    return SignedBytes::Set(0);
  }
  constexpr block::Shape<P::D> shape{ B };
  constexpr std::ptrdiff_t before = 2 * P::S * (P::D == 2 ? shape.Y() : shape.MagnitudeZ());
  const SignedBytes near = SignedBytes::Load(r - before);
  SignedBytes hint = near + near;
  if (slice >= 4 * P::S)
  {
    hint += SignedBytes::Load(r - 2 * before);
  }
  return hint & BitsAs<std::int8_t>(activity != Bytes::Set(0));
}

/// Residuals as they are kept for hints.
template <class V, class Number>
HWY_INLINE V Limited(const V& residuals, Number most)
{
  return Max(Min(residuals, V::Set(most)), V::Set(static_cast<Number>(-most)));
}

/// Classes of activity, 0 to 7.
template <int N, bool One>
HWY_INLINE PackOf<std::uint8_t, N, One> ActivityClasses(const PackOf<std::uint8_t, N, One>& sum)
{
  using V = PackOf<std::uint8_t, N, One>;
  // Signed numbers, which all targets compare.
  const auto biased = BitsAs<std::int8_t>(sum ^ V::Set(128));
  const auto above = [&](int limit)
  { return biased > decltype(biased)::Set(static_cast<std::int8_t>(limit - 128)); };
  const auto all =
    above(0) + above(5) + (above(12) + above(22)) + (above(36) + above(56)) + above(90);
  return BitsAs<std::uint8_t>(-all); // each is -1 where it holds
}

/// About 2 log2(1 + |r|): sums of these say how active the neighbourhood is, over any scale. From
/// 15 on it grows no more. Lanes behind the last symbol may hold anything.
template <int N, bool One>
HWY_INLINE Pack<std::uint8_t, N> MagnitudesOf(const PackOf<std::int8_t, N, One>& residuals)
{
  const auto size = BitsAs<std::uint8_t>(Abs(residuals));
  return LookUp<0, 2, 3, 4, 5, 5, 6, 6, 6, 7, 7, 7, 7, 8, 8, 8>(Min(size, decltype(size)::Set(15)));
}

using RowSums = Pack<std::uint16_t, Width>;

/// Sets the sums of rows to those of the magnitudes that a unit starts with: those of its first
/// slice, and of the first row and the first lane of others.
template <int D, int B>
HWY_INLINE void SumRows(const std::uint8_t* m, std::uint16_t* sums)
{
  constexpr block::Shape<D> shape{ B };
  const auto sum = [&](const std::uint8_t* row)
  {
    std::uint16_t result = 0;
    for (int x = 0; x < B; x += Width)
    {
      result = static_cast<std::uint16_t>(result + SumOfBytes(Bytes::Load(row + x)));
    }
    return result;
  };
  constexpr int rows = D > 2 ? B : 3;
  for (int slice = 0; slice < B; ++slice)
  {
    const std::uint8_t* first = m + slice * (D > 2 ? shape.MagnitudeZ() : shape.Y());
    std::uint16_t* to = sums + slice * shape.SumPitch();
    for (int row = 0; row < rows; ++row)
    {
      const std::uint8_t* from = first + row * shape.Pitch();
      to[row] = slice == 0 || (D > 2 && row == 0) ? sum(from) : from[0];
    }
  }
}

/// How likely rows of a slice have residuals: weighted sums of the magnitudes around, as in
/// LocalActivity.
/// @param FirstRow number of the first of these rows
template <class P, int B, int FirstRow>
struct RowWeights
{
  static constexpr int S = P::S;
  static constexpr std::ptrdiff_t Pitch = block::Shape<P::D>{ B }.SumPitch();

  const std::uint16_t* From; ///< that row of the slice
  int Slice;

  HWY_INLINE RowSums At(std::ptrdiff_t offset) const { return RowSums::Load(this->From + offset); }
  /// Beyond the last row or slice the other side stands for it.
  template <int Step>
  HWY_INLINE RowSums Ahead(std::ptrdiff_t offset) const
  {
    constexpr int there = B - Step - FirstRow; // rows that have one
    const RowSums up = this->At(offset + Step);
    if constexpr (there >= Width)
    {
      return up;
    }
    else
    {
      return Select(
        ConstantLanes<std::uint16_t, Width, EveryOf<1, there>>::Get(), up, this->At(offset - Step));
    }
  }
  HWY_INLINE std::ptrdiff_t SliceAhead(int step) const
  {
    return (this->Slice + step < B ? step : -step) * Pitch;
  }

  /// At and beside both ends of the interpolation.
  HWY_INLINE RowSums Ends() const
  {
    if constexpr (P::D == 1)
    {
      return ShiftLeft<2>(this->At(0));
    }
    else if constexpr (P::Axis == 0)
    {
      RowSums sum = this->At(-2 * S * Pitch) + this->At(this->SliceAhead(2 * S));
      if constexpr (P::D > 2)
      {
        sum += this->At(-2 * S) + this->template Ahead<2 * S>(0);
      }
      return ShiftLeft<1>(sum + this->At(0) + this->At(0));
    }
    else if constexpr (P::D == 2)
    {
      return ShiftLeft<2>(this->At(-S * Pitch) + this->At(this->SliceAhead(S)));
    }
    else if constexpr (P::Axis == 1)
    {
      RowSums sum = ShiftLeft<2>(this->At(-S) + this->template Ahead<S>(0));
      for (const std::ptrdiff_t beside : { -2 * S * Pitch, this->SliceAhead(2 * S) })
      {
        sum += this->At(beside - S) + this->template Ahead<S>(beside);
      }
      return sum;
    }
    else
    {
      RowSums sum = RowSums::Set(0);
      for (const std::ptrdiff_t end : { -S * Pitch, this->SliceAhead(S) })
      {
        sum += ShiftLeft<2>(this->At(end)) + this->At(end - S) + this->template Ahead<S>(end);
      }
      return sum;
    }
  }

  /// Ends, and the slice that the same pass coded before.
  HWY_INLINE RowSums All() const
  {
    RowSums sum = this->Ends();
    if constexpr (P::D == 1)
    {
      return sum;
    }
    if (this->Slice < 2 * S)
    {
      return sum + sum; // there is none
    }
    constexpr std::ptrdiff_t before = -2 * S * Pitch;
    sum += this->At(before) * RowSums::Set(10);
    if constexpr (P::D > 2)
    {
      constexpr int step = P::RowStep;
      const RowSums up = this->template Ahead<step>(before);
      RowSums down = this->At(before - step);
      if constexpr (FirstRow < step)
      {
        down =
          Select(ConstantLanes<std::uint16_t, Width, EveryOf<1, step - FirstRow>>::Get(), up, down);
      }
      sum += ShiftLeft<1>(up + down);
    }
    return sum;
  }
};

/// Classes of the rows of a slice, by what is around them: RowClasses and more where residuals are
/// so likely that rows have no flags.
/// @param to of all rows from 0 on, those included that the pass does not have
template <class P, int B, class Number>
HWY_INLINE void RowClasses(const Unit<Number, P::D>& unit, int slice, std::uint8_t* to)
{
  constexpr std::ptrdiff_t pitch = block::Shape<P::D>{ B }.SumPitch();
  ForEachPart<(P::D > 2 ? B : Width)>(
    [&](auto first)
    {
      const auto weights = BitsAs<std::int16_t>(
        RowWeights<P, B, first()>{ unit.RowSums + (P::D > 1 ? slice * pitch : 0) + first(), slice }
          .All());
      auto classes = decltype(weights)::Set(0);
      for (const std::uint16_t limit : residual::RowLimits)
      {
        // -1 where it holds; weights are below 2^15.
        classes = classes - (weights > decltype(weights)::Set(static_cast<std::int16_t>(limit)));
      }
      Narrow<std::uint8_t>(classes).Store(to + first());
    });
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
